// Which arms of a crowd are seen, and how large: each is put in the list of its level.

@group(1) @binding(3) var<storage, read_write> seen: array<u32>; // a list for each level
@group(1) @binding(4) var<storage, read_write> draws: array<atomic<u32>>; // arguments, four each

// Radii of a limb, in pixels, from which it is drawn round with joints, and round at all.
const LEVELS = vec2f(3.0, 0.7);

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    let number = id.x;
    if number >= crowd.arms {
        return;
    }
    let arm = arm_of(number);
    let least = min(arm.shoulder, min(arm.elbow, arm.hand));
    let most = max(arm.shoulder, max(arm.elbow, arm.hand));
    let middle = (least + most) * 0.5;
    let radius = length(most - middle) + crowd.thick * JOINT;
    for (var side = 0u; side < 5u; side++) {
        let plane = crowd.planes[side];
        if dot(plane.xyz, middle) + plane.w < -radius {
            return;
        }
    }
    let pixels = crowd.thick / pixel_at(middle);
    let level = select(select(2u, 1u, pixels > LEVELS.y), 0u, pixels > LEVELS.x);
    let place = atomicAdd(&draws[level * 4u + 1u], 1u);
    seen[level * crowd.stride + place] = number;
}
