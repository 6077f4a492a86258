/// Residual error after every iteration of a solver; the oldest half is dropped at 4096 entries.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResidualHistory {
    /// Number of dropped entries.
    dropped: usize,
    errors: Vec<f32>,
}

impl ResidualHistory {
    const MOST: usize = 4096;

    pub(super) fn push(&mut self, error: f32) {
        if self.errors.len() >= Self::MOST {
            let half = Self::MOST / 2;
            self.errors.drain(..half);
            self.dropped += half;
        }
        self.errors.push(error);
    }

    /// Pairs of iteration number and residual error, oldest first.
    pub fn points(&self) -> impl Iterator<Item = (usize, f32)> + '_ {
        self.errors.iter().enumerate().map(|(index, error)| (self.dropped + index, *error))
    }
}
