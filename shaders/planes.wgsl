// The floor and the grids: squares in the planes through the world's origin, blended over what is
// behind them.

const LINE_WIDTH = 1.1; // points
const MAX_LINE_WIDTH = 0.012; // limit of `LINE_WIDTH` in cells
const FINE = 0.4;
const COARSE = 0.75; // opacity of every fifth line
const FLOOR = 2u; // index of the floor; 0 and 1 are the walls x = 0 and z = 0
const FROM_BELOW = 0.25; // opacity of the floor seen from below, as a multiple

struct Plane {
    @builtin(position) position: vec4f,
    @location(0) point: vec3f,
    @location(1) @interpolate(flat) index: u32,
}

// Coordinates of a point in a plane.
fn in_plane(point: vec3f, index: u32) -> vec2f {
    let in_walls = select(point.zy, point.xy, index == 1u);
    return select(in_walls, point.xz, index == FLOOR);
}

// Point of a plane at these coordinates.
fn from_plane(at: vec2f, index: u32) -> vec3f {
    let in_walls = select(vec3f(0.0, at.yx), vec3f(at, 0.0), index == 1u);
    return select(in_walls, vec3f(at.x, 0.0, at.y), index == FLOOR);
}

@vertex
fn vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) index: u32) -> Plane {
    let reach = view.planes_radius * select(WALL_RADIUS, FLOOR_RADIUS, index == FLOOR);
    let aside = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0 - 1.0;
    let point = from_plane(in_plane(view.planes_centre, index) + aside * reach, index);
    return Plane(view.clip_from_world * vec4f(point, 1.0), point, index);
}

// Fraction of a pixel that is covered by lines one cell apart, at a point `at` in cells; `pixel` is
// the size of a pixel in cells. A line thinner than a pixel is drawn one pixel wide and fainter, and
// cells smaller than a pixel are averaged, so that nothing flickers (after B. Golus, "The Best Darn
// Grid Shader (Yet)", 2023).
fn lines(at: vec2f, pixel: vec2f) -> f32 {
    let nearest = round(at);
    let strength = select(vec2f(FINE), vec2f(COARSE), nearest - round(nearest / 5.0) * 5.0 == vec2f(0.0));
    let width = min(pixel * LINE_WIDTH * view.pixel_scale, vec2f(MAX_LINE_WIDTH));
    let from_line = abs(at - nearest);
    let sharp = saturate(0.5 + (max(width, pixel) * 0.5 - from_line) / pixel) * saturate(width / pixel);
    let cover = mix(sharp, width, saturate(pixel * 2.0 - 1.0)) * strength;
    return max(cover.x, cover.y);
}

@fragment
fn fragment(p: Plane) -> @location(0) vec4f {
    let is_floor = p.index == FLOOR;
    let at = in_plane(p.point, p.index) / view.cell;
    let lined = lines(at, max(fwidth(at), vec2f(1e-6))) * select(view.walls.a, view.grid.a, is_floor);
    let lines = vec4f(select(view.walls.rgb, view.grid.rgb, is_floor), 1.0) * lined;
    let side = select(FROM_BELOW, 1.0, view.eye.y > 0.0);
    let ground = vec4f(view.ground.rgb, 1.0) * (select(0.0, view.ground.a, is_floor) * side);
    let laid = lines + ground * (1.0 - lines.a);
    let shown = presence(p.point, select(WALL_RADIUS, FLOOR_RADIUS, is_floor));
    return vec4f(laid.rgb / max(laid.a, 1e-6), laid.a * shown);
}
