// Soft shadow of a limb on the ground. The limb is a capsule, and the key light has a width, so
// that the shadow gets softer and fainter with the height of the limb.

const LIGHT_WIDTH = 0.16;
const CONTACT = 0.35; // softness where the limb touches the ground, as a fraction of its radius
const THIN = 8.0; // softness in radii from which a limb is too thin to hide all light

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
    let height = ball.y / KEY_DIRECTION.y;
    let point = ball.xyz - KEY_DIRECTION * height;
    return vec3f(point.xz, (ball.w * (1.0 + CONTACT) + height * LIGHT_WIDTH) / KEY_DIRECTION.y);
}

// Corner of a rectangle on the ground around the shadows of both ends.
@vertex
fn vertex(@builtin(vertex_index) index: u32, i: Instance) -> Ground {
    let from_base = shadow_of(i.base);
    let to_tip = shadow_of(i.tip);
    let long = distance(from_base.xy, to_tip.xy);
    let along = select(vec2f(1.0, 0.0), (to_tip.xy - from_base.xy) / long, long > 0.0);
    let around = max(from_base.z, to_tip.z);
    let aside = vec2f(-along.y, along.x) * (f32(index & 1u) * 2.0 - 1.0) * around;
    let end = select(from_base.xy - along * around, to_tip.xy + along * around, (index & 2u) != 0u);
    let flat = end + aside;
    let point = vec3f(flat.x, 0.0, flat.y);
    return Ground(view.clip_from_world * vec4f(point, 1.0), point, i.base, i.tip);
}

// Computes the opacity of the shadow from the point of the limb's axis that is closest to the ray
// from the ground to the light.
@fragment
fn fragment(g: Ground) -> @location(0) vec4f {
    let axis = g.tip.xyz - g.base.xyz;
    let from_base = g.point - g.base.xyz;
    let slant = dot(axis, KEY_DIRECTION);
    let across = max(dot(axis, axis) - slant * slant, 1e-6);
    let part = saturate((dot(axis, from_base) - slant * dot(from_base, KEY_DIRECTION)) / across);
    let away = axis * part - from_base;
    let radius = mix(g.base.w, g.tip.w, part);
    let height = max(dot(away, KEY_DIRECTION), 0.0);
    let miss = length(away - KEY_DIRECTION * height) - radius;
    let softness = radius * CONTACT + height * LIGHT_WIDTH;
    // A limb much thinner than its soft edge is wide hides only a part of the light.
    let hidden = saturate(THIN * radius / softness);
    let shade = hidden * (1.0 - smoothstep(-softness, softness, miss));
    let faded = shade * (1.0 - saturate(height / (view.planes_radius * 1.6)));
    let above = select(0.0, 1.0, view.eye.y > 0.0);
    return vec4f(0.0, 0.0, 0.0, faded * view.shadow_strength * presence(g.point, FLOOR_RADIUS) * above);
}
