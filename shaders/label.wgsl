// Glyphs of labels: rectangles of the glyph atlas, drawn at positions in clip space.

struct Instance {
    @location(0) target_rect: vec4f, // left, top, and from there to the right and bottom
    @location(1) source: vec4f, // left, top, width, height in the atlas, in pixels
    @location(2) colour: vec4f,
}

struct Glyph {
    @builtin(position) position: vec4f,
    @location(0) at: vec2f, // from the left and top of the glyph, in pixels of the atlas
    @location(1) @interpolate(flat) source: vec4f,
    @location(2) @interpolate(flat) colour: vec4f,
}

@group(0) @binding(0) var atlas: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Glyph {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    let clip = i.target_rect.xy + corner * i.target_rect.zw;
    return Glyph(vec4f(clip, 1.0, 1.0), corner * i.source.zw, i.source, i.colour);
}

@fragment
fn fragment(g: Glyph) -> @location(0) vec4f {
    // Linear between the centres of pixels. A sampler would round by the glyph's place in the atlas, which
    // depends on the glyphs before it.
    let at = g.at - 0.5;
    let low = floor(at);
    let part = at - low;
    let first = vec2i(low);
    let upper = mix(cover(g.source, first), cover(g.source, first + vec2i(1, 0)), part.x);
    let lower = mix(cover(g.source, first + vec2i(0, 1)), cover(g.source, first + 1), part.x);
    return vec4f(g.colour.rgb, g.colour.a * mix(upper, lower, part.y));
}

// Coverage of a pixel of the glyph; 0 outside.
fn cover(source: vec4f, pixel: vec2i) -> f32 {
    let size = vec2i(source.zw);
    if any(pixel < vec2i(0)) || any(pixel >= size) {
        return 0.0;
    }
    return textureLoad(atlas, vec2i(source.xy) + pixel, 0).a;
}
