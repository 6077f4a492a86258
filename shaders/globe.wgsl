// The sphere of every way that the Pointer can point, coloured by how far the elbow swings there:
// met analytically, its far side and then its near side laid over what is behind them. Right from
// inside too, where there is no near side.

const RIM_OPACITY = 0.3;
const FAR_OPACITY = 0.65; // of what the near side has
const LINE_WIDTH = 1.3; // pixels
const LINE_OPACITY = 0.55;
const LEVELS = vec3f(0.6931472, 1.0986123, 1.7917595); // ln 2, ln 3, ln 6: gains 1, 2 and 5
const STEEPEST = 0.2; // so much in a pixel that a line would be smeared

struct Globe {
    centre: vec3f,
    radius: f32,
    axis: vec3f, // unit, towards a singular direction
    singular: f32, // how many directions are: none, the axis, or both its ends
    ramp: array<vec4f, 5>, // from gain 0, evenly in the logarithm of 1 + gain
    line: vec4f,
    hot: f32, // the gain at the ramp's end
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

// A square around the sphere, turned towards the eye; the whole picture from inside.
@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Side {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let direction = 1.0 - 2.0 * f32(instance);
    let to_centre = globe.centre - view.eye;
    let away = length(to_centre);
    let parallel = view.orthographic > 0.5;
    if !parallel && away < globe.radius * 1.05 {
        return Side(vec4f(corner, 0.5, 1.0), direction);
    }
    let facing = select(to_centre / away, view.forward, parallel);
    let beside = dot(facing, view.right);
    let helper = select(view.right, view.forward, beside * beside > 0.5 * dot(view.right, view.right));
    let across = normalize(cross(helper, facing));
    let upwards = cross(facing, across);
    let tangent = sqrt(away * away - globe.radius * globe.radius) / away;
    let seen_radius = globe.radius / select(tangent, 1.0, parallel);
    let extent = seen_radius + 2.0 * pixel_size(dot(to_centre, view.forward));
    let world = globe.centre + (across * corner.x + upwards * corner.y) * extent;
    return Side(view.clip_from_world * vec4f(world, 1.0), direction);
}

// How far the elbow turns for every radian that the Pointer does: as `Reference::gain`.
fn gain(pointer: vec3f) -> f32 {
    let both = abs(dot(pointer, globe.axis)) / max(length(cross(pointer, globe.axis)), 1e-6);
    let one = length(pointer + globe.axis) / max(length(pointer - globe.axis), 1e-6);
    return select(select(both, one, globe.singular < 1.5), 0.0, globe.singular < 0.5);
}

// The colour of a gain, by the logarithm of 1 + gain.
fn ramp(level: f32) -> vec4f {
    let at = level / log(1.0 + globe.hot) * 4.0;
    let first = mix(globe.ramp[0], globe.ramp[1], saturate(at));
    let second = mix(first, globe.ramp[2], saturate(at - 1.0));
    let third = mix(second, globe.ramp[3], saturate(at - 2.0));
    return mix(third, globe.ramp[4], saturate(at - 3.0));
}

// How much of a pixel the lines of gain 1, 2 and 5 cover.
fn isolines(level: f32) -> f32 {
    let steep = max(fwidth(level), 1e-6);
    let off = abs(LEVELS - level);
    let pixels = min(min(off.x, off.y), off.z) / steep;
    return saturate(0.5 + LINE_WIDTH * 0.5 * view.pixel_scale - pixels) * saturate(STEEPEST / steep);
}

@fragment
fn fragment(s: Side) -> Laid {
    let ray = pixel_ray(s.position.xy);
    let squared = dot(ray.direction, ray.direction);
    let from_centre = ray.origin - globe.centre;
    let middle = -dot(from_centre, ray.direction) / squared;
    let miss = length(from_centre + ray.direction * middle);
    let half_chord = sqrt(max(globe.radius * globe.radius - miss * miss, 0.0));
    let half_along = half_chord * inverseSqrt(squared);
    let along = middle + half_along * s.direction;
    let met = ray.origin + ray.direction * along;

    let level = log(1.0 + gain(normalize(met - globe.centre)));
    let fill = ramp(level);
    let line = isolines(level) * LINE_OPACITY;

    let turned = 1.0 - half_chord / globe.radius;
    let turned_squared = turned * turned;
    let rim = RIM_OPACITY * turned_squared * turned_squared * turned;
    let size = pixel_size(middle);
    let edge = saturate(0.5 + (globe.radius - miss) / size) * saturate(globe.radius / size);
    let in_front = select(0.0, 1.0, along > nearest_along());
    let behind_near = s.direction > 0.0 && middle - half_along > nearest_along();
    let share = edge * in_front * select(1.0, FAR_OPACITY, behind_near);

    let opacity = (fill.a + rim) * share;
    let colour = mix(fill.rgb, globe.line.rgb, line);
    let clip = view.clip_from_world * vec4f(met, 1.0);
    return Laid(vec4f(colour, mix(opacity, share, line)), clip.z / clip.w);
}
