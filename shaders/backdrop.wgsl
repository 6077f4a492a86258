// Everything behind the solids: the sky, and the planes in front of it. Drawn after them, at the
// far end of the depth range, so that only what they leave free is computed.

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(behind_planes(sky(position.xy), pixel_ray(position.xy), 1e30), 1.0);
}
