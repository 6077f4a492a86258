// Two bones in closed form, for every arm of a crowd: the mathematics of `kinematics::two_bone`. The
// sine and cosine of the spin come from outside, since a device's own are not exact.

struct Asked {
    arms: u32,
    stride: u32, // from one kind of number to the next
    upper: f32,
    lower: f32,
}

@group(0) @binding(0) var<uniform> ask: Asked;
@group(0) @binding(1) var<storage, read> asked: array<f32>; // cursor x, y, z, cosine, sine
@group(0) @binding(2) var<storage, read_write> posed: array<f32>; // elbow x, y, z, hand x, y, z

// The power of two at or below a number, and its reciprocal: to scale by them is exact.
fn power_of_two_near(value: f32) -> vec2f {
    let power = clamp(bitcast<u32>(value) & 0x7f800000u, 0x00800000u, 0x7e800000u);
    return vec2f(bitcast<f32>(power), bitcast<f32>(0x7f000000u - power));
}

// A vector of unit length; the other where it has none.
fn direction(v: vec3f, otherwise: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    let scaled = v * power_of_two_near(largest).y;
    return select(scaled / length(scaled), otherwise, largest == 0.0);
}

fn put(at: u32, v: vec3f) {
    posed[at] = v.x;
    posed[at + ask.stride] = v.y;
    posed[at + 2u * ask.stride] = v.z;
}

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    let arm = id.x;
    if arm >= ask.arms {
        return;
    }
    let n = ask.stride;
    let cursor = vec3f(asked[arm], asked[n + arm], asked[2u * n + arm]);
    let cos = asked[3u * n + arm];
    let sin = asked[4u * n + arm];

    // Bones near 1 long, so that nothing overflows or vanishes.
    let unit = power_of_two_near(max(ask.upper, ask.lower));
    let upper = ask.upper * unit.y;
    let lower = ask.lower * unit.y;
    let sum = upper + lower;
    let difference = upper - lower;

    let pointer = direction(cursor, vec3f(1.0, 0.0, 0.0));
    let heading = direction(vec3f(cursor.x, 0.0, cursor.z), vec3f(1.0, 0.0, 0.0));
    let near = cursor * unit.y;
    let far = length(near);
    let distance = clamp(far, abs(difference), sum);

    // Heron's formula, factored so that nothing cancels.
    let along = 0.5 * (distance + sum * (difference / distance));
    let squared = (sum + distance) * (sum - distance)
        * ((distance + difference) / distance) * ((distance - difference) / distance);
    var elbow = vec2f(clamp(along, -upper, upper), 0.5 * sqrt(max(squared, 0.0)));
    if distance < 1e-30 {
        elbow = vec2f(0.0, upper);
    }

    // The Limb's +y and +z, spun.
    let level = dot(pointer.xz, heading.xz);
    let up = vec3f(-pointer.y * heading.x, level, -pointer.y * heading.z);
    let aside = vec3f(-heading.z, 0.0, heading.x);
    let outward = up * cos + aside * sin;
    put(arm, (pointer * elbow.x + outward * elbow.y) * unit.x);

    let is_reached = far >= abs(difference) && far <= sum;
    put(arm + 3u * n, select(pointer * distance * unit.x, cursor, is_reached));
}
