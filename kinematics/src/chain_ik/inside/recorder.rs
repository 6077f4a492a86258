use glam::{Quat, Vec3A};

use crate::chain_ik::configuration::{Configuration, Coordinates};

/// Keeps what a method computes in an iteration, in the problem's units; nothing if it is off.
pub(in crate::chain_ik) struct Recorder(Option<Vec<Record>>);

/// A part of an iteration with the configuration after it.
pub(in crate::chain_ik) struct Record {
    pub event: Event,
    pub config: Configuration,
}

/// A part of an iteration.
pub(in crate::chain_ik) enum Event {
    /// Straight chains were bent before the first iteration.
    Bend,
    /// The gradient was computed; with damped least squares, for this λ.
    Gradient { descent: Coordinates, damping: Option<f32> },
    /// The angles were changed by `factor` times `by`, within the limits, after `tries` longer or less
    /// damped steps that were refused.
    Step { by: Coordinates, factor: f32, tries: u32, damping: Option<f32> },
    /// One link was rotated; `pairs` are the tips below it before, and their targets.
    Turn { link: usize, rotation: Quat, pairs: Vec<[Vec3A; 2]> },
    /// The roots were moved.
    MoveRoots,
    /// Points were moved from the targets towards the roots.
    Backward(Vec<LinkSegment>),
    /// Points were moved back from the roots.
    Forward(Vec<LinkSegment>),
    /// The length of each bone was restored in turn, from the targets to the roots.
    Relaxed(Vec<LinkSegment>),
    /// Bones were laid out from the roots towards the points.
    LaidOut(Vec<LinkSegment>),
    /// The passes were undone, because they raised the cost.
    Undo,
    /// The elbow of the limb that ends with this link was placed.
    PlaceElbow(usize),
    /// The link was turned to the target.
    Aim(usize),
    /// The method starts again from another pose, or the solver ends with the best pose.
    Restart,
}

/// A link from its joint to one of its points.
#[derive(Clone, Copy)]
pub(in crate::chain_ik) struct LinkSegment {
    pub link: usize,
    pub ends: [Vec3A; 2],
}

impl Recorder {
    pub fn off() -> Self {
        Self(None)
    }

    pub fn on() -> Self {
        Self(Some(Vec::new()))
    }

    pub fn is_on(&self) -> bool {
        self.0.is_some()
    }

    /// Keeps a part of the iteration that ended with `config`.
    pub fn record(&mut self, config: &Configuration, event: impl FnOnce() -> Event) {
        if let Some(records) = &mut self.0 {
            push(records, Record { event: event(), config: config.clone() });
        }
    }

    /// Keeps a change to `config`, unless that is the configuration after the last part.
    pub fn record_change(&mut self, config: &Configuration, event: Event) {
        if let Some(records) = &mut self.0
            && records.last().is_none_or(|last| !last.config.is_same(config))
        {
            push(records, Record { event, config: config.clone() });
        }
    }

    pub fn into_records(self) -> Vec<Record> {
        self.0.unwrap_or_default()
    }
}

/// Appends a record. Where a method has a part for each of very many links, the last record takes the
/// place of the one before it: otherwise memory would grow with the square of the number of links.
fn push(records: &mut Vec<Record>, record: Record) {
    /// Maximum number of links in all records.
    const MOST: usize = 1 << 18;
    if records.len() > 1 && (records.len() + 1) * record.config.bases.len() > MOST {
        records.pop();
    }
    records.push(record);
}
