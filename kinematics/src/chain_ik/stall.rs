use super::configuration::Configuration;
use super::problem::Problem;

/// Number of iterations without an improvement after which a method has stalled, and the decrease
/// of the distance that is an improvement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Patience {
    iterations: u32,
    /// True if the method repeats the same steps from the same angles.
    repeats_steps: bool,
    /// See [`StallDetector::least_moving`].
    least_moving: f64,
}

impl Patience {
    /// Of a method that repeats the same steps from the same angles.
    pub const fn of_repeated_steps(iterations: u32) -> Self {
        Self { iterations, repeats_steps: true, least_moving: f64::INFINITY }
    }

    /// Of a method that works on orientations. Written angles are rounded, and another run from
    /// them takes other steps. For that run to find no improvement, almost none may be left.
    pub const fn of_orientations(iterations: u32, least_moving: f64) -> Self {
        Self { iterations, repeats_steps: false, least_moving }
    }

    /// Number of iterations without an improvement after which the method has stalled.
    pub fn iterations(self) -> u32 {
        self.iterations
    }

    /// Decrease of the distance up to which an iteration is idle. `tolerance` is in the problem's
    /// units.
    fn least_decrease(self, tolerance: f64) -> f64 {
        let rounding = f64::from(f32::EPSILON);
        // At this rate of improvement, 500 iterations together improve by less than one tolerance.
        let fraction = f64::from(self.iterations) / 500.0;
        if self.repeats_steps { (fraction * tolerance).max(rounding) } else { 2.0 * rounding }
    }
}

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
    pub fn new(patience: Patience, tolerance: f64, config: &Configuration) -> Self {
        Self {
            reference: config.clone(),
            distance: 0.0,
            mean: 0.0,
            idle: 0,
            patience: patience.iterations,
            least: patience.least_decrease(tolerance),
            least_moving: patience.least_moving,
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

    /// True if a joint or tip has moved away from the reference. In a flat valley of the cost,
    /// chains move far for little improvement.
    fn is_moving(&self, problem: &Problem, config: &Configuration) -> bool {
        const STILL: f32 = 1e-5;
        config.max_displacement(&self.reference) > STILL * problem.length
    }
}

/// Attempts to leave a local minimum, and the best configuration found before them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Escape {
    /// Number of attempts since the best configuration was found.
    pub attempts: u32,
    pub best: Configuration,
    /// Root mean square distance of the best configuration from the targets, in the problem's
    /// units; infinite without a best configuration.
    distance: f64,
    /// Space for a configuration before it is changed.
    pub scratch: Configuration,
}

impl Escape {
    pub fn new(config: &Configuration) -> Self {
        Self { attempts: 0, best: config.clone(), distance: f64::INFINITY, scratch: config.clone() }
    }

    /// Forgets the best configuration and all attempts.
    pub fn reset(&mut self) {
        self.attempts = 0;
        self.distance = f64::INFINITY;
    }

    /// Replaces `config` by the best configuration if that is nearer to the targets.
    pub fn restore_best(&self, problem: &Problem, config: &mut Configuration) {
        if self.distance < config.distance(problem) {
            config.copy_from(&self.best);
        }
    }

    /// Makes `config` the best configuration if it is nearer to the targets. All attempts may be
    /// made again if it is much nearer, and the first one if it is nearer at all.
    pub fn observe(&mut self, problem: &Problem, config: &Configuration) {
        // Relative decrease of the distance that is worth the same attempts again.
        const WORTH: f64 = 1e-3;
        let distance = config.distance(problem);
        if distance < self.distance {
            if self.attempts <= 1 || distance < (1.0 - WORTH) * self.distance {
                self.attempts = 0;
            }
            self.best.copy_from(config);
            self.distance = distance;
        }
    }
}
