// Soft shadow of a limb on the floor, and the ambient light that the limb hides where it is near the
// floor. The limb is a capsule, and the key light has a width, so that the shadow gets softer and
// fainter with the height of the limb.

// Steeper than the key light, so that a shadow stays near the feet of what casts it.
const SHADOW_DIRECTION = vec3f(0.193064, 0.877563, 0.438782);
const LIGHT_WIDTH = 0.2;
const CONTACT = 0.35; // softness where the limb touches the ground, as a fraction of its radius
const THIN = 8.0; // softness in radii from which a limb is too thin to hide all light
const LEAST_RADIUS = 0.6; // points
const AMBIENT = 0.75; // part of the light that is ambient, as a multiple of the shadow's strength
const LEAST_AMBIENT = 0.05; // hidden part of the ambient light that is left out
// Radius around a ball on the floor in which it hides more, as a multiple of its own, and the height
// from which it hides less everywhere.
const AMBIENT_RADIUS = 2.8;
const AMBIENT_HEIGHT = 4.5;

struct Instance {
    @location(0) base: vec4f, // centre, radius
    @location(1) tip: vec4f,
}

struct Ground {
    @builtin(position) position: vec4f,
    @location(0) point: vec3f,
    @location(1) @interpolate(flat) base: vec4f,
    @location(2) @interpolate(flat) tip: vec4f,
}

// Centre (x and z) of a ball's shadow on the ground, and radius of the shadow.
fn shadow_of(ball: vec4f) -> vec3f {
    let height = ball.y / SHADOW_DIRECTION.y;
    let point = ball.xyz - SHADOW_DIRECTION * height;
    return vec3f(point.xz, (ball.w * (1.0 + CONTACT) + height * LIGHT_WIDTH) / SHADOW_DIRECTION.y);
}

// The same for the ambient light that a ball hides.
fn ambient_of(ball: vec4f) -> vec3f {
    return vec3f(ball.xz, select(0.0, AMBIENT_RADIUS * ball.w, ball.y < AMBIENT_HEIGHT * ball.w));
}

// A ball that is wide enough on screen to be seen.
fn seen(ball: vec4f) -> vec4f {
    let pixel = pixel_size(dot(ball.xyz - view.eye, view.forward));
    return vec4f(ball.xyz, max(ball.w, LEAST_RADIUS * view.pixel_scale * pixel));
}

// Corner of a rectangle on the floor around what both ends hide.
@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Ground {
    let base = seen(i.base);
    let tip = seen(i.tip);
    let circles = array(shadow_of(base), shadow_of(tip), ambient_of(base), ambient_of(tip));
    let way = circles[1].xy - circles[0].xy;
    let long = length(way);
    let along = select(vec2f(1.0, 0.0), way / long, long > 0.0);
    let axes = mat2x2f(along, vec2f(-along.y, along.x));
    var low = vec2f(1e30);
    var high = vec2f(-1e30);
    for (var circle = 0; circle < 4; circle++) {
        let centre = circles[circle].xy * axes;
        low = min(low, centre - circles[circle].z);
        high = max(high, centre + circles[circle].z);
    }
    let flat = axes * select(low, high, vec2<bool>((index & 2u) != 0u, (index & 1u) != 0u));
    let point = vec3f(flat.x, 0.0, flat.y);
    return Ground(view.clip_from_world * vec4f(point, 1.0), point, base, tip);
}

// How much a limb of a length hides at a distance `along` from its base: all in the middle, half at its ends,
// and nothing farther than `soft` beyond. So the shares of limbs in a row add up to 1.
fn share_at(along: f32, length: f32, soft: f32) -> f32 {
    return smoothstep(-soft, soft, along) - smoothstep(-soft, soft, along - length);
}

// Part of the ambient light that the limb hides: that of the ball at the nearest point of its axis.
fn hidden_ambient(g: Ground, axis: vec3f) -> f32 {
    let from_base = g.point - g.base.xyz;
    let along = dot(axis, from_base) / max(dot(axis, axis), 1e-6);
    let part = saturate(along);
    let away = axis * part - from_base;
    let far = max(length(away), 1e-6);
    let radius = mix(g.base.w, g.tip.w, part);
    let ratio = min(radius / far, 1.0);
    let hidden = ratio * ratio * saturate(away.y / far);
    let long = length(axis);
    return share_at(along * long, long, radius) * saturate((hidden - LEAST_AMBIENT) / (1.0 - LEAST_AMBIENT));
}

// Computes the opacity of the shadow from the point of the limb's axis that is closest to the ray
// from the floor to the light.
@fragment
fn fragment(g: Ground) -> @location(0) vec4f {
    let axis = g.tip.xyz - g.base.xyz;
    let from_base = g.point - g.base.xyz;
    let slant = dot(axis, SHADOW_DIRECTION);
    let across = max(dot(axis, axis) - slant * slant, 1e-6);
    let along = (dot(axis, from_base) - slant * dot(from_base, SHADOW_DIRECTION)) / across;
    let part = saturate(along);
    let away = axis * part - from_base;
    let radius = mix(g.base.w, g.tip.w, part);
    let height = max(dot(away, SHADOW_DIRECTION), 0.0);
    let miss = length(away - SHADOW_DIRECTION * height) - radius;
    let softness = radius * CONTACT + height * LIGHT_WIDTH;
    // A limb much thinner than its soft edge is wide hides only a part of the light.
    let hidden = saturate(THIN * radius / softness);
    let long = sqrt(across);
    let share = share_at(along * long, long, radius + softness);
    let shade = share * hidden * (1.0 - smoothstep(-softness, softness, miss));
    let faded = shade * (1.0 - saturate(height / (view.planes_radius * 1.6)));
    let lit = (1.0 - faded * view.shadow_strength)
        * (1.0 - hidden_ambient(g, axis) * AMBIENT * view.shadow_strength);
    let above = select(0.0, 1.0, view.eye.y > 0.0);
    return vec4f(0.0, 0.0, 0.0, (1.0 - lit) * presence(g.point, FLOOR_RADIUS) * above);
}
