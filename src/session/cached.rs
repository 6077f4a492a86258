use std::cell::OnceCell;

/// A value derived from other state, computed when it is first needed. All are equal, so that sessions
/// are compared by the state alone.
#[derive(Clone, Debug)]
pub(super) struct Cached<T>(OnceCell<T>);

impl<T> Cached<T> {
    pub fn get(&self, compute: impl FnOnce() -> T) -> &T {
        self.0.get_or_init(compute)
    }

    /// Lets the value be computed again.
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
