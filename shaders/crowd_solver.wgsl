// Two-bone solver for every arm of a crowd, with the formulas of `kinematics::two_bone`. The sine
// and cosine of the twist are inputs, since a GPU computes them inexactly.

struct Crowd {
    arms: u32,
    stride: u32, // distance between arrays, in floats
    upper: f32,
    lower: f32,
}

@group(0) @binding(0) var<uniform> crowd: Crowd;
// Arrays of Cursor x, y and z, cosine and sine of the twist.
@group(0) @binding(1) var<storage, read> targets: array<f32>;
// Arrays of elbow x, y and z, hand x, y and z.
@group(0) @binding(2) var<storage, read_write> poses: array<f32>;

// The power of two at or below a positive number, and the reciprocal of that power. Scaling by
// either is exact.
fn power_of_two_near(value: f32) -> vec2f {
    let power = clamp(bitcast<u32>(value) & 0x7f800000u, 0x00800000u, 0x7e800000u);
    return vec2f(bitcast<f32>(power), bitcast<f32>(0x7f000000u - power));
}

// The vector scaled to length 1; `fallback` if its length is 0.
fn normalize_or(v: vec3f, fallback: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    let scaled = v * power_of_two_near(largest).y;
    return select(scaled / length(scaled), fallback, largest == 0.0);
}

fn store(at: u32, v: vec3f) {
    poses[at] = v.x;
    poses[at + crowd.stride] = v.y;
    poses[at + 2u * crowd.stride] = v.z;
}

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    let arm = id.x;
    if arm >= crowd.arms {
        return;
    }
    let n = crowd.stride;
    let cursor = vec3f(targets[arm], targets[n + arm], targets[2u * n + arm]);
    let cos = targets[3u * n + arm];
    let sin = targets[4u * n + arm];

    // Lengths are scaled so that the longer bone is about 1 long, which avoids overflow and
    // underflow.
    let unit = power_of_two_near(max(crowd.upper, crowd.lower));
    let upper = crowd.upper * unit.y;
    let lower = crowd.lower * unit.y;
    let sum = upper + lower;
    let difference = upper - lower;

    let pointer = normalize_or(cursor, vec3f(1.0, 0.0, 0.0));
    let heading = normalize_or(vec3f(cursor.x, 0.0, cursor.z), vec3f(1.0, 0.0, 0.0));
    let near = cursor * unit.y;
    let far = length(near);
    let distance = clamp(far, abs(difference), sum);

    // Heron's formula, factored to avoid cancellation.
    let along = 0.5 * (distance + sum * (difference / distance));
    let squared = (sum + distance) * (sum - distance)
        * ((distance + difference) / distance) * ((distance - difference) / distance);
    var elbow = vec2f(clamp(along, -upper, upper), 0.5 * sqrt(max(squared, 0.0)));
    if distance < 1e-30 {
        elbow = vec2f(0.0, upper);
    }

    // The Limb's +y and +z, rotated by the twist.
    let level = dot(pointer.xz, heading.xz);
    let up = vec3f(-pointer.y * heading.x, level, -pointer.y * heading.z);
    let aside = vec3f(-heading.z, 0.0, heading.x);
    let outward = up * cos + aside * sin;
    store(arm, (pointer * elbow.x + outward * elbow.y) * unit.x);

    let is_reached = far >= abs(difference) && far <= sum;
    store(arm + 3u * n, select(pointer * distance * unit.x, cursor, is_reached));
}
