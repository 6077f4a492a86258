use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::grid::{Grid, Place};
use crate::document::{Channel, Document};
use crate::kinematics::Shared;
use crate::rig::{Carried, Posture, SkeletonRig};

/// The motion of a document's skeleton in steps, each from the state that the one before has left.
/// States are computed when they are first needed. They are a function of the document alone.
#[derive(Debug)]
pub(super) struct Motion {
    document: Document,
    /// `None` if no pose depends on the ones before it.
    grid: Option<Grid>,
    states: Mutex<States>,
}

/// The state after a step, and the work of all steps until then.
#[derive(Clone, Debug, PartialEq)]
struct State {
    carried: Arc<Carried>,
    work: u64,
}

/// Kept states.
#[derive(Clone, Debug, Default)]
struct States {
    /// The states after every [`States::SPARSE`]th step.
    sparse: BTreeMap<usize, State>,
    /// The states after all steps since the last sparse one before the step that was needed last.
    block: BTreeMap<usize, State>,
}

/// The last step of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct End {
    step: usize,
    /// True if nothing moves afterwards, so that all later poses are that of the step. Otherwise,
    /// each later pose is one step from its state.
    rests: bool,
}

impl States {
    const SPARSE: usize = 64;

    /// The last kept state after at most `step` steps.
    fn before(&self, step: usize) -> Option<(usize, State)> {
        let last = |states: &BTreeMap<usize, State>| {
            states.range(..=step).next_back().map(|(step, state)| (*step, state.clone()))
        };
        let [sparse, block] = [last(&self.sparse), last(&self.block)];
        [sparse, block].into_iter().flatten().max_by_key(|(step, _)| *step)
    }

    fn keep(&mut self, step: usize, state: State) {
        if step.is_multiple_of(Self::SPARSE) {
            self.sparse.insert(step, state.clone());
            self.block.clear();
        }
        let block = step / Self::SPARSE;
        if self.block.keys().next().is_some_and(|other| other / Self::SPARSE != block) {
            self.block.clear();
        }
        self.block.insert(step, state);
    }

    /// The states that stay if inputs change at a step.
    fn until(&self, step: usize) -> Self {
        let before = |states: &BTreeMap<usize, State>| {
            states.range(..step).map(|(step, state)| (*step, state.clone())).collect()
        };
        Self { sparse: before(&self.sparse), block: before(&self.block) }
    }
}

impl Motion {
    /// Most steps of a motion of targets that move without keys, after the timeline's end.
    const MOST_STEPS: usize = 100_000;
    /// Most work of all steps, in the unit of
    /// [`ChainSolver::bounded`](crate::kinematics::chain_ik::ChainSolver::bounded): some seconds.
    const MOST_WORK: u64 = 1 << 28;
    /// Work of a step beside the solver's and the joints'.
    const WORK_OF_STEP: u64 = 256;

    pub fn new(document: &Document) -> Self {
        let grid = document.is_tracked().then(|| Grid::new(document));
        Self { document: document.clone(), grid, states: Mutex::default() }
    }

    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The motion of another document, with the states of this one until their inputs differ.
    pub fn updated(&self, document: &Document) -> Self {
        let updated = Self::new(document);
        let states = self.states();
        let newest = states.sparse.keys().chain(states.block.keys()).max().copied();
        if let Some(newest) = newest {
            let changed = self.first_change(&updated, newest).unwrap_or(newest + 1);
            *updated.states() = states.until(changed);
        }
        drop(states);
        updated
    }

    /// The state from which the pose at a time in seconds continues; `None` if poses do not depend
    /// on those before them.
    pub fn state_before(&self, time: f64) -> Option<Arc<Carried>> {
        let grid = self.grid?;
        let after = |step: usize| self.state(&grid, step).1.carried;
        let before = |step: usize| match step.checked_sub(1) {
            Some(previous) => after(previous),
            None => self.before_first(&grid),
        };
        // Nothing moves: the first pose is that of all times.
        if self.ended_before(&grid, 1).is_some_and(|end| end.step == 0) {
            return Some(before(0));
        }
        Some(match grid.place(time) {
            Place::Before => after(0),
            Place::On(step) | Place::After(step) => match self.ended_before(&grid, step) {
                Some(End { step, rests: true }) => before(step),
                _ if grid.place(time) == Place::On(step) => before(step),
                _ => after(step),
            },
        })
    }

    /// The state before the first step.
    fn before_first(&self, grid: &Grid) -> Arc<Carried> {
        Arc::new(match &self.document.rig.posture {
            Some(posture) => Carried::from_posture(posture),
            None if grid.last > 0 => Carried::relaxed(),
            None => Carried::default(),
        })
    }

    /// True if the first pose is as near to the FK pose as the targets allow.
    fn begins_relaxed(&self) -> bool {
        let has_posture = self.document.rig.posture.is_some();
        !has_posture && self.grid.is_some_and(|grid| grid.last > 0)
    }

    /// About the work of the steps until a time in seconds whose states are not known, in the unit
    /// of [`Motion::MOST_WORK`].
    pub fn missing_work(&self, time: f64) -> u64 {
        let Some(grid) = self.grid else { return 0 };
        let wanted = match grid.place(time) {
            Place::Before => 0,
            Place::On(step) | Place::After(step) => step,
        };
        let states = self.states();
        let (known, of_known) =
            states.before(wanted).map_or((0, 0), |(step, state)| (step + 1, state.work));
        let of_step = of_known.checked_div(known as u64).unwrap_or_else(|| {
            let rig = &self.document.rig;
            Self::WORK_OF_STEP + (2 * rig.skeleton.joints().len() * rig.targets.len()) as u64
        });
        // States after the end, which is not known, are counted, too.
        (wanted.min(grid.last) + 1).saturating_sub(known) as u64 * of_step
    }

    /// The last known state before a time in seconds; `None` if none is known.
    pub fn known_before(&self, time: f64) -> Option<Arc<Carried>> {
        let step = match self.grid?.place(time) {
            Place::Before => 0,
            Place::On(step) | Place::After(step) => step,
        };
        Some(self.states().before(step)?.1.carried)
    }

    /// The posture of this motion after an edit: one step from its first state to the inputs that
    /// an edited document has there, and as many more as targets are held back. `None` if the
    /// edited document begins with the FK pose.
    ///
    /// With `may_start_afresh`, a solve from the FK pose is taken if it reaches targets that the
    /// step misses.
    pub fn posture_after(
        &self,
        edited: &Document,
        may_start_afresh: bool,
    ) -> Option<Shared<Posture>> {
        let is_tracked = |document: &Document| document.rig.is_tracked;
        if !is_tracked(&self.document) || !is_tracked(edited) {
            return self.document.rig.posture.clone();
        }
        let grid = self.grid?;
        if !edited.is_tracked() {
            return None;
        }
        let [before, after] = [&self.document, edited].map(|it| rig_at(it, grid.start));
        let present = self.document.rig.posture.as_ref();
        let first = self.state(&grid, 0).1.carried;
        if has_same_inputs(&before, &after) {
            // The first key and the removal of the last one must not move a figure, although a
            // motion begins with a relaxed pose, and a figure that stands does not.
            let begins_otherwise = self.begins_relaxed() != Self::new(edited).begins_relaxed();
            let shown = || Some(first.to_posture()).filter(|posture| !posture.is_empty());
            let kept = || begins_otherwise.then(shown).flatten().map(Shared::from);
            return present.cloned().or_else(kept);
        }
        let (solved, carried) = after.settle(grid.start, &first);
        if may_start_afresh
            && !after.has_reached_all(&solved)
            && after.has_reached_all(&after.evaluate(grid.start))
        {
            return None;
        }
        let posture = carried.to_posture();
        (!posture.is_empty()).then(|| posture.into())
    }

    /// The posture of an edited document, whose joints may be others, that begins near a posture of
    /// its joints.
    pub fn posture_near(edited: &Document, posture: &Shared<Posture>) -> Option<Shared<Posture>> {
        if !edited.is_tracked() {
            return None;
        }
        let (start, near) = (edited.motion_start(), Carried::near_posture(posture));
        let posture = rig_at(edited, start).settle(start, &near).1.to_posture();
        (!posture.is_empty()).then(|| posture.into())
    }

    /// The posture with which the motion would come to a solve of the FK pose at a time in seconds:
    /// tracked backwards from there. `None` if no pose depends on those before.
    pub fn posture_reaching(&self, time: f64) -> Option<Shared<Posture>> {
        let grid = self.grid?;
        let last = match grid.place(time) {
            Place::Before => return None,
            Place::On(step) | Place::After(step) => step.min(Self::MOST_STEPS),
        };
        let mut carried = Carried::default();
        rig_at(&self.document, time).carry(time, &mut carried);
        for step in (0..=last).rev() {
            let time = grid.time(step);
            rig_at(&self.document, time).carry(time, &mut carried);
        }
        Some(carried.to_posture().into())
    }

    /// The state after a step, or after the last one of the motion if that comes before, with its
    /// number.
    fn state(&self, grid: &Grid, wanted: usize) -> (usize, State) {
        let known = self.states().before(wanted);
        let (mut step, mut state) = known.unwrap_or_else(|| {
            let first = self.first(grid);
            self.states().keep(0, first.clone());
            (0, first)
        });
        while step < wanted && self.end_at(grid, step, &state).is_none() {
            step += 1;
            state = self.next(grid.time(step), &state);
            self.states().keep(step, state.clone());
        }
        (step, state)
    }

    /// The end of the motion, if it comes before a step.
    fn ended_before(&self, grid: &Grid, wanted: usize) -> Option<End> {
        if wanted <= grid.last {
            return None;
        }
        let (step, state) = self.state(grid, wanted);
        self.end_at(grid, step, &state).filter(|end| end.step < wanted || end.rests)
    }

    /// The end of the motion, if that is a step whose state is known.
    fn end_at(&self, grid: &Grid, step: usize, state: &State) -> Option<End> {
        let is_over = step >= grid.last + Self::MOST_STEPS || state.work > Self::MOST_WORK;
        if is_over {
            return Some(End { step, rests: false });
        }
        let rests =
            step >= grid.last && !self.document.rig.is_moving() && !state.carried.is_held_back();
        rests.then_some(End { step, rests })
    }

    fn first(&self, grid: &Grid) -> State {
        let before = State { carried: self.before_first(grid), work: 0 };
        self.next(grid.time(0), &before)
    }

    fn next(&self, time: f64, before: &State) -> State {
        let rig = rig_at(&self.document, time);
        let mut carried = Carried::clone(&before.carried);
        rig.carry(time, &mut carried);
        let work =
            before.work + carried.work() + rig.skeleton.joints().len() as u64 + Self::WORK_OF_STEP;
        State { carried: Arc::new(carried), work }
    }

    /// The first step, of those until `newest`, at which the inputs of two motions differ; `None`
    /// if none do.
    fn first_change(&self, other: &Self, newest: usize) -> Option<usize> {
        let (Some(grid), Some(others)) = (self.grid, other.grid) else { return Some(0) };
        let [one, two] = [&self.document, &other.document];
        let is_same_grid = grid.has_same_times(&others);
        let is_same_rig = has_same_inputs(&one.rig, &two.rig) && one.rig.posture == two.rig.posture;
        if !is_same_grid || !is_same_rig || self.begins_relaxed() != other.begins_relaxed() {
            return Some(0);
        }
        let changed = one.keys.changed_channels(&two.keys);
        let changed = changed.into_iter().filter(|it| it.is_of_rig());
        let follows_path = !two.rig.follow_paths.is_empty();
        let first = |channel: Channel| {
            let value = |document: &Document, step| {
                let keyed = document.keys.value(channel, grid.time(step));
                keyed.or_else(|| channel.value(document))
            };
            let differs = |step: &usize| follows_path || value(one, *step) != value(two, *step);
            (0..=newest).find(differs)
        };
        changed.filter_map(first).min()
    }

    fn states(&self) -> MutexGuard<'_, States> {
        // A thread that panicked has left whole states only.
        self.states.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The rig of a document with the values that its channels have at a time in seconds.
fn rig_at(document: &Document, time: f64) -> SkeletonRig {
    let mut document = document.clone();
    document.apply_keys(time);
    document.rig
}

/// True if two rigs pose alike, but for their postures.
fn has_same_inputs(one: &SkeletonRig, other: &SkeletonRig) -> bool {
    one.skeleton == other.skeleton
        && one.targets == other.targets
        && one.solver == other.solver
        && one.is_tracked == other.is_tracked
        && one.body_follows == other.body_follows
        && one.balance == other.balance
        && one.follow_paths == other.follow_paths
        && one.head_tracks == other.head_tracks
}
