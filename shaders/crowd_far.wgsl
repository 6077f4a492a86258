// Far arms of a crowd: each limb is a line (vertices 0 to 3) or a point (vertices 4 and 5). An arm is
// so small that its colour is computed once for each vertex.

struct Spot {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) colour: vec3f,
}

// Size of a pixel on the plane through the origin with this normal, along each axis of the world,
// in cells: what `pixel_in_cells` is in a fragment shader.
fn pixel_on(ray: Ray, normal: vec3f) -> vec3f {
    let per_depth = ray.direction / dot(ray.direction, normal);
    let hit = ray.origin - per_depth * dot(ray.origin, normal);
    let right = normalize(view.right);
    let up = normalize(view.up);
    let across = abs(right - per_depth * dot(right, normal));
    let along = abs(up - per_depth * dot(up, normal));
    return max((across + along) * pixel_at(hit) / view.cell, vec3f(1e-6));
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Spot {
    let arm = arm_at(visible[lod.first + instance]);
    let is_lower = index == 2u || index == 3u || index == 5u;
    let base = select(arm.shoulder, arm.elbow, is_lower);
    let tip = select(arm.elbow, arm.hand, is_lower);
    let part = select(select(0.0, 1.0, index == 1u || index == 3u), 0.5, index > 3u);
    let place = mix(base, tip, part);

    let axis = unit(tip - base, vec3f(0.0, 1.0, 0.0));
    let towards = to_eye(place);
    let normal = unit(towards - axis * dot(axis, towards), -crowd.forward);
    let colour = lit(select(crowd.upper.rgb, crowd.lower.rgb, is_lower), normal);
    let clip = view.clip_from_world * vec4f(place, 1.0);
    let position = (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * view.size;
    let ray = pixel_ray(position);
    let along = dot(place - ray.origin, ray.direction) / dot(ray.direction, ray.direction);
    let pixels = array(
        pixel_on(ray, vec3f(1.0, 0.0, 0.0)).zy,
        pixel_on(ray, vec3f(0.0, 1.0, 0.0)).xz,
        pixel_on(ray, vec3f(0.0, 0.0, 1.0)).xy,
    );
    return Spot(clip, behind_planes_of(fogged(colour, position, along), ray, along, pixels));
}

@fragment
fn fragment(s: Spot) -> @location(0) vec4f {
    return vec4f(s.colour, 1.0);
}
