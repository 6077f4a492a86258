use super::Method;
use super::configuration::Configuration;
use super::problem::Problem;

/// Detects when iterations have ceased to improve on a reference configuration.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StallDetector {
    /// The last configuration that was an improvement.
    pub reference: Configuration,
    /// Root mean square distance of the reference from the targets, in the problem's units.
    distance: f64,
    /// Mean distance of the reference from the targets, in the problem's units.
    mean: f64,
    /// Number of iterations since the reference was set.
    idle: u32,
    /// Number of idle iterations after which a method has stalled.
    patience: u32,
    /// Decrease of the distance up to which an iteration is idle.
    least: f64,
    /// Decrease of the distance up to which an iteration is idle although joints still move. If
    /// negative, the distance may grow a little.
    least_moving: f64,
    /// Number of iterations in which joints moved without an improvement, since the last
    /// improvement.
    drifts: u32,
}

impl StallDetector {
    pub fn new(method: Method, tolerance: f64, config: &Configuration) -> Self {
        let patience = match method {
            // The fixed step overshoots for longer before it settles, and the poses that points of
            // relaxation give are not nearer after every pass.
            Method::TransposeFixed | Method::Relaxation => 100,
            _ => 20,
        };
        // At this rate of improvement, 500 iterations together improve by less than one tolerance.
        let fraction = f64::from(patience) / 500.0;
        let rounding = f64::from(f32::EPSILON);
        let (least, least_moving) = match method {
            // Written angles are rounded, and another run from them takes other steps. For that run
            // to find no improvement, almost none may be left. In exact arithmetic no sweep
            // increases the distance.
            Method::Ccd => (2.0 * rounding, -rounding),
            // With conflicting targets, FABRIK converges near the minimum, not at it.
            Method::Fabrik => (2.0 * rounding, -1e-5),
            Method::Relaxation => (2.0 * rounding, f64::INFINITY),
            // From the same angles these methods repeat the same steps.
            _ => ((fraction * tolerance).max(rounding), f64::INFINITY),
        };
        Self {
            reference: config.clone(),
            distance: 0.0,
            mean: 0.0,
            idle: 0,
            patience,
            least,
            least_moving,
            drifts: 0,
        }
    }

    /// Makes a configuration the reference.
    pub fn set_reference(&mut self, problem: &Problem, config: &Configuration) {
        self.reference.copy_from(config);
        self.distance = config.distance(problem);
        self.mean = config.mean_distance(problem);
        self.idle = 0;
        self.drifts = 0;
    }

    /// Updates the reference after an iteration. Returns whether the method has stalled.
    pub fn observe(&mut self, problem: &Problem, config: &Configuration) -> bool {
        // More iterations without an improvement are oscillations.
        const DRIFTS: u32 = 200;
        let nearer = match self.distance - config.distance(problem) {
            // The mean shows improvements of the other tips even if one target is far out of reach.
            nearer if nearer >= 0.0 => nearer.max(self.mean - config.mean_distance(problem)),
            farther => farther,
        };
        let drifts = if nearer > self.least { 0 } else { self.drifts + u32::from(nearer <= 0.0) };
        let is_drifting = || nearer > self.least_moving && self.is_moving(problem, config);
        if nearer > self.least || (drifts <= DRIFTS && is_drifting()) {
            self.set_reference(problem, config);
            self.drifts = drifts;
            return false;
        }
        self.idle += 1;
        self.idle >= self.patience
    }

    /// Whether a joint or tip has moved away from the reference. In a flat valley of the cost,
    /// chains move far for little improvement.
    fn is_moving(&self, problem: &Problem, config: &Configuration) -> bool {
        const STILL: f32 = 1e-5;
        config.max_displacement(&self.reference) > STILL * problem.length
    }
}
