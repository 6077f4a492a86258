// Skins, from vertices that `skin_deform.wgsl` has moved.

struct Look {
    colour: vec4f, // sRGB; opacity
    wire: vec4f,
    offset: vec3f, // in the world
    has_weights: f32, // 1 to colour by weights, else 0
    tint: vec4f, // over what has a weight; opacity where the weight is 1
    ramp: array<vec4f, 5>, // colours of the weights from 0 to 1
}

@group(1) @binding(0) var<uniform> look: Look;

// Opacity of the tint where the surface faces the eye, as a fraction of that at the outline.
const TINT_INSIDE = 0.15;
const OUTLINE = 1.6; // opacity at the outline of an onion skin that is added, as a multiple

// A constant, because a software adapter samples the texture even if a uniform selects the other branch.
override IS_TEXTURED = false;
// Whether a texture multiplies the emission.
override HAS_EMISSION_TEXTURE = false;
// Side of triangles that is outside, of parts that are seen from both: 1 for the front, -1 for the back of
// mirrored skins; 0 for parts that are seen from outside alone.
override OUTER_SIDE = 0.0;
// Whether the opacity of parts counts.
override IS_BLENDED = false;

// Material of a part. Colours are multiplied in sRGB instead of linear light. sRGB is nearly a power of
// linear light, and the power of a product is the product of the powers, so the error is small.
struct Part {
    colour: vec3f, // sRGB
    alpha_cutoff: f32, // opacity of the texture below which nothing is drawn
    emission: vec3f, // sRGB
    opacity: f32,
}

@group(2) @binding(0) var<uniform> part: Part;
@group(2) @binding(1) var part_texture: texture_2d<f32>;
@group(2) @binding(2) var part_sampler: sampler;
@group(2) @binding(3) var part_emission: texture_2d<f32>;

struct Vertex {
    @location(0) position_weight: vec4f,
    @location(1) normal: vec4f,
    @location(2) coordinates: vec2f,
    @location(3) colour: vec4f, // sRGB
    @location(4) emission_coordinates: vec2f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) weight: f32,
    @location(3) coordinates: vec2f,
    @location(4) colour: vec4f,
    @location(5) emission_coordinates: vec2f,
}

@vertex
fn vertex(v: Vertex) -> Surface {
    let world = v.position_weight.xyz + look.offset;
    let position = view.clip_from_world * vec4f(world, 1.0);
    return Surface(
        position,
        world,
        v.normal.xyz,
        v.position_weight.w,
        v.coordinates,
        v.colour,
        v.emission_coordinates,
    );
}

@fragment
fn fragment(s: Surface, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    var emission = part.emission * (1.0 - look.has_weights);
    if HAS_EMISSION_TEXTURE {
        emission *= textureSample(part_emission, part_sampler, s.emission_coordinates).rgb;
    }
    var own = look.colour.rgb * part.colour * s.colour.rgb;
    var opacity = look.colour.a;
    if IS_BLENDED {
        opacity *= part.opacity * s.colour.a;
    }
    if IS_TEXTURED {
        let texel = textureSample(part_texture, part_sampler, s.coordinates);
        if texel.a < part.alpha_cutoff {
            discard;
        }
        own *= texel.rgb;
        if IS_BLENDED {
            opacity *= texel.a;
        }
    }
    var normal = normalize(s.normal);
    if OUTER_SIDE != 0.0 && is_front != (OUTER_SIDE > 0.0) {
        normal = -normal;
    }
    let of_weight = along_ramp(look.ramp, s.weight * 4.0).rgb;
    let emitted = decoded(emission);
    // Strong at the outline and faint in the middle, so that the shape stays readable.
    let to_eye = normalize(mix(view.eye - s.world, -view.forward, view.orthographic));
    let grazing = 1.0 - abs(dot(normal, to_eye));
    let tint = look.tint.a * smoothstep(0.1, 0.6, s.weight) * mix(TINT_INSIDE, 1.0, grazing * grazing * grazing);
    let tinted = mix(mix(own, of_weight, look.has_weights), look.tint.rgb, tint);
    // Denser at the outline of an onion skin, so that several in front of each other are told apart.
    opacity *= 1.0 + (1.0 - look.colour.a) * OUTLINE * grazing * grazing * grazing;
    let light = reflected(tinted, normal) + emitted;
    // As bright as `encoded` is exact.
    let colour = encoded(min(light, vec3f(1.4)));
    return vec4f(fogged(colour, s.world, s.position.xy), opacity);
}

// The depth alone, but where the texture cuts out.
@fragment
fn fragment_depth(s: Surface) -> @location(0) vec4f {
    if IS_TEXTURED && textureSample(part_texture, part_sampler, s.coordinates).a < part.alpha_cutoff {
        discard;
    }
    return vec4f();
}

@fragment
fn fragment_wire(s: Surface) -> @location(0) vec4f {
    return vec4f(fogged(look.wire.rgb, s.world, s.position.xy), look.wire.a);
}
