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
    @location(8) winding: vec2f, // 1 if it winds, else 0; winding in radians
    @location(9) least_radius: f32, // on screen, of the thicker end, in points
}

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    // At the edges of a solid, centroid sampling takes the normal from inside the solid.
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec4f,
}

// The section of a solid that winds, towards its tip: its thickness, and the power of its round
// rectangle, which is 2 for a circle.
const THICKNESS = 0.66;
const POWER = 3.2;

// Point and normal of the side of a solid that winds.
struct Wound {
    rim: vec3f,
    normal: vec3f,
}

fn wound(rim: vec3f, normal: vec3f, along: f32, winding: f32) -> Wound {
    let turn = winding * along;
    let axis = vec2f(cos(turn), sin(turn));
    let shape = smoothstep(0.0, 1.0, along);
    let flat = vec2f(mix(1.0, THICKNESS, shape), 1.0);
    let power = mix(2.0, POWER, shape);
    // In axes that wind along.
    let round = vec2f(dot(rim.yz, axis), dot(rim.yz, vec2f(-axis.y, axis.x)));
    let size = abs(round);
    let stretch = pow(max(pow(size.x, power) + pow(size.y, power), 1e-12), -1.0 / power);
    let at = round * stretch * flat * length(round);
    let out = sign(round) * pow(size, vec2f(power - 1.0)) / flat;
    let side = out * inverseSqrt(max(dot(out, out), 1e-12));
    let back = mat2x2f(axis, vec2f(-axis.y, axis.x));
    let is_cap = abs(normal.x) > 0.5;
    return Wound(
        vec3f(rim.x, back * at),
        select(vec3f(0.0, back * side), normal, is_cap),
    );
}

@vertex
fn vertex(v: Vertex, i: Instance) -> Surface {
    let axes = mat3x3f(i.x_length.xyz, i.y_base_radius.xyz, i.z_tip_radius.xyz);
    let length = i.x_length.w;
    let radii = vec2f(i.y_base_radius.w, i.z_tip_radius.w);
    let centre = i.origin + axes[0] * (v.along * length);
    let pixel = pixel_size(dot(centre - view.eye, view.forward));
    let grow = max(1.0, i.least_radius * view.pixel_scale * pixel / max(radii.x, radii.y));
    var side = Wound(v.rim, v.normal);
    if i.winding.x > 0.0 {
        side = wound(v.rim, v.normal, v.along, i.winding.y);
    }
    let around = side.rim * (mix(radii.x, radii.y, v.along) * grow);
    // A taper tilts the side's normal towards the thinner end, but not the caps' normals.
    let taper = (radii.x - radii.y) / max(length, 1e-6);
    let tilt = select(0.0, taper, length > 0.0) * dot(v.normal.yz, v.normal.yz);
    let world = centre + axes * around;
    return Surface(
        view.clip_from_world * vec4f(world, 1.0),
        world,
        axes * (side.normal + vec3f(tilt, 0.0, 0.0)),
        i.colour,
    );
}

fn shaded(s: Surface) -> vec3f {
    let colour = lit(s.colour.rgb, normalize(s.normal));
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
