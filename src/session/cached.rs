use std::cell::OnceCell;

/// A value derived from other state, computed when it is first read. All cached values compare
/// equal, so that comparing sessions ignores them.
#[derive(Clone, Debug)]
pub(super) struct Cached<T>(OnceCell<T>);

impl<T> Cached<T> {
    pub fn get(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(compute)
    }

    /// The value, if it was computed.
    pub fn known(&self) -> Option<&T> {
        self.0.get()
    }

    /// Discards the value; the next [`Self::get`] computes it again.
    pub fn clear(&mut self) {
        self.0.take();
    }
}

impl<T> Default for Cached<T> {
    fn default() -> Self {
        Self(OnceCell::new())
    }
}

impl<T> PartialEq for Cached<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
