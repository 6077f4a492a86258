// Far arms of a crowd: each limb is a line or a point, with a colour that `crowd_cull.wgsl` has computed.

struct Spot {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) colour: vec3f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Spot {
    let lod = crowd.lods[LOD];
    let entry = lod.first + 2u * (index / lod.vertices);
    let number = visible[entry];
    let limb = limb_of(arm_at(number / 2u), number % 2u == 1u);
    let is_point = lod.vertices == 1u;
    let place = mix(limb.base, limb.tip, select(f32(index % 2u), 0.5, is_point));
    return Spot(view.clip_from_world * vec4f(place, 1.0), unpack4x8unorm(visible[entry + 1u]).rgb);
}

@fragment
fn fragment(s: Spot) -> @location(0) vec4f {
    return vec4f(s.colour, 1.0);
}
