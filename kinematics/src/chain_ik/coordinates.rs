use glam::{Vec3, Vec3A};

use super::configuration::Configuration;
use super::problem::Problem;

/// Angles of all links and shifts of all trees; also their derivatives or changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Coordinates {
    pub angles: Vec<Vec3>,
    pub shifts: Vec<Vec3A>,
}

impl Coordinates {
    pub fn zero(problem: &Problem) -> Self {
        Self {
            angles: vec![Vec3::ZERO; problem.links.len()],
            shifts: vec![Vec3A::ZERO; problem.trees.len()],
        }
    }

    pub fn copy_from(&mut self, config: &Configuration) {
        self.angles.clone_from(&config.angles);
        self.shifts.clone_from(&config.shifts);
    }
}
