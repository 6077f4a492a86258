// Arms of a crowd, for culling and drawing.

struct Crowd {
    planes: array<vec4f, 5>, // of the view frustum, normals inwards: left, right, bottom, top, near
    upper: vec4f, // colours of the limbs and joints
    lower: vec4f,
    joint: vec4f,
    lods: array<Lod, 5>, // from the nearest arms to the farthest
    eye: vec3f,
    pixel_per_depth: f32, // size of a pixel in the world per unit of depth; 0 if orthographic
    forward: vec3f,
    pixel: f32, // size of a pixel in the world if orthographic, else 0
    arms: u32,
    stride: u32, // distance between arrays, in floats
    base_radius: f32, // of a limb, in world units
    resolution_scale: f32, // fraction of the full width and height at which the picture is drawn
}

// A level of detail.
struct Lod {
    sides: u32, // number of sides of a limb; 0 for a line or a point
    vertices: u32, // number of vertices of an entry in the list
    first: u32, // index in `visible` at which the list starts
    padding: u32,
}

// As multiples of the radius of a limb at its base.
const TIP_RADIUS = 0.68;
const JOINT_RADIUS = 1.12;

struct Arm {
    shoulder: vec3f, // all points are in the world
    elbow: vec3f,
    hand: vec3f,
}

struct Limb {
    base: vec3f,
    tip: vec3f,
}

@group(1) @binding(0) var<uniform> crowd: Crowd;
// Arrays of x and z, in the world.
@group(1) @binding(1) var<storage, read> shoulders: array<f32>;
// Arrays of elbow x, y and z, hand x, y and z, in Root space.
@group(1) @binding(2) var<storage, read> poses: array<f32>;

fn arm_at(index: u32) -> Arm {
    let n = crowd.stride;
    let shoulder = vec3f(shoulders[index], 0.0, shoulders[n + index]);
    let elbow = vec3f(poses[index], poses[n + index], poses[2u * n + index]);
    let hand = vec3f(poses[3u * n + index], poses[4u * n + index], poses[5u * n + index]);
    return Arm(shoulder, shoulder + elbow, shoulder + hand);
}

// The lower limb if `is_lower`, else the upper one.
fn limb_of(arm: Arm, is_lower: bool) -> Limb {
    return Limb(select(arm.shoulder, arm.elbow, is_lower), select(arm.elbow, arm.hand, is_lower));
}

// Size of a pixel at a point, in world units.
fn pixel_at(point: vec3f) -> f32 {
    return crowd.pixel + crowd.pixel_per_depth * max(dot(point - crowd.eye, crowd.forward), 0.0);
}

// Vector from a point to the eye, of any length.
fn to_eye(point: vec3f) -> vec3f {
    return mix(crowd.eye - point, -crowd.forward, select(0.0, 1.0, crowd.pixel > 0.0));
}

fn unit(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(square), square > 0.0);
}
