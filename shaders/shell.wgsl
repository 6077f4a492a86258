// Spheres that one can see through, met analytically: a faint fill, and a rim where the surface
// turns away from the eye. Both sides count, so that it is right from inside too.

const FILL_OPACITY = 0.045;
const RIM_OPACITY = 0.5;

// How much one sphere hides of what is at `limit` along the ray.
fn opacity(shell: Shell, ray: Ray, limit: f32) -> f32 {
    let squared = dot(ray.direction, ray.direction);
    let from_centre = ray.origin - shell.centre;
    let middle = -dot(from_centre, ray.direction) / squared;
    let nearest = from_centre + ray.direction * middle;
    let miss = length(nearest);
    let half_chord = sqrt(max(shell.radius * shell.radius - miss * miss, 0.0));
    let half_along = half_chord * inverseSqrt(squared);

    // Half the chord over the radius is the cosine between the normal and the ray, on both sides.
    let turned = 1.0 - half_chord / max(shell.radius, 1e-6);
    let turned_squared = turned * turned;
    let size = pixel_size(middle);
    let edge = saturate(0.5 + (shell.radius - miss) / size) * saturate(shell.radius / size);
    let side = (FILL_OPACITY + RIM_OPACITY * turned_squared * turned_squared * turned) * edge;

    let sides = middle + vec2f(-half_along, half_along);
    let seen = sides > vec2f(nearest_along()) & sides < vec2f(limit);
    let passing = select(vec2f(1.0), vec2f(1.0 - side), seen);
    return 1.0 - passing.x * passing.y;
}

// A colour at `limit` along the ray, with every shell laid over it. By constant index: software
// rasterisers fetch from an array in a loop pixel by pixel.
fn behind_shells(behind: vec3f, ray: Ray, limit: f32) -> vec3f {
    let inner = mix(behind, view.shells[0].colour.rgb, opacity(view.shells[0], ray, limit));
    return mix(inner, view.shells[1].colour.rgb, opacity(view.shells[1], ray, limit));
}
