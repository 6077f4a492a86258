// Culls the arms of a crowd and sorts the visible ones into one list per level of detail.

// One list of arm indices per level of detail.
@group(1) @binding(3) var<storage, read_write> visible: array<u32>;
// Four arguments of an indirect draw per level of detail.
@group(1) @binding(4) var<storage, read_write> draws: array<atomic<u32>>;

// Minimum radii of a limb in pixels at which it is drawn round with joints, round without joints,
// flat, and as a line. A line is one pixel wide.
const LOD_RADII = vec4f(3.0, 1.2, 0.5, 0.1);

@compute @workgroup_size(256)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    if index >= crowd.arms {
        return;
    }
    let arm = arm_at(index);
    let least = min(arm.shoulder, min(arm.elbow, arm.hand));
    let most = max(arm.shoulder, max(arm.elbow, arm.hand));
    let middle = (least + most) * 0.5;
    let radius = length(most - middle) + crowd.base_radius * JOINT_RADIUS;
    for (var side = 0u; side < 5u; side++) {
        let plane = crowd.planes[side];
        if dot(plane.xyz, middle) + plane.w < -radius {
            return;
        }
    }
    let pixels = crowd.base_radius / pixel_at(middle);
    let is_smaller = select(vec4u(0), vec4u(1), vec4f(pixels) <= LOD_RADII);
    let lod = dot(is_smaller, vec4u(1));
    let slot = atomicAdd(&draws[lod * 4u + 1u], 1u);
    visible[lod * crowd.stride + slot] = index;
}
