// What every shader of the scene sees: camera, lights, colours, and the planes' settings.

struct Capsule {
    base: vec3f,
    base_radius: f32,
    tip: vec3f,
    tip_radius: f32,
}

struct View {
    clip_from_world: mat4x4f,
    eye: vec3f,
    orthographic: f32,
    forward: vec3f,
    focus_distance: f32,
    right: vec3f,
    pixel_scale: f32,
    up: vec3f,
    shadow_strength: f32,
    stage_centre: vec3f,
    stage_radius: f32,
    size: vec2f,
    shadow_count: u32,
    planes: u32, // bits: the grids in which x, y, z is 0; the ground
    sky_top: vec4f,
    sky_bottom: vec4f,
    ground: vec4f,
    grid: vec4f,
    axes: array<vec4f, 3>,
    shadows: array<Capsule, 32>,
}

@group(0) @binding(0) var<uniform> view: View;

// The seed's two lights, and a soft light from everywhere: bluish above, warm below.
const KEY_DIRECTION = vec3f(0.298142, 0.596285, 0.745356);
const KEY = vec3f(0.84, 0.82, 0.78);
const FILL_DIRECTION = vec3f(-0.842152, 0.421076, -0.336861);
const FILL = vec3f(0.20, 0.22, 0.26);
const SKY_AMBIENT = vec3f(0.36, 0.38, 0.42);
const GROUND_AMBIENT = vec3f(0.20, 0.18, 0.16);

struct Ray {
    origin: vec3f,
    direction: vec3f,
    // How both change from one pixel to the next, across and down.
    origin_dx: vec3f,
    origin_dy: vec3f,
    direction_dx: vec3f,
    direction_dy: vec3f,
}

// The half line seen at a pixel; the direction is not normalised.
fn pixel_ray(position: vec2f) -> Ray {
    let step = 2.0 / view.size;
    let at = vec2f(position.x * step.x - 1.0, 1.0 - position.y * step.y);
    let aside = view.right * at.x + view.up * at.y;
    let dx = view.right * step.x;
    let dy = -view.up * step.y;
    let flat = view.orthographic;
    return Ray(
        view.eye + aside * flat,
        view.forward + aside * (1.0 - flat),
        dx * flat,
        dy * flat,
        dx * (1.0 - flat),
        dy * (1.0 - flat),
    );
}

fn sky(position: vec2f) -> vec3f {
    return mix(view.sky_top.rgb, view.sky_bottom.rgb, position.y / view.size.y);
}

// Matte: two directional lights and the sky's and the ground's own light.
fn lit(colour: vec3f, normal: vec3f) -> vec3f {
    let ambient = mix(GROUND_AMBIENT, SKY_AMBIENT, normal.y * 0.5 + 0.5);
    let key = KEY * max(dot(normal, KEY_DIRECTION), 0.0);
    let fill = FILL * max(dot(normal, FILL_DIRECTION), 0.0);
    return colour * (ambient + key + fill);
}

// Far things fade into the sky behind them.
fn fogged(colour: vec3f, position: vec2f, along: f32) -> vec3f {
    let depth = along / (view.focus_distance * 7.0);
    return mix(sky(position), colour, exp(-depth * depth));
}
