use super::Method;
use super::configuration::Configuration;
use super::problem::Problem;

/// Tells when nothing gets better: the pose of the last time that something did.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stall {
    pub pose: Configuration,
    /// Root mean square distance from tips to targets, in the rig's lengths.
    distance: f64,
    /// Mean distance.
    mean: f64,
    pub since: u32,
    /// How many iterations without getting nearer are the end.
    patience: u32,
    /// How much nearer counts.
    least: f64,
    /// How much nearer counts while joints still move.
    unseen: f64,
    /// How often nothing got nearer and yet joints moved.
    drifts: u32,
    /// Whether the method has begun anew since.
    pub renewed: bool,
}

impl Stall {
    pub fn new(method: Method, tolerance: f64, pose: &Configuration) -> Self {
        // The fixed step overshoots for longer before it settles.
        let patience = if method == Method::TransposeFixed { 100 } else { 20 };
        // At this rate the whole budget would not bring the tips nearer by one tolerance.
        let share = f64::from(patience) / f64::from(method.budget());
        let seen = f64::from(f32::EPSILON);
        let (least, unseen) = match method {
            // Angles are written rounded; from there the last iterations go otherwise, so that
            // there must be next to nothing left for them. No sweep of CCD makes things worse,
            // though single precision may have it so.
            Method::Ccd => (2.0 * seen, -seen),
            // Where several targets conflict, it comes to rest near where they are nearest.
            Method::Fabrik => (2.0 * seen, -1e-5),
            // From the same angles these do the same again.
            _ => ((share * tolerance).max(seen), f64::INFINITY),
        };
        let pose = pose.clone();
        Self {
            pose,
            distance: 0.0,
            mean: 0.0,
            since: 0,
            patience,
            least,
            unseen,
            drifts: 0,
            renewed: false,
        }
    }

    pub fn mark(&mut self, rig: &Problem, pose: &Configuration) {
        self.pose.copy(pose);
        self.distance = pose.distance(rig);
        self.mean = pose.mean_distance(rig);
        self.since = 0;
        self.drifts = 0;
        self.renewed = false;
    }

    /// Whether it is time to rest.
    pub fn watch(&mut self, rig: &Problem, pose: &Configuration) -> bool {
        // More is going to and fro.
        const DRIFTS: u32 = 200;
        let nearer = match self.distance - pose.distance(rig) {
            // A target out of reach does not hide how near the others come.
            nearer if nearer >= 0.0 => nearer.max(self.mean - pose.mean_distance(rig)),
            farther => farther,
        };
        let drifts = if nearer > self.least { 0 } else { self.drifts + u32::from(nearer <= 0.0) };
        let is_drifting = || nearer > self.unseen && self.is_moving(rig, pose);
        if nearer > self.least || (drifts <= DRIFTS && is_drifting()) {
            self.mark(rig, pose);
            self.drifts = drifts;
            return false;
        }
        self.since += 1;
        self.since >= self.patience
    }

    /// Whether some joint has come away from the mark: where a valley is flat, chains go far for
    /// little.
    fn is_moving(&self, rig: &Problem, pose: &Configuration) -> bool {
        const STILL: f32 = 1e-5;
        pose.farthest_move(&self.pose) > STILL * rig.length
    }
}
