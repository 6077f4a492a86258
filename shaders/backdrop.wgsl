// Everything behind the solids: the sky, and planes and shells in front of it. Drawn after them, at the
// far end of the depth range, so that only what they leave free is computed.

const FARTHEST = 1e30;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = pixel_ray(position.xy);
    let planes = behind_planes(sky(position.xy), ray, FARTHEST);
    return vec4f(behind_shells(planes, ray, FARTHEST), 1.0);
}
