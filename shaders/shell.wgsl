// A sphere that one can see through: a faint fill, and a rim where it turns away from the eye.

struct Instance {
    @location(1) centre_radius: vec4f,
    @location(2) colour: vec4f,
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) @interpolate(flat) colour: vec4f,
}

@vertex
fn vertex(@location(0) unit: vec3f, i: Instance) -> Surface {
    let world = i.centre_radius.xyz + unit * i.centre_radius.w;
    return Surface(view.clip_from_world * vec4f(world, 1.0), unit, i.colour);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    let towards = normalize(pixel_ray(s.position.xy).direction);
    let turned = 1.0 - abs(dot(normalize(s.normal), towards));
    let rim = pow(turned, 5.0);
    return vec4f(s.colour.rgb, s.colour.a * (0.045 + 0.5 * rim));
}
