// Glyphs of labels: rectangles of the glyph atlas, drawn at positions in clip space.

struct Instance {
    @location(0) target_rect: vec4f, // left, top, and from there to the right and bottom
    @location(1) source: vec4f, // left, top, width, height in the atlas, from 0 to 1
    @location(2) colour: vec4f,
}

struct Glyph {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f,
    @location(1) @interpolate(flat) colour: vec4f,
}

@group(0) @binding(0) var atlas: texture_2d<f32>;
@group(0) @binding(1) var atlas_sampler: sampler;

@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Glyph {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    let clip = i.target_rect.xy + corner * i.target_rect.zw;
    return Glyph(vec4f(clip, 1.0, 1.0), i.source.xy + corner * i.source.zw, i.colour);
}

@fragment
fn fragment(g: Glyph) -> @location(0) vec4f {
    let cover = textureSample(atlas, atlas_sampler, g.at).a;
    return vec4f(g.colour.rgb, g.colour.a * cover);
}
