// Background: the sky with the planes in front of it.

const MAX_DISTANCE = 1e30;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return vec4f(corner, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = pixel_ray(position.xy);
    return vec4f(behind_planes(sky(position.xy), ray, MAX_DISTANCE), 1.0);
}
