// Skins, from vertices that `skin_deform.wgsl` has moved.

struct Look {
    colour: vec4f, // sRGB; opacity
    wire: vec4f,
    offset: vec3f, // in the world
    has_weights: f32, // 1 to colour by weights, else 0
    ramp: array<vec4f, 5>, // colours of the weights from 0 to 1
}

@group(1) @binding(0) var<uniform> look: Look;

struct Vertex {
    @location(0) position_weight: vec4f,
    @location(1) normal: vec4f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) weight: f32,
}

@vertex
fn vertex(v: Vertex) -> Surface {
    let world = v.position_weight.xyz + look.offset;
    return Surface(view.clip_from_world * vec4f(world, 1.0), world, v.normal.xyz, v.position_weight.w);
}

// Colour of a weight from 0 to 1.
fn ramp(weight: f32) -> vec3f {
    let at = weight * 4.0;
    let first = mix(look.ramp[0], look.ramp[1], saturate(at));
    let second = mix(first, look.ramp[2], saturate(at - 1.0));
    let third = mix(second, look.ramp[3], saturate(at - 2.0));
    return mix(third, look.ramp[4], saturate(at - 3.0)).rgb;
}

fn shaded(s: Surface, colour: vec3f, lights: f32) -> vec3f {
    let ray = pixel_ray(s.position.xy);
    let along = dot(s.world - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    let shade = mix(colour, lit(colour, normalize(s.normal)), lights);
    return behind_planes(fogged(shade, s.position.xy, along), ray, along);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    let colour = mix(look.colour.rgb, ramp(s.weight), look.has_weights);
    return vec4f(shaded(s, colour, 1.0), look.colour.a);
}

@fragment
fn fragment_wire(s: Surface) -> @location(0) vec4f {
    return vec4f(shaded(s, look.wire.rgb, 0.0), look.wire.a);
}
