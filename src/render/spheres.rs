use core::cmp::Ordering;
use core::ops::Range;

use super::Gpu;
use super::globe::Globes;
use super::shell::{Shells, SphereSide};
use crate::document::Projection;
use crate::scene::{Colour, Globe, Scene, SphereShell};

/// Draws the see-through spheres, which are the shells and the globe, from back to front over
/// everything opaque.
#[derive(Debug)]
pub(super) struct Spheres {
    shells: Shells,
    globe: Globes,
    order: SphereOrder,
    /// Shells that can be drawn, then the globe if there is one.
    spheres: Vec<SphereShell>,
    /// Numbers of shell sides that are drawn before the globe's far side and before its near side.
    behind_globe: [u32; 2],
}

impl Spheres {
    pub fn new(gpu: &Gpu, view: &wgpu::BindGroupLayout) -> Self {
        Self {
            shells: Shells::new(gpu, view),
            globe: Globes::new(gpu, view),
            order: SphereOrder::default(),
            spheres: Vec::new(),
            behind_globe: [0; 2],
        }
    }

    /// Sends the changes to the device and returns the number of bytes sent. `size` is the
    /// picture's in pixels.
    pub fn upload(&mut self, gpu: &Gpu, scene: &Scene, size: (u32, u32)) -> u64 {
        let projection = scene.camera.projection(size.0 as f32 / size.1 as f32);
        self.spheres.clear();
        self.spheres.extend(scene.shells.iter().filter(|shell| has_size(shell)));
        let shells = self.spheres.len();
        self.spheres.extend(scene.globe.filter(Globe::has_size).map(of_globe));
        let surfaces = self.order.sort(&projection, &self.spheres);
        let is_shell = |surface: &&SphereSurface| surface.sphere < shells;
        self.behind_globe = [SphereSide::Far, SphereSide::Near].map(|side| {
            let behind = surfaces.iter().take_while(|it| is_shell(it) || it.side != side);
            behind.filter(is_shell).count() as u32
        });
        let sides = surfaces.iter().filter(is_shell);
        let sides = sides.map(|surface| (&self.spheres[surface.sphere], surface.side));
        self.shells.upload(gpu, sides) + self.globe.upload(gpu, scene)
    }

    pub fn triangles(&self) -> u32 {
        self.shells.triangles() + self.globe.triangles()
    }

    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let [far, near] = self.behind_globe;
        self.shells.draw(pass, 0..far);
        self.globe.draw(pass, SphereSide::Far);
        self.shells.draw(pass, far..near);
        self.globe.draw(pass, SphereSide::Near);
        self.shells.draw(pass, near..u32::MAX);
    }
}

/// True if a shell can be drawn: its centre and squared radius are finite, and the radius is above
/// 0.
fn has_size(shell: &SphereShell) -> bool {
    let radius = shell.radius;
    shell.centre.is_finite() && radius > 0.0 && (radius * radius).is_finite()
}

fn of_globe(globe: Globe) -> SphereShell {
    SphereShell { centre: globe.centre, radius: globe.radius, colour: Colour([0; 4]) }
}

/// One side of a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SphereSurface {
    /// Index of the sphere.
    sphere: usize,
    side: SphereSide,
}

/// Sorts the sides of spheres from back to front, independently of the order in which the spheres
/// are listed.
///
/// The result is exact if no two spheres intersect. Spheres inside a sphere come between its far
/// and its near side. Disjoint spheres are sorted by the length of their tangents from the eye: the
/// points with tangents of equal length to both spheres form a plane that separates them, and a ray
/// from the eye crosses that plane at most once. Intersecting spheres are sorted by tangent length
/// too, although no order of whole sides is right for them.
#[derive(Debug, Default)]
struct SphereOrder {
    surfaces: Vec<SphereSurface>,
    /// Indices of the spheres, the largest first.
    by_size: Vec<usize>,
}

impl SphereOrder {
    /// Sorts the sides. Allocates only if there are more spheres than in all previous calls.
    fn sort(&mut self, projection: &Projection, spheres: &[SphereShell]) -> &[SphereSurface] {
        self.surfaces.clear();
        self.by_size.clear();
        self.by_size.extend(0..spheres.len());
        self.by_size.sort_unstable_by(|a, b| by_size(&spheres[*a], &spheres[*b]));
        for sphere in self.by_size.iter().copied() {
            let at = self.index_of(projection, spheres, sphere);
            let sides =
                [SphereSide::Far, SphereSide::Near].map(|side| SphereSurface { sphere, side });
            self.surfaces.splice(at..at, sides);
        }
        &self.surfaces
    }

    /// Index in the list at which to insert the sides of `sphere`: that of the first surface in
    /// front of the sphere. All spheres in the list must be at least as large as `sphere`.
    fn index_of(&self, projection: &Projection, spheres: &[SphereShell], sphere: usize) -> usize {
        let inner = &spheres[sphere];
        let mut inside = 0..self.surfaces.len();
        while let Some((_, sides)) =
            self.outermost(inside.clone()).find(|(outer, _)| contains(&spheres[*outer], inner))
        {
            inside = sides.start + 1..sides.end;
        }
        let own = distance(inner, projection);
        self.outermost(inside.clone())
            .find(|(other, _)| distance(&spheres[*other], projection) < own)
            .map_or(inside.end, |(_, sides)| sides.start)
    }

    /// Spheres that have their sides in a range of the list and are inside no other sphere of the
    /// range, from back to front. Each comes with the indices of its far and near sides.
    fn outermost(&self, range: Range<usize>) -> impl Iterator<Item = (usize, Range<usize>)> {
        let mut start = range.start;
        core::iter::from_fn(move || {
            let rest = self.surfaces.get(start..range.end)?;
            let sphere = rest.first()?.sphere;
            let sides = start..start + rest.iter().rposition(|other| other.sphere == sphere)?;
            start = sides.end + 1;
            Some((sphere, sides))
        })
    }
}

/// Orders spheres by radius, the largest first, then by centre and colour.
fn by_size(a: &SphereShell, b: &SphereShell) -> Ordering {
    let key = |sphere: &SphereShell| {
        let [x, y, z] = sphere.centre.to_array();
        let [red, green, blue, opacity] = sphere.colour.channels();
        [sphere.radius, x, y, z, red, green, blue, opacity]
    };
    let pairs = key(b).into_iter().zip(key(a));
    pairs.map(|(b, a)| b.total_cmp(&a)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

fn contains(outer: &SphereShell, inner: &SphereShell) -> bool {
    let apart = outer.centre.as_dvec3().distance(inner.centre.as_dvec3());
    apart <= f64::from(outer.radius) - f64::from(inner.radius)
}

/// Squared length of the tangent from the eye to a sphere; negative if the eye is inside. In an
/// orthographic view it is replaced by the depth of the centre, which has the same order as the
/// tangents from an eye that is infinitely far away.
fn distance(sphere: &SphereShell, projection: &Projection) -> f64 {
    let from_eye = sphere.centre.as_dvec3() - projection.eye.as_dvec3();
    if projection.orthographic {
        return from_eye.dot(projection.forward.as_dvec3());
    }
    from_eye.length_squared() - f64::from(sphere.radius).powi(2)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec2, Vec3};

    use crate::document::Camera;
    use crate::render::spheres::*;
    use crate::scene::Colour;

    fn shell(centre: [f32; 3], radius: f32) -> SphereShell {
        SphereShell { centre: centre.into(), radius, colour: Colour([255; 4]) }
    }

    /// Disjoint, nested, doubly nested, touching and equal spheres.
    fn shells() -> Vec<SphereShell> {
        let mut shells = vec![
            shell([0.0, 0.0, 0.0], 100.0),
            shell([0.0, 0.0, 0.0], 40.0),
            shell([0.0, 0.0, 90.0], 10.0),
            shell([10.0, 5.0, 0.0], 12.0),
            shell([130.0, 0.0, 20.0], 30.0),
            shell([130.0, 0.0, 20.0], 30.0),
            shell([125.0, 10.0, 25.0], 6.0),
            shell([0.0, 0.0, -250.0], 149.0),
            shell([30.0, 20.0, -330.0], 20.0),
            shell([-90.0, 90.0, 60.0], 25.0),
        ];
        shells[5].colour = Colour([9, 9, 9, 255]);
        shells
    }

    fn cameras() -> Vec<Camera> {
        let mut cameras = Vec::new();
        for step in 0_u8..24 {
            let (yaw, pitch) = (f32::from(step) * 0.9, f32::from(step % 5) * 0.5 - 1.0);
            for (target, distance) in
                [(Vec3::ZERO, 900.0), (Vec3::new(20.0, 0.0, -30.0), 45.0), (Vec3::X * 90.0, 160.0)]
            {
                for orthographic in [false, true] {
                    cameras.push(Camera { target, yaw, pitch, distance, orthographic });
                }
            }
        }
        cameras
    }

    /// Intersections of a ray with the sides of the spheres, with distances along the ray.
    fn met(projection: &Projection, at: Vec2, shells: &[SphereShell]) -> Vec<(SphereSurface, f64)> {
        let ray = projection.ray(at);
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize());
        let sides = |(sphere, shell): (usize, &SphereShell)| {
            let from_centre: DVec3 = origin - shell.centre.as_dvec3();
            let middle = -from_centre.dot(direction);
            let miss = (from_centre + direction * middle).length_squared();
            let half = (f64::from(shell.radius).powi(2) - miss).sqrt();
            [(SphereSide::Near, middle - half), (SphereSide::Far, middle + half)]
                .map(|(side, along)| (SphereSurface { sphere, side }, along))
        };
        let all = shells.iter().enumerate().flat_map(sides);
        all.filter(|(_, along)| *along > 0.0 || projection.orthographic && along.is_finite())
            .collect()
    }

    #[test]
    fn every_ray_meets_the_sides_from_front_to_back() {
        let (shells, mut order) = (shells(), SphereOrder::default());
        let mut compared = 0;
        for camera in cameras() {
            let projection = camera.projection(1.5);
            let sorted = order.sort(&projection, &shells);
            assert_eq!(sorted.len(), 2 * shells.len());
            let place = |surface| sorted.iter().position(|other| *other == surface);
            for step in 0_u16..400 {
                let (across, up) = (f32::from(step % 20), f32::from(step / 20));
                let mut met = met(&projection, Vec2::new(across, up) / 10.0 - 0.95, &shells);
                met.sort_by(|a, b| b.1.total_cmp(&a.1));
                for pair in met.windows(2).filter(|pair| pair[0].1 - pair[1].1 > 1e-6) {
                    let [back, front] = [pair[0].0, pair[1].0].map(place);
                    assert!(back < front, "{camera:?} {across} {up}: {pair:?}");
                    compared += 1;
                }
            }
        }
        assert!(compared > 50_000, "{compared}");
    }

    #[test]
    fn the_order_does_not_depend_on_the_list() {
        let (mut shells, mut order) = (shells(), SphereOrder::default());
        shells.push(shell([95.0, 30.0, 0.0], 50.0)); // intersects others
        for camera in cameras() {
            let projection = camera.projection(1.5);
            let sorted = |shells: &[SphereShell], order: &mut SphereOrder| -> Vec<_> {
                let surfaces = order.sort(&projection, shells).iter();
                surfaces.map(|surface| (shells[surface.sphere], surface.side)).collect()
            };
            let expected = sorted(&shells, &mut order);
            let mut other = shells.clone();
            for turn in 0..other.len() {
                other.rotate_left(1);
                other.swap(turn, 0);
                assert_eq!(sorted(&other, &mut order), expected);
            }
        }
    }
}
