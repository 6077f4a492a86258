// The arms of a crowd: their corners come from their numbers, and there are no meshes. Near ones have
// round limbs and joints, farther ones limbs of a few sides, the farthest flat ones that face the eye.

struct Level {
    sides: u32, // of a limb
    first: u32, // where the level's list begins
}

@group(1) @binding(3) var<storage, read> seen: array<u32>;
@group(2) @binding(0) var<uniform> level: Level;

struct Surface {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) colour: vec3f,
}

struct Corner {
    at: vec3f,
    normal: vec3f,
}

const TURN = 6.2831853;
const QUAD = array(vec2u(0, 0), vec2u(1, 0), vec2u(1, 1), vec2u(0, 0), vec2u(1, 1), vec2u(0, 1));
const BALL = vec2u(10u, 5u); // around, from pole to pole
const LEAST = 0.4; // radius of a limb on screen, in pixels

fn unit(v: vec3f, otherwise: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(otherwise, v * inverseSqrt(square), square > 0.0);
}

fn corner_of_limb(base: vec3f, tip: vec3f, corner: u32) -> Corner {
    let axis = unit(tip - base, vec3f(0.0, 1.0, 0.0));
    let cell = QUAD[corner % 6u];
    let place = mix(base, tip, f32(cell.y));
    let radius = max(mix(crowd.thick, crowd.thin, f32(cell.y)), LEAST * pixel_at(place));
    if level.sides == 1u {
        let towards = mix(crowd.eye - place, -crowd.forward, select(0.0, 1.0, crowd.per_pixel > 0.0));
        let aside = unit(cross(towards, axis), normalize(view.right));
        let normal = unit(cross(aside, axis), -crowd.forward);
        let facing = select(normal, -normal, dot(normal, towards) < 0.0);
        return Corner(place + aside * radius * (1.0 - 2.0 * f32(cell.x)), facing);
    }
    let up = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(axis.y) > 0.9);
    let y = normalize(cross(up, axis));
    let z = cross(axis, y);
    let turn = TURN * f32(corner / 6u + cell.x) / f32(level.sides);
    let normal = y * cos(turn) + z * sin(turn);
    return Corner(place + normal * radius, normal);
}

fn corner_of_ball(centre: vec3f, corner: u32) -> Corner {
    let cell = QUAD[corner % 6u];
    let quad = vec2u(corner / 6u % BALL.x, corner / 6u / BALL.x) + cell;
    let around = TURN * f32(quad.x) / f32(BALL.x);
    let down = 0.5 * TURN * f32(quad.y) / f32(BALL.y);
    let normal = vec3f(sin(down) * cos(around), cos(down), sin(down) * sin(around));
    return Corner(centre + normal * crowd.thick * JOINT, normal);
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Surface {
    let arm = arm_of(seen[level.first + instance]);
    let limb = level.sides * 6u;
    var corner: Corner;
    var colour = crowd.joint.rgb;
    if index < limb {
        corner = corner_of_limb(arm.shoulder, arm.elbow, index);
        colour = crowd.upper.rgb;
    } else if index < 2u * limb {
        corner = corner_of_limb(arm.elbow, arm.hand, index - limb);
        colour = crowd.lower.rgb;
    } else {
        let ball = BALL.x * BALL.y * 6u;
        let joint = (index - 2u * limb) / ball;
        let centre = select(select(arm.hand, arm.elbow, joint == 1u), arm.shoulder, joint == 0u);
        corner = corner_of_ball(centre, (index - 2u * limb) % ball);
    }
    return Surface(view.clip_from_world * vec4f(corner.at, 1.0), corner.at, corner.normal, colour);
}

@fragment
fn fragment(s: Surface) -> @location(0) vec4f {
    let ray = pixel_ray(s.position.xy);
    let along = dot(s.world - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    let colour = fogged(lit(s.colour, normalize(s.normal)), s.position.xy, along);
    return vec4f(behind_planes(colour, ray, along), 1.0);
}
