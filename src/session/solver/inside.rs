use crate::kinematics::Shared;
use crate::kinematics::chain_ik::SubStep;
use crate::session::cached::Cached;

/// What is looked at within the shown iteration of a solver run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::session) struct Inside {
    /// Index of the shown part; `None` if the iteration is shown as a whole.
    part: Option<usize>,
    /// The parts of the shown iteration.
    parts: Cached<Vec<Shared<SubStep>>>,
    /// Seconds for which the shown part was shown; `None` unless the parts follow each other by
    /// themselves.
    shown_for: Option<f64>,
}

impl Inside {
    pub fn part(&self) -> Option<usize> {
        self.part
    }

    pub fn is_walking(&self) -> bool {
        self.shown_for.is_some()
    }

    pub fn parts(&self, compute: impl FnOnce() -> Vec<SubStep>) -> &[Shared<SubStep>] {
        self.parts.get(|| compute().into_iter().map(Shared::from).collect())
    }

    /// Discards the parts, because another iteration is shown.
    pub fn clear(&mut self) {
        self.parts.clear();
    }

    pub fn show(&mut self, part: Option<usize>) {
        self.part = part;
        if part.is_none() {
            self.shown_for = None;
        }
        if let Some(seconds) = &mut self.shown_for {
            *seconds = 0.0;
        }
    }

    pub fn walk(&mut self, walks: bool) {
        self.shown_for = walks.then_some(0.0);
    }

    /// Lets time pass, in seconds. Returns whether the next of `parts` parts is due.
    pub fn advance(&mut self, passed: f64, parts: usize) -> bool {
        /// Seconds for which a part is shown, and those for which a whole iteration is at least.
        const PART: f64 = 0.9;
        const ITERATION: f64 = 4.0;
        const LEAST: f64 = 0.12;
        let Some(seconds) = &mut self.shown_for else { return false };
        *seconds += passed;
        let length = (ITERATION / parts.max(1) as f64).clamp(LEAST, PART);
        *seconds >= length
    }
}

/// Something that the view shows of a part of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InsideLayer {
    /// The columns of the Jacobian, as arrows at the tips.
    Columns,
    /// The ellipsoid of J·Jᵀ.
    Ellipsoid,
    /// The moves of the tips, and the turns of the angles.
    Step,
    /// CCD: the rays from the joint to tip and target, and the arc between them.
    Rays,
    /// FABRIK and relaxation: the chain of points of a pass.
    Passes,
    /// Two-bone: the triangle and the circle of all elbows.
    Triangle,
}

impl InsideLayer {
    /// All layers.
    pub const ALL: [Self; 6] =
        [Self::Columns, Self::Ellipsoid, Self::Step, Self::Rays, Self::Passes, Self::Triangle];
}

/// The layers that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InsideLayers([bool; InsideLayer::ALL.len()]);

impl Default for InsideLayers {
    /// All layers.
    fn default() -> Self {
        Self([true; InsideLayer::ALL.len()])
    }
}

impl InsideLayers {
    /// True if a layer is shown.
    pub fn shows(self, layer: InsideLayer) -> bool {
        self.0[layer as usize]
    }

    /// These layers with one of them shown or hidden.
    #[must_use]
    pub fn with(mut self, layer: InsideLayer, shown: bool) -> Self {
        self.0[layer as usize] = shown;
        self
    }
}
