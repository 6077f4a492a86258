// Near arms of a crowd, without meshes: vertices are computed from their indices. The nearest have
// round limbs and joints, farther ones limbs with few sides or flat limbs that face the eye.

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec3f,
}

struct Vertex {
    position: vec3f,
    normal: vec3f,
}

const TAU = 6.2831853;
const QUAD = array(vec2u(0, 0), vec2u(1, 0), vec2u(1, 1), vec2u(0, 0), vec2u(1, 1), vec2u(0, 1));
const BALL = vec2u(10u, 5u); // number of cells around, and from pole to pole
const MIN_RADIUS = 0.4; // of a limb on screen, in pixels of the full resolution

fn limb_vertex(limb: Limb, sides: u32, index: u32) -> Vertex {
    let axis = unit(limb.tip - limb.base, vec3f(0.0, 1.0, 0.0));
    let cell = QUAD[index % 6u];
    let place = mix(limb.base, limb.tip, f32(cell.y));
    let min_radius = MIN_RADIUS * crowd.resolution_scale * pixel_at(place);
    let radius = max(crowd.base_radius * mix(1.0, TIP_RADIUS, f32(cell.y)), min_radius);
    if sides == 1u {
        let towards = to_eye(place);
        let aside = unit(cross(towards, axis), normalize(view.right));
        let normal = unit(cross(aside, axis), -crowd.forward);
        let facing = select(normal, -normal, dot(normal, towards) < 0.0);
        return Vertex(place + aside * radius * (1.0 - 2.0 * f32(cell.x)), facing);
    }
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(axis.y) > 0.9);
    let y = normalize(cross(up, axis));
    let z = cross(axis, y);
    let turn = TAU * f32(index / 6u + cell.x) / f32(sides);
    let normal = y * cos(turn) + z * sin(turn);
    return Vertex(place + normal * radius, normal);
}

fn ball_vertex(centre: vec3f, index: u32) -> Vertex {
    let cell = QUAD[index % 6u];
    let quad = vec2u(index / 6u % BALL.x, index / 6u / BALL.x) + cell;
    let around = TAU * f32(quad.x) / f32(BALL.x);
    let down = 0.5 * TAU * f32(quad.y) / f32(BALL.y);
    let normal = vec3f(sin(down) * cos(around), cos(down), sin(down) * sin(around));
    return Vertex(centre + normal * crowd.base_radius * JOINT_RADIUS, normal);
}

@vertex
fn vertex(@builtin(vertex_index) number: u32) -> Surface {
    let lod = crowd.lods[LOD];
    let arm = arm_at(visible[lod.first + number / lod.vertices]);
    let index = number % lod.vertices;
    let limb = lod.sides * 6u; // number of vertices of a limb
    var corner: Vertex;
    var colour = crowd.joint.rgb;
    if index < limb {
        corner = limb_vertex(limb_of(arm, false), lod.sides, index);
        colour = crowd.upper.rgb;
    } else if index < 2u * limb {
        corner = limb_vertex(limb_of(arm, true), lod.sides, index - limb);
        colour = crowd.lower.rgb;
    } else {
        let ball = BALL.x * BALL.y * 6u;
        let joint = (index - 2u * limb) / ball;
        let centre = select(select(arm.hand, arm.elbow, joint == 1u), arm.shoulder, joint == 0u);
        corner = ball_vertex(centre, (index - 2u * limb) % ball);
    }
    return Surface(view.clip_from_world * vec4f(corner.position, 1.0), corner.position, corner.normal, colour);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    let colour = lit(s.colour, normalize(s.normal));
    return vec4f(fogged(colour, s.world, s.position.xy), 1.0);
}
