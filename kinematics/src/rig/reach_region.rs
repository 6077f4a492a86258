//! Where a target can be: the region of all places at which it is reached.
//!
//! The places are the centres of the cells of a grid. A place is tried from the pose of a neighbour
//! that is reached, as a drag of the target would come there, and then with a solve by itself. Random
//! poses would be no way to find the region: 50,000 of a free chain of ten joints fill only 59 % of
//! the ball that it reaches.
//!
//! A first, coarse grid over all that the bones could reach finds the box of the region; the second
//! one has 24 cells along the longest side of that box.

use std::collections::VecDeque;

use glam::{DVec3, IVec3, Vec3};

use super::carried::Carried;
use super::evaluate::EvaluatedSkeleton;
use super::reach_grid::{Cell, Lattice, surface};
use super::skeleton_rig::SkeletonRig;
use crate::chain_ik::{Method, Root};
use crate::limb_ik::LimbRange;
use crate::skin::TriangleMesh;

/// The places at which a target of a rig is reached, while the other targets that are reached and
/// the balance stay so, and while nothing but this target moves. The solver is damped least squares, whatever the
/// method of the rig is; stiffness makes no difference.
#[derive(Clone, Debug, PartialEq)]
pub struct ReachRegion {
    lattice: Lattice,
    cells: Vec<Cell>,
    surface: TriangleMesh,
}

impl ReachRegion {
    /// The region of the target with an index, at a time in seconds. `None` if nothing holds a body
    /// whose root is free, so that the target is reached everywhere, and if coordinates are out of
    /// the range of numbers.
    ///
    /// # Panics
    ///
    /// If there is no target with the index.
    pub fn of(rig: &SkeletonRig, index: usize, time: f64) -> Option<Self> {
        let mut search = ReachSearch::new(rig, index, time)?;
        while search.advance() {}
        search.finish()
    }

    /// True if the target is reached at a place in the world: that of the nearest cell's centre.
    pub fn contains(&self, place: Vec3) -> bool {
        let nearest = self.lattice.index(self.lattice.nearest(place.as_dvec3()));
        nearest.is_some_and(|index| self.cells[index].is_reached)
    }

    /// Width of a cell in the world, the error of the region's surface.
    pub fn cell(&self) -> f32 {
        self.lattice.width as f32
    }

    /// Centres of the cells that are reached, in the world.
    pub fn places(&self) -> impl Iterator<Item = Vec3> {
        let reached = self.cells.iter().enumerate().filter(|(_, cell)| cell.is_reached);
        reached.map(|(index, _)| self.lattice.centre(self.lattice.at(index)).as_vec3())
    }

    /// The surface of the region, in the world; its triangles are counter-clockwise seen from
    /// outside.
    pub fn surface(&self) -> &TriangleMesh {
        &self.surface
    }
}

/// A search for a [`ReachRegion`], one place after the other.
#[derive(Clone, Debug)]
pub struct ReachSearch {
    /// The rig, whose target is moved from place to place.
    rig: SkeletonRig,
    index: usize,
    time: f64,
    /// Indices of the other targets that must stay reached.
    held: Vec<usize>,
    /// True if the balance must be kept.
    is_balanced: bool,
    /// The pose and the state at the target's own place.
    start: (EvaluatedSkeleton, Carried),
    grid: SearchedGrid,
    is_fine: bool,
}

/// A grid with places whose neighbours are not tried yet.
#[derive(Clone, Debug)]
struct SearchedGrid {
    lattice: Lattice,
    cells: Vec<Cell>,
    /// Places that are reached, with the state there.
    open: VecDeque<(IVec3, Carried)>,
    /// Index of the next place for a try by itself.
    next: usize,
    /// True if all places on even coordinates have had a try by itself.
    has_tried_all: bool,
}

/// Cells along the longest side of the grids.
const COARSE: i32 = 16;
const FINE: i32 = 24;
/// Neighbours from which a place is tried.
const TRIES: u8 = 2;

impl ReachSearch {
    /// Begins a search; `None` as for [`ReachRegion::of`].
    ///
    /// # Panics
    ///
    /// If there is no target with the index.
    pub fn new(rig: &SkeletonRig, index: usize, time: f64) -> Option<Self> {
        let mut rig = rig.clone();
        rig.solver.method = Method::DampedLeastSquares;
        for joint in rig.skeleton.ids().collect::<Vec<_>>() {
            rig.skeleton_mut().write_local(joint, |joint| joint.stiffness = Vec3::ZERO);
        }
        let target = &mut rig.targets[index];
        (target.enabled, target.influence) = (true, 1.0);
        let start = rig.step(time, &Carried::default());
        let others = (0..rig.targets.len()).filter(|other| *other != index);
        let is_held = |other: &usize| {
            rig.targets[*other].is_posing() && rig.is_reached(&start.0.targets[*other])
        };
        let held = others.filter(is_held).collect();
        let is_balanced = rig.is_balanced(&start.0);
        let bounds = rig.most_reached(index, &start.0)?;
        let grid = SearchedGrid::new(Lattice::over(bounds, COARSE));
        let is_fine = false;
        let mut search = Self { rig, index, time, held, is_balanced, start, grid, is_fine };
        search.seed();
        Some(search)
    }

    /// Tries one more place. Returns false if all is known.
    pub fn advance(&mut self) -> bool {
        if let Some((at, state)) = self.grid.open.pop_front() {
            for way in [IVec3::X, IVec3::NEG_X, IVec3::Y, IVec3::NEG_Y, IVec3::Z, IVec3::NEG_Z] {
                let next = at + way;
                let Some(cell) = self.grid.lattice.index(next) else { continue };
                let known = &mut self.grid.cells[cell];
                if !known.is_reached && known.tries < TRIES {
                    known.tries += 1;
                    self.try_place(next, &state);
                }
            }
            return true;
        }
        if let Some(at) = self.grid.next_fresh() {
            self.try_place(at, &Carried::default());
            return true;
        }
        if self.is_fine {
            return false;
        }
        self.is_fine = true;
        let Some(bounds) = self.grid.bounds() else { return false };
        self.grid = SearchedGrid::new(Lattice::over(bounds, FINE));
        self.seed();
        true
    }

    /// Fraction of the places that are known, from 0 to 1.
    pub fn progress(&self) -> f32 {
        let SearchedGrid { cells, next, .. } = &self.grid;
        let part = *next as f32 / cells.len().max(1) as f32;
        if self.is_fine { 0.3 + 0.7 * part } else { 0.3 * part }
    }

    /// The region as far as it is known; `None` if no place is reached.
    pub fn finish(self) -> Option<ReachRegion> {
        let SearchedGrid { lattice, cells, .. } = self.grid;
        let is_any = self.is_fine && cells.iter().any(|cell| cell.is_reached);
        is_any.then(|| ReachRegion { lattice, surface: surface(&lattice, &cells), cells })
    }

    /// Tries the place that is nearest to the target's own one.
    fn seed(&mut self) {
        let tip = self.start.0.solved.tip(self.rig.targets[self.index].joint);
        let at = self.grid.lattice.nearest(tip.as_dvec3());
        let state = self.start.1.clone();
        if self.grid.lattice.index(at).is_some() {
            self.try_place(at, &state);
        }
    }

    /// Tries a place from a state.
    fn try_place(&mut self, at: IVec3, from: &Carried) {
        let place = self.grid.lattice.centre(at).as_vec3();
        let target = self.rig.targets[self.index];
        self.rig.targets[self.index] = target.placed(&self.start.0.solved, self.time, place);
        let (evaluated, state) = self.rig.step(self.time, from);
        let is_reached = |index: &usize| self.rig.is_reached(&evaluated.targets[*index]);
        let is_kept = !self.is_balanced || self.rig.is_balanced(&evaluated);
        let is_found = is_reached(&self.index) && self.held.iter().all(is_reached) && is_kept;
        let Some(index) = self.grid.lattice.index(at) else { return };
        let cell = &mut self.grid.cells[index];
        cell.miss = cell.miss.min(evaluated.targets[self.index].error);
        if is_found {
            cell.is_reached = true;
            self.grid.open.push_back((at, state));
        }
    }
}

impl SearchedGrid {
    fn new(lattice: Lattice) -> Self {
        let cells = vec![Cell::UNKNOWN; lattice.len()];
        Self { lattice, cells, open: VecDeque::new(), next: 0, has_tried_all: false }
    }

    /// The next place for a try by itself: first those on even coordinates, which find pieces of the
    /// region that are apart, then those beside places that are reached.
    fn next_fresh(&mut self) -> Option<IVec3> {
        loop {
            if self.next == self.cells.len() {
                if self.has_tried_all {
                    return None;
                }
                (self.has_tried_all, self.next) = (true, 0);
            }
            let (index, at) = (self.next, self.lattice.at(self.next));
            self.next += 1;
            let is_wanted = match self.has_tried_all {
                false => at % 2 == IVec3::ZERO,
                true => self.cells[index].tries > 0,
            };
            let cell = &mut self.cells[index];
            if is_wanted && !cell.is_reached && !cell.has_fresh_try {
                cell.has_fresh_try = true;
                return Some(at);
            }
        }
    }

    /// The box around the places that are reached, with a cell on each side.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        let reached = self.cells.iter().enumerate().filter(|(_, cell)| cell.is_reached);
        let centres = reached.map(|(index, _)| self.lattice.centre(self.lattice.at(index)));
        let (low, high) = centres
            .map(|centre| (centre, centre))
            .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)))?;
        Some([low - self.lattice.width, high + self.lattice.width])
    }
}

impl SkeletonRig {
    /// A box that holds all that the tip of a target's joint could reach by the lengths of bones;
    /// `None` if there is no bound.
    fn most_reached(&self, index: usize, start: &EvaluatedSkeleton) -> Option<[DVec3; 2]> {
        let (target, posed) = (&self.targets[index], &start.solved);
        let scale = posed.transform().matrix3.determinant().abs().cbrt();
        let limb = target.limb_in(&self.skeleton).zip(target.limb());
        let (centre, radius) = match limb.filter(|_| !self.pulls_body(target)) {
            Some((limb, settings)) => {
                let range =
                    LimbRange::of(&start.fk, limb, settings.soft_reach, settings.fk_stretch)?;
                (posed.base(limb.upper), range.most as f32 * scale)
            }
            None => {
                let root = self.skeleton.ancestors(target.joint).last()?;
                let own = self.length_to(target.joint);
                let others = self.targets.iter().filter(|other| {
                    other.joint != target.joint && other.is_posing() && !other.has_free_place()
                });
                let longest = others.map(|other| self.length_to(other.joint)).reduce(f32::max);
                let moved = match self.solver.root {
                    Root::Free => longest?,
                    _ => 0.0,
                };
                (start.fk.base(root), own + moved)
            }
        };
        let (centre, half) = (centre.as_dvec3(), DVec3::splat(f64::from(1.02 * radius)));
        let is_sound = centre.is_finite() && radius.is_finite() && radius > 0.0;
        is_sound.then(|| [centre - half, centre + half])
    }
}
