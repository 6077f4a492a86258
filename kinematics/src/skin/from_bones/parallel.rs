//! Work on all cores, whose results do not depend on their number.

/// Maps items in their order; on all cores with the feature `parallel`.
#[cfg(feature = "parallel")]
pub fn map<I: Sync, T: Send>(items: &[I], map: impl Fn(&I) -> T + Sync + Send) -> Vec<T> {
    use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};
    items.par_iter().map(map).collect()
}

/// Maps items in their order; on all cores with the feature `parallel`.
#[cfg(not(feature = "parallel"))]
pub fn map<I: Sync, T: Send>(items: &[I], map: impl Fn(&I) -> T + Sync + Send) -> Vec<T> {
    items.iter().map(map).collect()
}

/// Ranges of indices below `count`, each small beside the work of a core.
pub fn ranges(count: usize) -> Vec<core::ops::Range<usize>> {
    const LENGTH: usize = 512;
    (0..count).step_by(LENGTH).map(|start| start..count.min(start + LENGTH)).collect()
}
