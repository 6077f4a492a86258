// The three grids and the ground, as seen in front of something at a pixel. All three planes are
// met analytically in one go, nearest drawn last, so that they cross each other and the arm rightly
// and cost one pass.

const CELL = 100.0;
const LINE_WIDTH = 1.1; // pixels, at most
const WIDEST_LINE = 0.012; // of a cell

struct Layer {
    along: f32,
    colour: vec4f, // premultiplied
}

const NO_LAYER = Layer(1e30, vec4f(0.0));

// How much of a pixel is covered by lines one cell apart. Lines get no thinner than the pixel but
// fainter, and fade to their average where cells are smaller than pixels, so that nothing flickers
// (B. Golus, "The Best Darn Grid Shader (Yet)", 2023).
fn lines(at: vec2f, width_on_screen: vec2f) -> f32 {
    let wanted = min(width_on_screen * LINE_WIDTH * view.pixel_scale, vec2f(WIDEST_LINE));
    let drawn = clamp(wanted, width_on_screen, vec2f(0.5));
    let edge = width_on_screen * 1.5;
    let off = abs(fract(at + 0.5) * 2.0 - 1.0);
    let from_line = 1.0 - off;
    var cover = 1.0 - smoothstep(drawn - edge, drawn + edge, from_line);
    cover *= saturate(wanted / drawn);
    cover = mix(cover, wanted, saturate(width_on_screen * 2.0 - 1.0));
    return mix(cover.x, 1.0, cover.y);
}

// One line along each axis of the plane: how much it covers, for both.
fn axis_lines(at: vec2f, width_on_screen: vec2f) -> vec2f {
    let half_width = width_on_screen * 0.9 * view.pixel_scale;
    return 1.0 - smoothstep(half_width, half_width + width_on_screen, abs(at));
}

// A grid in a plane: `at` and its change per pixel in cells, and the colours of the axes that run
// along u and v.
fn grid(at: vec2f, width_on_screen: vec2f, axis_u: vec3f, axis_v: vec3f) -> vec4f {
    let fine = lines(at, width_on_screen) * 0.34;
    let coarse = lines(at / 5.0, width_on_screen / 5.0) * 0.5;
    let cover = max(fine, coarse) * view.grid.a;
    let axes = axis_lines(at, width_on_screen) * 0.85;
    var colour = vec4f(view.grid.rgb * cover, cover);
    colour = mix(colour, vec4f(axis_v, 1.0), axes.x);
    return mix(colour, vec4f(axis_u, 1.0), axes.y);
}

// Full in the middle of the stage, nothing at `radius` stage radii.
fn fade(point: vec3f, radius: f32) -> f32 {
    let out = distance(point, view.stage_centre) / (view.stage_radius * radius);
    return 1.0 - smoothstep(0.25, 1.0, out);
}

// How much of the key light reaches a point past one capsule: the nearest approach of the ray to
// the light and the capsule's axis, softened by how far from the point it is.
fn light_past(point: vec3f, capsule: Capsule) -> f32 {
    let axis = capsule.tip - capsule.base;
    let from_base = point - capsule.base;
    let slant = dot(axis, KEY_DIRECTION);
    let across = dot(axis, axis) - slant * slant;
    let part = saturate((dot(axis, from_base) - slant * dot(from_base, KEY_DIRECTION)) / max(across, 1e-6));
    let nearest = capsule.base + axis * part;
    let radius = mix(capsule.base_radius, capsule.tip_radius, part);
    let height = dot(nearest - point, KEY_DIRECTION);
    let miss = length(nearest - point - KEY_DIRECTION * height) - radius;
    let softness = radius * 0.35 + max(height, 0.0) * 0.16;
    let light = smoothstep(-softness, softness, miss);
    return mix(light, 1.0, saturate(height / (view.stage_radius * 1.6)));
}

fn shadow(point: vec3f) -> f32 {
    var light = 1.0;
    for (var i = 0u; i < view.shadow_count; i++) {
        light *= light_past(point, view.shadows[i]);
    }
    return 1.0 - light;
}

// The plane through the origin in which coordinate `n` is 0, at a pixel; u and v are its other two.
fn plane(ray: Ray, n: u32, u: u32, v: u32, limit: f32) -> Layer {
    let is_floor = n == 1u;
    let has_grid = (view.planes & (1u << n)) != 0u;
    let has_ground = is_floor && (view.planes & 8u) != 0u;
    let has_shadow = is_floor && view.shadow_count > 0u;
    if !(has_grid || has_ground || has_shadow) {
        return NO_LAYER;
    }
    let along = -ray.origin[n] / ray.direction[n];
    if !(along > 0.0 && along < limit) {
        return NO_LAYER;
    }
    let point = ray.origin + ray.direction * along;
    let strength = fade(point, select(0.62, 1.5, is_floor));
    if strength <= 0.0 {
        return NO_LAYER;
    }

    // Ray differentials: how far the met point moves from this pixel to the next ones.
    let along_dx = -(ray.origin_dx[n] + along * ray.direction_dx[n]) / ray.direction[n];
    let along_dy = -(ray.origin_dy[n] + along * ray.direction_dy[n]) / ray.direction[n];
    let dx = ray.origin_dx + along * ray.direction_dx + along_dx * ray.direction;
    let dy = ray.origin_dy + along * ray.direction_dy + along_dy * ray.direction;
    let width = vec2f(length(vec2f(dx[u], dy[u])), length(vec2f(dx[v], dy[v]))) / CELL;

    var colour = vec4f(0.0);
    if has_ground {
        colour = vec4f(view.ground.rgb, 1.0) * view.ground.a;
    }
    if has_shadow {
        colour = over(vec4f(0.0, 0.0, 0.0, shadow(point) * view.shadow_strength), colour);
    }
    if has_grid {
        let at = vec2f(point[u], point[v]) / CELL;
        let quiet = select(0.6, 1.0, is_floor);
        colour = over(grid(at, width, view.axes[u].rgb, view.axes[v].rgb) * quiet, colour);
    }
    return Layer(along, colour * strength);
}

fn over(front: vec4f, back: vec4f) -> vec4f {
    return front + back * (1.0 - front.a);
}

// A colour at `limit` along the ray, with every plane that is nearer laid over it.
fn behind_planes(behind: vec3f, ray: Ray, limit: f32) -> vec3f {
    var near = plane(ray, 2u, 0u, 1u, limit);
    var middle = plane(ray, 1u, 0u, 2u, limit);
    var far = plane(ray, 0u, 2u, 1u, limit);
    if near.along > middle.along { let swap = near; near = middle; middle = swap; }
    if middle.along > far.along { let swap = middle; middle = far; far = swap; }
    if near.along > middle.along { let swap = near; near = middle; middle = swap; }
    let laid = over(near.colour, over(middle.colour, far.colour));
    return laid.rgb + behind * (1.0 - laid.a);
}
