// Flat triangles, coloured by their corners and a texture.

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) in_texture: vec2f,
    @location(1) colour: vec4f,
}

// Width and height of the picture.
@group(0) @binding(0) var<uniform> size: vec4f;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var image_sampler: sampler;

@vertex
fn vertex(
    @location(0) at: vec2f,
    @location(1) in_texture: vec2f,
    @location(2) colour: vec4f,
) -> Corner {
    let part = at / size.xy;
    return Corner(vec4f(part.x * 2.0 - 1.0, 1.0 - part.y * 2.0, 0.0, 1.0), in_texture, colour);
}

@fragment
fn fragment(c: Corner) -> @location(0) vec4f {
    return c.colour * textureSampleLevel(image, image_sampler, c.in_texture, 0.0);
}
