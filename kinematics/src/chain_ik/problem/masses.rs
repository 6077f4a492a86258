use glam::Vec3A;

use super::Link;

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

    /// Adds a bone that is attached to a link or, without one, to the tree, in whose space the
    /// centre is.
    pub fn add(&mut self, link: Option<usize>, mass: f64, centre: Vec3A) {
        let (to_mass, to_moment) = match link.map(|link| &mut self.on_links[link]) {
            Some(on_link) => (&mut on_link.mass, &mut on_link.moment),
            None => (&mut self.fixed_mass, &mut self.fixed),
        };
        *to_mass += mass as f32;
        *to_moment += centre * mass as f32;
    }

    /// Makes fractions of the masses, and sums up what is below each link. Without any mass, the
    /// centre is the tree's origin.
    pub fn sum_up(&mut self, links: &[Link]) {
        let on_links = self.on_links.iter().map(|it| it.mass).sum::<f32>();
        let all = (on_links + self.fixed_mass).max(f32::MIN_POSITIVE);
        self.fixed /= all;
        self.fixed_mass /= all;
        for it in &mut self.on_links {
            it.mass /= all;
            it.moment /= all;
            (it.below, it.longest_arm) = (it.mass, it.moment.length());
        }
        for (index, link) in links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                let MassOnLink { below, longest_arm, .. } = self.on_links[index];
                let parent = &mut self.on_links[parent];
                parent.below += below;
                parent.longest_arm += longest_arm + below * link.pivot.length();
            }
        }
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
