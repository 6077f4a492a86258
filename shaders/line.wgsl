// Solid or dashed lines of constant width on screen.

const WIDTH = 2.0;
const PERIOD = 9.0;
const NEAREST = 1e-3;

struct Instance {
    @location(0) from_world: vec3f,
    @location(1) to_world: vec3f,
    @location(2) colour: vec4f,
    @location(3) dashed: f32, // 1 or 0
}

struct Stroke {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(linear) along: f32, // pixels
    @location(1) @interpolate(linear) across: f32, // pixels
    @location(2) @interpolate(flat) colour: vec4f,
    @location(3) @interpolate(flat) dashed: f32,
}

// The end `a` of the segment from `a` to `b` in clip space. If only `a` is behind the eye, the end
// is moved along the segment to just before the eye.
fn before_eye(a: vec4f, b: vec4f) -> vec4f {
    let part = (NEAREST - a.w) / (b.w - a.w);
    return select(a, mix(a, b, part), a.w < NEAREST && b.w > NEAREST);
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Stroke {
    let raw_from = view.clip_from_world * vec4f(i.from_world, 1.0);
    let raw_to = view.clip_from_world * vec4f(i.to_world, 1.0);
    let from_clip = before_eye(raw_from, raw_to);
    let to_clip = before_eye(raw_to, raw_from);
    let half_size = view.size * 0.5;
    let pixels = (to_clip.xy / to_clip.w - from_clip.xy / from_clip.w) * half_size;
    let long = length(pixels);
    let direction = select(vec2f(1.0, 0.0), pixels / long, long > 0.0);
    let half_width = (WIDTH * 0.5 + 1.0) * view.pixel_scale;
    let side = f32(index & 1u) * 2.0 - 1.0;
    let at_end = (index & 2u) != 0u;
    var clip = from_clip;
    if at_end { clip = to_clip; }
    let aside = vec2f(-direction.y, direction.x) * side * half_width / half_size;
    let position = vec4f(clip.xy + aside * clip.w, clip.zw);
    return Stroke(position, select(0.0, long, at_end), side * half_width, i.colour, i.dashed);
}

@fragment
fn fragment(s: Stroke) -> @location(0) vec4f {
    let period = PERIOD * view.pixel_scale;
    let in_dash = 0.3 * period - abs(fract(s.along / period) - 0.35) * period;
    let in_width = WIDTH * 0.5 * view.pixel_scale - abs(s.across);
    let cover = saturate(in_width + 0.5) * mix(1.0, saturate(in_dash + 0.5), s.dashed);
    return vec4f(s.colour.rgb, s.colour.a * cover);
}
