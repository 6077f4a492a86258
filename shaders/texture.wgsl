// A texture, stretched over the whole picture.

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
}

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var image_sampler: sampler;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    // A triangle that covers the picture.
    let at = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Corner(vec4f(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0), at);
}

@fragment
fn fragment(c: Corner) -> @location(0) vec4f {
    return textureSampleLevel(image, image_sampler, c.at, 0.0);
}
