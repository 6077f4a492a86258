// What the levels of detail of a crowd share.

struct Lod {
    sides: u32, // number of sides of a limb
    first: u32, // index in `visible` at which the level's list starts
}

@group(1) @binding(3) var<storage, read> visible: array<u32>;
@group(2) @binding(0) var<uniform> lod: Lod;

fn unit(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(square), square > 0.0);
}

// Vector from a point to the eye, of any length.
fn to_eye(point: vec3f) -> vec3f {
    return mix(crowd.eye - point, -crowd.forward, select(0.0, 1.0, crowd.pixel > 0.0));
}
