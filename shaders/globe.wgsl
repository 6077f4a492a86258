// Sphere of all directions of the Pointer, coloured by the twist reference's gain.

const RIM_OPACITY = 0.24;
const NEAR_OPACITY = 0.45; // as a multiple of the far side's: what is inside is seen
const LINE_WIDTH = 1.3; // points
const LINE_OPACITY = 0.5;
const FAR_LINE = 0.4; // opacity of lines on the far side, as a multiple
const LEVELS = vec3f(0.6931472, 1.0986123, 1.7917595); // ln 2, ln 3, ln 6 for gains 1, 2, 5
const MAX_SLOPE = 0.2; // change of the level per pixel above which lines fade out

struct Globe {
    centre: vec3f,
    radius: f32,
    axis: vec3f, // unit vector in a singular direction
    singular: f32, // number of singular directions: 0, 1 (the axis) or 2 (and its opposite)
    ramp: array<vec4f, 5>, // linear in the logarithm of 1 + gain
    line: vec4f,
    max_gain: f32, // gain at the end of the ramp
}

@group(1) @binding(0) var<uniform> globe: Globe;

struct Side {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) direction: f32, // -1 near, 1 far
}

struct Laid {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Side {
    return Side(covering(index, globe.centre, globe.radius), 1.0 - 2.0 * f32(instance));
}

// Radians that the elbow swings per radian that the Pointer turns, as in `TwistReference::gain`.
fn gain(pointer: vec3f) -> f32 {
    let both = abs(dot(pointer, globe.axis)) / max(length(cross(pointer, globe.axis)), 1e-6);
    let one = length(pointer + globe.axis) / max(length(pointer - globe.axis), 1e-6);
    return select(select(both, one, globe.singular < 1.5), 0.0, globe.singular < 0.5);
}

// Colour for a level, the logarithm of 1 + gain.
fn ramp(level: f32) -> vec4f {
    return along_ramp(globe.ramp, level / log(1.0 + globe.max_gain) * 4.0);
}

// Fraction of a pixel that is covered by the lines of gain 1, 2 and 5.
fn isolines(level: f32) -> f32 {
    let steep = max(fwidth(level), 1e-6);
    let off = abs(LEVELS - level);
    let pixels = min(min(off.x, off.y), off.z) / steep;
    return saturate(0.5 + LINE_WIDTH * 0.5 * view.pixel_scale - pixels) * saturate(MAX_SLOPE / steep);
}

@fragment
fn fragment(s: Side) -> Laid {
    let met = meet(pixel_ray(s.position.xy), globe.centre, globe.radius, s.direction);
    let level = log(1.0 + gain(normalize(met.point - globe.centre)));
    let fill = ramp(level);
    let far = s.direction > 0.0;
    let line = isolines(level) * LINE_OPACITY * select(1.0, FAR_LINE, far);

    let share = met.cover * select(NEAR_OPACITY, 1.0, far);
    let opacity = (fill.a + RIM_OPACITY * rim(met.grazing)) * share;
    let colour = mix(fill.rgb, globe.line.rgb, line);
    return Laid(vec4f(colour, mix(opacity, share, line)), depth_of(met.point));
}
