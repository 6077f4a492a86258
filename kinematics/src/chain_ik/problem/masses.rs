use glam::{DVec3, Vec3A};

use crate::skeleton::{JointId, Skeleton, bone_masses};

/// The mass of a limb whose tip a later step holds in place while the body moves the limb's base.
///
/// Each bone then moves less than the base, the less the nearer it is to the tip: one whose centre is
/// at the fraction α of the way from base to tip moves by 1 − α of it, and does not turn with the
/// body. So the part 1 − α of its mass is at the base, and the rest stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldLimb {
    /// The joint at the base.
    pub upper: JointId,
    /// Mass that moves with the base, in the unit of [`bone_masses`].
    pub with_base: f64,
    /// Mass that stays.
    pub held: f64,
    /// Moment of the limb about the origin of skeleton space, less that of the mass at the base.
    pub moment: DVec3,
}

impl HeldLimb {
    /// The limb of a posed skeleton from an upper joint down, whose tip is that of the joint `lower`;
    /// `None` for a limb that moves with the body as a whole.
    pub fn new(posed: &Skeleton, upper: JointId, lower: Option<JointId>) -> Self {
        let pose = posed.pose_in_skeleton();
        let base = pose.base(upper).as_dvec3();
        let way = lower.map(|lower| pose.tip(lower).as_dvec3() - base);
        let mut limb = Self { upper, with_base: 0.0, held: 0.0, moment: DVec3::ZERO };
        for ((id, _), (mass, centre)) in posed.iter().zip(bone_masses(posed)) {
            if !posed.ancestors(id).any(|above| above == upper) {
                continue;
            }
            let centre = pose.full(id).transform_point3(centre.as_vec3()).as_dvec3();
            let along = way.map_or(0.0, |way| (centre - base).dot(way) / way.length_squared());
            let fraction = if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 };
            limb.with_base += mass * (1.0 - fraction);
            limb.held += mass * fraction;
            limb.moment += mass * centre - mass * (1.0 - fraction) * base;
        }
        limb
    }
}

/// What the centre of mass depends on: the masses on each link, as fractions of the whole.
///
/// A link with base b turns the bones at it and below, with the mass μ and the moment S = Σ m c of
/// their centres, about b. That turns the whole centre of mass about the point that is S − μ b away
/// from it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Masses {
    /// Index of the end effector that is the centre of mass.
    pub effector: usize,
    /// On each link.
    pub on_links: Vec<MassOnLink>,
    /// Moment of what no link moves, relative to the tree's origin.
    pub fixed: Vec3A,
    /// Mass of what no link moves.
    pub fixed_mass: f32,
    /// Mass that stays in place also if the root moves, and its moment in skeleton space.
    held_mass: f64,
    held: DVec3,
}

/// The bones that are rigidly attached to a link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MassOnLink {
    pub mass: f32,
    /// Σ m c with the centres c in the link's space.
    pub moment: Vec3A,
    /// Mass of the bones at the link and below, μ.
    pub below: f32,
    /// A bound of the length of S − μ b in any pose.
    longest_arm: f32,
}

impl Masses {
    pub fn new(effector: usize, links: usize) -> Self {
        Self { effector, on_links: vec![MassOnLink::default(); links], ..Self::default() }
    }

    /// Adds a mass that is attached to a link or, without one, to the tree, in whose space the
    /// centre is.
    pub fn add(&mut self, link: Option<usize>, mass: f64, centre: Vec3A) {
        let (to_mass, to_moment) = match link.map(|link| &mut self.on_links[link]) {
            Some(on_link) => (&mut on_link.mass, &mut on_link.moment),
            None => (&mut self.fixed_mass, &mut self.fixed),
        };
        *to_mass += mass as f32;
        *to_moment += centre * mass as f32;
    }

    /// Adds a mass that stays in place, and its moment in skeleton space.
    pub fn hold(&mut self, mass: f64, moment: DVec3) {
        self.held_mass += mass;
        self.held += moment;
    }

    /// Makes fractions of the masses, and sums up what is below each link. `parents` has the parent of
    /// each link and the distance of its base from the parent's. Without any mass, the centre is the
    /// tree's origin.
    pub fn sum_up(&mut self, parents: &[(Option<usize>, f32)]) {
        let on_links = self.on_links.iter().map(|it| it.mass).sum::<f32>();
        let all = on_links + self.fixed_mass + self.held_mass as f32;
        let all = all.max(f32::MIN_POSITIVE);
        self.fixed /= all;
        self.fixed_mass /= all;
        self.held /= f64::from(all);
        self.held_mass /= f64::from(all);
        for it in &mut self.on_links {
            it.mass /= all;
            it.moment /= all;
            (it.below, it.longest_arm) = (it.mass, it.moment.length());
        }
        for (index, (parent, pivot)) in parents.iter().enumerate().rev() {
            if let Some(parent) = *parent {
                let MassOnLink { below, longest_arm, .. } = self.on_links[index];
                let parent = &mut self.on_links[parent];
                parent.below += below;
                parent.longest_arm += longest_arm + below * pivot;
            }
        }
    }

    /// The moment of what stays in place, relative to an origin in skeleton space and in the problem's
    /// units, of which `unit` are a skeleton unit.
    pub fn held_from(&self, origin: DVec3, unit: f64) -> Vec3A {
        ((self.held - self.held_mass * origin) * unit).as_vec3a()
    }

    /// The part of a shift of the root by which the centre of mass moves.
    pub fn part_of_shift(&self) -> f32 {
        (1.0 - self.held_mass) as f32
    }

    pub fn is_moved_by(&self, link: usize) -> bool {
        self.on_links[link].below > 0.0
    }

    /// A bound of the length of a link's arm to an end effector; `None` if it is another than the
    /// centre of mass.
    pub fn longest_arm(&self, effector: usize, link: usize) -> Option<f32> {
        (effector == self.effector).then(|| self.on_links[link].longest_arm)
    }
}
