// Culls the arms of a crowd, sorts the visible ones into one list for each level of detail, and computes
// the colours of far limbs.

// One list for each level of detail. Entries of the first three are arms. Entries of lines and points
// are limbs (2 × arm, and 1 more for the lower one), each followed by its colour.
@group(1) @binding(3) var<storage, read_write> visible: array<u32>;
// Four arguments of a draw for each level of detail. The first is the number of vertices.
@group(1) @binding(4) var<storage, read_write> draws: array<atomic<u32>>;

const LINES = 3u;
const POINTS = 4u;

// Minimum radii of a limb in pixels at which it is drawn round with joints, round without joints,
// flat, and as a line.
const LOD_RADII = vec4f(3.0, 1.2, 0.5, 0.1);

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    if index >= crowd.arms {
        return;
    }
    let arm = arm_at(index);
    let least = min(arm.shoulder, min(arm.elbow, arm.hand));
    let most = max(arm.shoulder, max(arm.elbow, arm.hand));
    let middle = (least + most) * 0.5;
    let radius = length(most - middle) + crowd.base_radius * JOINT_RADIUS;
    for (var side = 0u; side < 5u; side++) {
        let plane = crowd.planes[side];
        if dot(plane.xyz, middle) + plane.w < -radius {
            return;
        }
    }
    let pixels = crowd.base_radius / pixel_at(middle);
    let is_smaller = select(vec4u(0), vec4u(1), vec4f(pixels) <= LOD_RADII);
    let lod = dot(is_smaller, vec4u(1));
    if lod < LINES {
        visible[crowd.lods[lod].first + next_slot(lod)] = index;
    } else {
        add_limb(lod, 2u * index, limb_of(arm, false), crowd.upper.rgb);
        add_limb(lod, 2u * index + 1u, limb_of(arm, true), crowd.lower.rgb);
    }
}

// Reserves an entry in a list and returns its index.
fn next_slot(lod: u32) -> u32 {
    let vertices = crowd.lods[lod].vertices;
    return atomicAdd(&draws[lod * 4u], vertices) / vertices;
}

// Adds a limb as a line or a point. A line is a pixel wide, and a point covers a whole pixel, which may be
// more than the limb covers if it is a pixel wide at full resolution. So the limb is drawn with the ratio
// of the two areas as its probability (after R. Cook and others, "Stochastic Simplification of Aggregate
// Detail", 2007): far arms are as dense as lines, as points, and in a smaller picture.
fn add_limb(lod: u32, number: u32, limb: Limb, colour: vec3f) {
    let middle = (limb.base + limb.tip) * 0.5;
    let towards = to_eye(middle);
    let axis = limb.tip - limb.base;
    let across = towards * inverseSqrt(dot(towards, towards));
    let pixel = pixel_at(middle);
    let pixels = length(cross(axis, across)) / pixel;
    let width = max((1.0 + TIP_RADIUS) * crowd.base_radius / pixel, crowd.resolution_scale);
    if select(1.0, pixels, lod == POINTS) * width < random(number) {
        return;
    }
    let direction = unit(axis, vec3f(0.0, 1.0, 0.0));
    let normal = unit(towards - direction * dot(direction, towards), -crowd.forward);
    let entry = crowd.lods[lod].first + 2u * next_slot(lod);
    visible[entry] = number;
    let seen = fogged(lit(colour, normal), middle, pixel_of(middle));
    visible[entry + 1u] = pack4x8unorm(vec4f(behind_floor(seen, middle), 1.0));
}

// A number from 0 to 1 that is always the same for a limb (M. O'Neill, "PCG", 2014).
fn random(limb: u32) -> f32 {
    let state = limb * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// The colour of a point as it shines through the floor if that is in front of it. The floor cannot be drawn
// over the points of far limbs, each of which has one depth for its whole pixel.
fn behind_floor(colour: vec3f, point: vec3f) -> vec3f {
    let towards = to_eye(point);
    let part = -point.y / towards.y;
    let is_behind = point.y < 0.0 && towards.y > 0.0 && (view.orthographic > 0.5 || part < 1.0);
    let opacity = view.ground.a * presence(point + towards * part, FLOOR_RADIUS);
    return mix(colour, view.ground.rgb, select(0.0, opacity, is_behind));
}

// Position of a point in the picture, in pixels.
fn pixel_of(point: vec3f) -> vec2f {
    let clip = view.clip_from_world * vec4f(point, 1.0);
    return (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * view.size;
}
