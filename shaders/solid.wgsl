// Tapered cylinders and balls, instanced. A vertex says how far along the solid it is and where on
// the rim there; a ball is a solid of no length whose rim is a unit sphere.

struct Vertex {
    @location(0) along: f32, // 0 base, 1 tip
    @location(1) rim: vec3f, // in radii
    @location(2) normal: vec3f, // of an untapered solid
}

struct Instance {
    @location(3) x_length: vec4f, // +x axis, length
    @location(4) y_base_radius: vec4f,
    @location(5) z_tip_radius: vec4f,
    @location(6) origin: vec3f,
    @location(7) colour: vec4f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    // Within the solid, also where its edge is in the pixel.
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec4f,
}

@vertex
fn vertex(v: Vertex, i: Instance) -> Surface {
    let axes = mat3x3f(i.x_length.xyz, i.y_base_radius.xyz, i.z_tip_radius.xyz);
    let length = i.x_length.w;
    let radii = vec2f(i.y_base_radius.w, i.z_tip_radius.w);
    let local = vec3f(v.along * length, 0.0, 0.0) + v.rim * mix(radii.x, radii.y, v.along);
    // A taper tilts the side's normal towards the thinner end; caps have no side to tilt.
    let taper = (radii.x - radii.y) / max(length, 1e-6);
    let tilt = select(0.0, taper, length > 0.0) * dot(v.normal.yz, v.normal.yz);
    let world = i.origin + axes * local;
    return Surface(
        view.clip_from_world * vec4f(world, 1.0),
        world,
        axes * (v.normal + vec3f(tilt, 0.0, 0.0)),
        i.colour,
    );
}

fn shaded(s: Surface) -> vec3f {
    let ray = pixel_ray(s.position.xy);
    let along = dot(s.world - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    let colour = fogged(lit(s.colour.rgb, normalize(s.normal)), s.position.xy, along);
    return behind_shells(behind_planes(colour, ray, along), ray, along);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    return vec4f(shaded(s), 1.0);
}

// What shows through the things in front of it.
@fragment
fn fragment_hidden(s: Surface) -> @location(0) vec4f {
    return vec4f(s.colour.rgb, 0.38);
}
