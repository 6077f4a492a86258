// Instanced tapered cylinders and balls. A vertex has a position along the solid and a position on
// the rim there. A ball is a solid of length 0 whose rim is a unit sphere.

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
    @location(8) stripes: vec2f, // 1 with stripes or 0 without, winding in radians
    @location(9) least_radius: f32, // on screen, of the thicker end, in points
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    // At the edges of a solid, centroid sampling takes the normal from inside the solid.
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec4f,
    @location(3) around_along: vec3f, // position on the rim and along the solid
    @location(4) @interpolate(flat) stripes: vec2f, // strength, winding
}

const STRIPES = 5.0;
const STRIPE_WIDTH = 0.13; // as a fraction of the distance between two stripes
const STRIPE_SHADE = 0.3;

@vertex
fn vertex(v: Vertex, i: Instance) -> Surface {
    let axes = mat3x3f(i.x_length.xyz, i.y_base_radius.xyz, i.z_tip_radius.xyz);
    let length = i.x_length.w;
    let radii = vec2f(i.y_base_radius.w, i.z_tip_radius.w);
    let centre = i.origin + axes[0] * (v.along * length);
    let pixel = pixel_size(dot(centre - view.eye, view.forward));
    let grow = max(1.0, i.least_radius * view.pixel_scale * pixel / max(radii.x, radii.y));
    let around = v.rim * (mix(radii.x, radii.y, v.along) * grow);
    // A taper tilts the side's normal towards the thinner end, but not the caps' normals.
    let taper = (radii.x - radii.y) / max(length, 1e-6);
    let tilt = select(0.0, taper, length > 0.0) * dot(v.normal.yz, v.normal.yz);
    let world = centre + axes * around;
    return Surface(
        view.clip_from_world * vec4f(world, 1.0),
        world,
        axes * (v.normal + vec3f(tilt, 0.0, 0.0)),
        i.colour,
        vec3f(v.rim.yz, v.along),
        vec2f(i.stripes.x * dot(v.normal.yz, v.normal.yz), i.stripes.y),
    );
}

// Darkness of the stripes at a pixel. The angle around the solid jumps at a seam, so its derivative
// is computed from the position on the rim instead.
fn stripe_shade(s: Surface) -> f32 {
    let rim = s.around_along.xy;
    let turn = vec2f(
        rim.x * dpdx(rim.y) - rim.y * dpdx(rim.x),
        rim.x * dpdy(rim.y) - rim.y * dpdy(rim.x),
    ) / max(dot(rim, rim), 1e-6);
    let wound = vec2f(dpdx(s.around_along.z), dpdy(s.around_along.z)) * s.stripes.y;
    let per_radian = STRIPES / 6.2831853;
    let pixel = max(length(turn - wound) * per_radian, 1e-6);
    let at = (atan2(rim.y, rim.x) - s.around_along.z * s.stripes.y) * per_radian;
    let off = abs(at - round(at));
    let width = max(STRIPE_WIDTH, pixel);
    let sharp = saturate(0.5 + (width * 0.5 - off) / pixel) * STRIPE_WIDTH / width;
    let cover = mix(sharp, STRIPE_WIDTH, saturate(pixel * 2.0 - 1.0));
    return cover * STRIPE_SHADE * s.stripes.x;
}

fn shaded(s: Surface) -> vec3f {
    let colour = lit(s.colour.rgb * (1.0 - stripe_shade(s)), normalize(s.normal));
    return fogged(colour, s.world, s.position.xy);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    return vec4f(shaded(s), 1.0);
}

// Flat see-through colour of a guide where other surfaces hide it.
@fragment
fn fragment_hidden(s: Surface) -> @location(0) vec4f {
    return vec4f(s.colour.rgb, 0.38);
}
