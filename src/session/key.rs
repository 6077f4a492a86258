use crate::document::Channel;

/// A key: its channel and its time, in seconds.
pub type Key = (Channel, f64);
