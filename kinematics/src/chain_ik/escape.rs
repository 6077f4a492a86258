use super::configuration::Configuration;
use super::problem::Problem;

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

    /// Makes `config` the best configuration if it is nearer to the targets. All attempts may be made
    /// again if it is much nearer, and the first one if it is nearer at all.
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
