// One side of a see-through sphere: a faint fill, and a brighter rim.

const FILL_OPACITY = 0.045;
const RIM_OPACITY = 0.5;

struct Instance {
    @location(0) centre_radius: vec4f,
    @location(1) colour: vec4f,
    @location(2) side: f32, // -1 near, 1 far
}

struct Side {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) centre_radius: vec4f,
    @location(1) @interpolate(flat) colour: vec4f,
    @location(2) @interpolate(flat) side: f32,
}

struct Laid {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Side {
    let position = covering(index, i.centre_radius.xyz, i.centre_radius.w);
    return Side(position, i.centre_radius, i.colour, i.side);
}

@fragment
fn fragment(s: Side) -> Laid {
    let met = meet(pixel_ray(s.position.xy), s.centre_radius.xyz, s.centre_radius.w, s.side);
    let opacity = (FILL_OPACITY + RIM_OPACITY * rim(met.grazing)) * met.cover * s.colour.a;
    return Laid(vec4f(s.colour.rgb, opacity), depth_of(met.point));
}
