//! The weights of morph targets over time.

use glam::Vec3;

use super::GlbError;
use crate::document::{Channel, Document, Timeline};
use crate::io::formats::gltf::file::KeyCurve;
use crate::kinematics::spline::{Interpolation, Spline};

/// The weights of all morph targets at the same times.
pub struct MorphAnimation {
    /// Times of the keys in the document, in seconds; empty if no weight has keys.
    pub times: Vec<f64>,
    pub curve: KeyCurve,
    /// For each time the weights; for cubic splines their slopes on arrival, the weights, and their
    /// slopes on leaving.
    pub values: Vec<f32>,
}

impl MorphAnimation {
    /// The keys of a document's morph targets, if all have the same interpolation, and those of
    /// smooth ones the same times; otherwise their values in every frame of a timeline.
    ///
    /// # Errors
    ///
    /// [`GlbError::TooLong`] for too many weights in all frames.
    pub fn new(document: &Document, timeline: Timeline, count: usize) -> Result<Self, GlbError> {
        let channels = (0..count).filter_map(|morph| u16::try_from(morph).ok());
        let track = |morph| document.keys.track(Channel::Morph(morph));
        let tracks: Vec<Option<&Spline<Vec3>>> = channels.map(track).collect();
        let keyed: Vec<&Spline<Vec3>> = tracks.iter().copied().flatten().collect();
        if keyed.is_empty() {
            return Ok(Self { times: Vec::new(), curve: KeyCurve::Linear, values: Vec::new() });
        }
        let is_all = |of: Interpolation| {
            keyed.iter().flat_map(|track| track.knots()).all(|knot| knot.interpolation == of)
        };
        let mut times: Vec<f64> =
            keyed.iter().flat_map(|track| track.knots()).map(|knot| knot.time).collect();
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        let are_same = keyed.iter().all(|track| track.knots().len() == times.len());
        let are_within = times.iter().all(|time| (timeline.start..=timeline.end).contains(time));
        let are_apart = times.windows(2).all(|pair| (pair[0] as f32) < pair[1] as f32);
        let curve = if !(are_within && are_apart) {
            None
        } else if is_all(Interpolation::Linear) {
            Some(KeyCurve::Linear)
        } else if is_all(Interpolation::Step) {
            Some(KeyCurve::Step)
        } else if is_all(Interpolation::Smooth) && are_same {
            Some(KeyCurve::CubicSpline)
        } else {
            None
        };
        let frames = if curve.is_none() { timeline.frames() } else { times.len() };
        if frames.saturating_mul(count) > GlbError::MAX_SAMPLES {
            return Err(GlbError::TooLong { frames, joints: count });
        }
        if curve.is_none() {
            times = (0..timeline.frames()).map(|frame| timeline.time(frame)).collect();
        }
        let weight = |morph: usize, time: f64| {
            let keyed = document.keys.value(Channel::Morph(morph as u16), time);
            keyed.map_or(document.rig.morph_weight(morph).unwrap_or_default(), |value| value.x)
        };
        let mut values = Vec::new();
        for time in &times {
            let weights = (0..tracks.len()).map(|morph| weight(morph, *time));
            if curve == Some(KeyCurve::CubicSpline) {
                let slopes = tracks.iter().map(|track| track.and_then(|it| it.slopes(*time)));
                values.extend(slopes.clone().map(|it| it.map_or(0.0, |it| it.arriving.x)));
                values.extend(weights);
                values.extend(slopes.map(|it| it.map_or(0.0, |it| it.leaving.x)));
            } else {
                values.extend(weights);
            }
        }
        Ok(Self { times, curve: curve.unwrap_or(KeyCurve::Linear), values })
    }
}
