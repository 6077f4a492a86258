// A see-through sphere, drawn as a square that covers it and intersected analytically with the ray
// of each pixel. Also correct from inside, where the near side is behind the eye.

// Clip position of a corner of a square that faces the eye and covers the sphere, or the whole
// picture if the eye is inside the sphere. The fragment shader sets the depth.
fn covering(index: u32, centre: vec3f, radius: f32) -> vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let to_centre = centre - view.eye;
    let away = length(to_centre);
    let parallel = view.orthographic > 0.5;
    if !parallel && away < radius * 1.05 {
        return vec4f(corner, 0.5, 1.0);
    }
    let facing = select(to_centre / away, view.forward, parallel);
    let beside = dot(facing, view.right);
    let helper = select(view.right, view.forward, beside * beside > 0.5 * dot(view.right, view.right));
    let across = normalize(cross(helper, facing));
    let upwards = cross(facing, across);
    let tangent = sqrt(away * away - radius * radius) / away;
    let seen_radius = radius / select(tangent, 1.0, parallel);
    let extent = seen_radius + 2.0 * pixel_size(dot(to_centre, view.forward));
    let world = centre + (across * corner.x + upwards * corner.y) * extent;
    let clip = view.clip_from_world * vec4f(world, 1.0);
    return vec4f(clip.xy, 0.5 * clip.w, clip.w);
}

struct Met {
    point: vec3f,
    cover: f32, // fraction of the pixel that is covered; 0 behind the eye
    grazing: f32, // 0 if the ray is perpendicular to the surface, 1 at the rim
}

// Intersection of a ray with the near (`side` = -1) or the far side (`side` = 1) of a sphere.
fn meet(ray: Ray, centre: vec3f, radius: f32, side: f32) -> Met {
    let squared = dot(ray.direction, ray.direction);
    let from_centre = ray.origin - centre;
    let middle = -dot(from_centre, ray.direction) / squared;
    let miss = length(from_centre + ray.direction * middle);
    let half_chord = sqrt(max(radius * radius - miss * miss, 0.0));
    let along = middle + half_chord * inverseSqrt(squared) * side;
    let size = pixel_size(middle);
    let edge = saturate(0.5 + (radius - miss) / size) * saturate(radius / size);
    // The ratio of half the chord to the radius is the cosine of the angle between the normal and
    // the ray, on both sides.
    return Met(
        ray.origin + ray.direction * along,
        edge * select(0.0, 1.0, along > nearest_along()),
        1.0 - half_chord / radius,
    );
}

// Opacity of the rim, relative to its maximum.
fn rim(grazing: f32) -> f32 {
    let squared = grazing * grazing;
    return squared * squared * grazing;
}

// Clip depth of a point, kept above 0, which is the depth of the sky.
fn depth_of(point: vec3f) -> f32 {
    let clip = view.clip_from_world * vec4f(point, 1.0);
    return max(clip.z / clip.w, 1e-37);
}
