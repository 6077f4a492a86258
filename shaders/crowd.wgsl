// What the crowd's culling and its drawing share.

struct Crowd {
    planes: array<vec4f, 5>, // of what is seen, their normals inwards: left, right, bottom, top, near
    upper: vec4f, // colours
    lower: vec4f,
    joint: vec4f,
    eye: vec3f,
    per_depth: f32, // the size of a pixel in the world, for each unit of depth
    forward: vec3f,
    per_pixel: f32, // the size of a pixel where depth does not matter
    arms: u32,
    stride: u32, // from one kind of number to the next
    thick: f32, // radii of a limb at its base and its tip
    thin: f32,
}

const JOINT = 1.12; // radius, in those of a limb

struct Arm {
    shoulder: vec3f, // all in the world
    elbow: vec3f,
    hand: vec3f,
}

@group(1) @binding(0) var<uniform> crowd: Crowd;
@group(1) @binding(1) var<storage, read> shoulders: array<f32>; // x, z
@group(1) @binding(2) var<storage, read> posed: array<f32>; // elbow x, y, z, hand x, y, z, in Root space

fn arm_of(number: u32) -> Arm {
    let n = crowd.stride;
    let shoulder = vec3f(shoulders[number], 0.0, shoulders[n + number]);
    let elbow = vec3f(posed[number], posed[n + number], posed[2u * n + number]);
    let hand = vec3f(posed[3u * n + number], posed[4u * n + number], posed[5u * n + number]);
    return Arm(shoulder, shoulder + elbow, shoulder + hand);
}

// How large a pixel is at a point.
fn pixel_at(point: vec3f) -> f32 {
    return crowd.per_pixel + crowd.per_depth * max(dot(point - crowd.eye, crowd.forward), 0.0);
}
