// The three grids and the ground in front of a pixel's colour. All three planes are intersected
// analytically and blended from far to near, so that they intersect each other and the arm
// correctly in one pass. The code has no branches, since software rasterizers gain nothing from
// branches.

const LINE_WIDTH = 1.1; // points
const MAX_LINE_WIDTH = 0.012; // limit of `LINE_WIDTH` in cells
const FINE = 0.4;
const COARSE = 0.65; // opacity of every fifth line

struct Layer {
    along: f32,
    colour: vec4f, // premultiplied
}

// Fraction of a pixel that is covered by lines one cell apart. A line thinner than a pixel is drawn
// one pixel wide and fainter, and cells smaller than a pixel are averaged, so that nothing flickers
// (after B. Golus, "The Best Darn Grid Shader (Yet)", 2023).
fn lines(at: vec2f, pixel: vec2f) -> f32 {
    let nearest = round(at);
    let strength = select(vec2f(FINE), vec2f(COARSE), nearest - round(nearest / 5.0) * 5.0 == vec2f(0.0));
    let width = min(pixel * LINE_WIDTH * view.pixel_scale, vec2f(MAX_LINE_WIDTH));
    let from_line = abs(at - nearest);
    let sharp = saturate(0.5 + (max(width, pixel) * 0.5 - from_line) / pixel) * saturate(width / pixel);
    let cover = mix(sharp, width, saturate(pixel * 2.0 - 1.0)) * strength;
    return max(cover.x, cover.y);
}

// Premultiplied colour of a grid with coloured axes at a point `at`, in cells from the origin;
// `pixel` is the size of a pixel in cells.
fn grid(at: vec2f, pixel: vec2f, axis_u: vec3f, axis_v: vec3f) -> vec4f {
    let cover = lines(at, pixel);
    let axes = saturate(1.0 + 0.9 * view.pixel_scale - abs(at) / pixel) * 0.85;
    let lined = mix(vec4f(view.grid.rgb * cover, cover), vec4f(axis_v, 1.0), axes.x);
    return mix(lined, vec4f(axis_u, 1.0), axes.y);
}

fn over(front: vec4f, back: vec4f) -> vec4f {
    return front + back * (1.0 - front.a);
}

// 1 if a plane is hit after the start of a ray and before `limit`, else 0.
fn met(along: f32, limit: f32) -> f32 {
    return select(0.0, 1.0, along > nearest_along() && along < limit);
}

fn pixel_in_cells(at: vec2f) -> vec2f {
    return max(fwidth(at), vec2f(1e-6));
}

// The colour `behind` at distance `limit` along the ray of a pixel, with all nearer planes blended
// over it.
fn behind_planes(behind: vec3f, ray: Ray, limit: f32) -> vec3f {
    let along = -ray.origin / ray.direction;
    let yz = pixel_in_cells((ray.origin + ray.direction * along.x).zy / view.cell);
    let xz = pixel_in_cells((ray.origin + ray.direction * along.y).xz / view.cell);
    let xy = pixel_in_cells((ray.origin + ray.direction * along.z).xy / view.cell);
    return behind_planes_of(behind, ray, limit, array(yz, xz, xy));
}

// The same with the size of a pixel on each plane, in cells.
fn behind_planes_of(behind: vec3f, ray: Ray, limit: f32, pixels: array<vec2f, 3>) -> vec3f {
    let along = -ray.origin / ray.direction;
    let on_yz = ray.origin + ray.direction * along.x;
    let on_xz = ray.origin + ray.direction * along.y;
    let on_xy = ray.origin + ray.direction * along.z;

    let yz = grid(on_yz.zy / view.cell, pixels[0], view.axes[2].rgb, view.axes[1].rgb);
    let xz = grid(on_xz.xz / view.cell, pixels[1], view.axes[0].rgb, view.axes[2].rgb);
    let xy = grid(on_xy.xy / view.cell, pixels[2], view.axes[0].rgb, view.axes[1].rgb);

    let ground = vec4f(view.ground.rgb, 1.0) * (view.ground.a * view.shown.w);
    let floor = over(xz * view.shown.y, ground);

    var near = Layer(along.z, xy * view.shown.z * presence(on_xy, WALL_RADIUS) * met(along.z, limit));
    var middle = Layer(along.y, floor * presence(on_xz, FLOOR_RADIUS) * met(along.y, limit));
    var far = Layer(along.x, yz * view.shown.x * presence(on_yz, WALL_RADIUS) * met(along.x, limit));
    if near.along > middle.along { let swap = near; near = middle; middle = swap; }
    if middle.along > far.along { let swap = middle; middle = far; far = swap; }
    if near.along > middle.along { let swap = near; near = middle; middle = swap; }
    let laid = over(near.colour, over(middle.colour, far.colour));
    return laid.rgb + behind * (1.0 - laid.a);
}

// The colour of a surface at a point of the world that a pixel shows: fogged, and behind the planes.
fn in_scene(colour: vec3f, world: vec3f, position: vec2f) -> vec3f {
    let ray = pixel_ray(position);
    let along = dot(world - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    return behind_planes(fogged(colour, position, along), ray, along);
}
