// Uniforms and functions that all shaders of a scene share. Colours are sRGB; light is added in
// linear space and then encoded.

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
    planes_centre: vec3f,
    planes_radius: f32,
    size: vec2f,
    cell: f32, // width of a grid cell
    padding: f32,
    sky_top: vec4f,
    sky_bottom: vec4f,
    // With the opacity of what is shown of the floor and the walls; 0 hides it.
    ground: vec4f,
    grid: vec4f,
    walls: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;

// Two directional lights, and ambient light: bluish from above, warm from below.
const KEY_DIRECTION = vec3f(0.298142, 0.596285, 0.745356);
const KEY = vec3f(0.76, 0.74, 0.70);
const FILL_DIRECTION = vec3f(-0.842152, 0.421076, -0.336861);
const FILL = vec3f(0.22, 0.24, 0.28);
const LAMP_WIDTH = 0.25;
const SKY_AMBIENT = vec3f(0.34, 0.36, 0.40);
const GROUND_AMBIENT = vec3f(0.32, 0.31, 0.30);

struct Ray {
    origin: vec3f,
    direction: vec3f, // not normalised
}

// Ray through a position in the picture, in pixels.
fn pixel_ray(position: vec2f) -> Ray {
    let step = 2.0 / view.size;
    let at = vec2f(position.x * step.x - 1.0, 1.0 - position.y * step.y);
    let aside = view.right * at.x + view.up * at.y;
    return Ray(
        view.eye + aside * view.orthographic,
        view.forward + aside * (1.0 - view.orthographic),
    );
}

// Minimum distance along a ray at which surfaces are visible: 0 at the eye in perspective,
// unlimited in an orthographic view, which has no eye.
fn nearest_along() -> f32 {
    return -1e30 * view.orthographic;
}

// Size of a pixel in world units at a distance along a ray.
fn pixel_size(along: f32) -> f32 {
    let depth = mix(abs(along), 1.0, view.orthographic);
    return max(depth * length(view.up) * 2.0 / view.size.y, 1e-6);
}

fn sky(position: vec2f) -> vec3f {
    return mix(view.sky_top.rgb, view.sky_bottom.rgb, position.y / view.size.y);
}

// Light from sRGB. The polynomial differs from ((c + 0.055) / 1.055)^2.4 by at most 2.2e-5 on [0.04045, 1]:
// a processor computes a power of three colours for each pixel several times as long.
fn decoded(colour: vec3f) -> vec3f {
    let c = colour;
    let high = ((((0.05978318 * c - 0.2411795) * c + 0.6113959) * c + 0.5388564) * c + 0.03015449) * c + 0.001010546;
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

// sRGB from light. The polynomial differs from 1.055 c^(1 / 2.4) - 0.055 by at most 5e-5 on [0.0031308, 1.4].
fn encoded(light: vec3f) -> vec3f {
    let root = sqrt(sqrt(light));
    let high = (((0.07068479 * root - 0.3108265) * root + 1.102673) * root + 0.2027952) * root - 0.06537464;
    return select(high, light * 12.92, light <= vec3f(0.0031308));
}

// Part of the light of a wide lamp that a surface gets, by the cosine of the angle between its normal and the
// middle of the lamp: also where it faces a little away, and without an edge.
fn from_wide_light(cosine: f32) -> f32 {
    let seen = saturate((cosine + LAMP_WIDTH) / (1.0 + LAMP_WIDTH));
    return mix(seen * seen, seen, 0.5);
}

// Light that a surface reflects from both lights and the ambient light.
fn reflected(colour: vec3f, normal: vec3f) -> vec3f {
    let ambient = mix(GROUND_AMBIENT, SKY_AMBIENT, normal.y * 0.5 + 0.5);
    let key = KEY * from_wide_light(dot(normal, KEY_DIRECTION));
    let fill = FILL * from_wide_light(dot(normal, FILL_DIRECTION));
    return decoded(colour) * (ambient + key + fill);
}

// Diffuse shading.
fn lit(colour: vec3f, normal: vec3f) -> vec3f {
    return encoded(reflected(colour, normal));
}

// Radii at which the floor and the walls have faded out, as multiples of the planes' radius.
const FLOOR_RADIUS = 2.2;
const WALL_RADIUS = 1.0;

// Opacity of a plane at a point: 1 at the centre of the planes, fading to 0 at `radius` times the
// planes' radius.
fn presence(point: vec3f, radius: f32) -> f32 {
    let out = (point - view.planes_centre) / (view.planes_radius * radius);
    return smoothstep(0.0, 1.0, 1.0 - dot(out, out));
}

// Fades the colour of a point of the world into the sky behind its pixel.
fn fogged(colour: vec3f, world: vec3f, position: vec2f) -> vec3f {
    let depth = dot(world - view.eye, view.forward) / (view.focus_distance * 7.0);
    return mix(sky(position), colour, exp(-depth * depth));
}

// Colour between those of a ramp; the first is at 0, the next at 1.
fn along_ramp(ramp: array<vec4f, 5>, at: f32) -> vec4f {
    let first = mix(ramp[0], ramp[1], saturate(at));
    let second = mix(first, ramp[2], saturate(at - 1.0));
    let third = mix(second, ramp[3], saturate(at - 2.0));
    return mix(third, ramp[4], saturate(at - 3.0));
}
