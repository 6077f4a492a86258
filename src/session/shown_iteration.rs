use super::solver_run::SolverRun;

/// The shown iteration of a solver run or of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShownIteration {
    /// Number of the shown iteration: 0 is the FK pose.
    pub number: u32,
    /// Number of the latest iteration.
    pub latest: u32,
    /// Number of the iteration that is kept before the shown one; `None` at the first.
    pub previous: Option<u32>,
    /// Number of the iteration that is kept after the shown one; `None` at the latest.
    pub next: Option<u32>,
}

impl ShownIteration {
    /// The greatest iteration that any of the runs shows; `None` without runs.
    pub(super) fn of<'a>(runs: impl Iterator<Item = &'a SolverRun> + Clone) -> Option<Self> {
        let number = runs.clone().map(|run| run.shown().iteration).max()?;
        let all = runs.map(SolverRun::iterates);
        let before = |before| all.clone().map(|iterates| iterates.at(before).iteration).max();
        Some(Self {
            number,
            latest: before(u32::MAX)?,
            previous: number.checked_sub(1).and_then(before),
            next: all.filter_map(|iterates| Some(iterates.after(number)?.iteration)).min(),
        })
    }
}
