use glam::{DQuat, DVec3, DVec4, Vec3};

use super::buffers::GltfBuffers;
use super::nodes::{NodeTransform, unit};
use super::rows::{AccessorRows, at_accessor};
use crate::document::Timeline;
use crate::io::formats::gltf::extras::{Extras, SamplerExtras};
use crate::io::formats::gltf::file::{GltfAnimation, GltfFile, KeyCurve, index_rule};
use crate::io::json::{FieldError, JsonPath};
use crate::kinematics::spline::{Spline, hermite};

/// The part of a node's transform that an animation channel changes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum AnimatedPart {
    Translation,
    Rotation,
    Scale,
}

/// The warning about keys whose times do not increase.
pub const UNSORTED: &str = "times must increase; the keys are sorted, and of several keys at the same \
    time the last one counts";

/// A channel of an animation that moves a node.
#[derive(Clone, Copy)]
pub struct UsedChannel<'a> {
    pub node: usize,
    pub part: AnimatedPart,
    pub source: KeySource<'a>,
}

/// Where the file has the keys of a channel.
#[derive(Clone, Copy)]
pub struct KeySource<'a> {
    pub curve: KeyCurve,
    /// Accessor of the times.
    pub input: usize,
    /// Accessor of the values.
    pub output: usize,
    /// The keys that this program has written beside the sampler.
    pub own: Option<&'a SamplerExtras>,
}

impl<'a> KeySource<'a> {
    /// The sampler of the channel with this index in an animation. `at` is the animation's path.
    pub fn of(
        animation: &'a GltfAnimation,
        channel: usize,
        at: &JsonPath,
    ) -> Result<Self, FieldError> {
        let index = animation.channels.0[channel].sampler.0 as usize;
        let Some(sampler) = animation.samplers.0.get(index) else {
            let reason = index_rule("samplers", animation.samplers.0.len(), index);
            let at_channel = at.clone().key("channels").index(channel);
            return Err(FieldError::new(at_channel.key("sampler"), reason));
        };
        let name = sampler.interpolation.as_deref().unwrap_or("LINEAR");
        let curve = KeyCurve::new(name).ok_or_else(|| {
            let reason = format!("must be LINEAR, STEP or CUBICSPLINE, got {name:?}");
            let at_sampler = at.clone().key("samplers").index(index);
            FieldError::new(at_sampler.key("interpolation"), reason)
        })?;
        let (input, output) = (sampler.input.0 as usize, sampler.output.0 as usize);
        let own = sampler.extras.as_ref().and_then(Extras::own);
        Ok(Self { curve, input, output, own })
    }
}

/// The keys of one animated part of a node, with their interpolation.
pub struct KeySampler<'a> {
    pub channel: UsedChannel<'a>,
    times: AccessorRows<'a>,
    /// The rows of the keys in the order of their times; `None` if the file has them in this order.
    order: Option<Vec<u32>>,
    /// One row per time, or with cubic splines three rows: in-tangent, value, out-tangent.
    values: AccessorRows<'a>,
}

/// Maximum difference, in seconds, at which `time` still counts as the time of a key. Times of keys
/// are inexact: files store them in 32 bits, and some programs write few decimals.
pub fn tolerance(time: f64) -> f64 {
    const LEAST: f64 = 1e-4;
    const ROUNDING: f64 = 2.0 * f32::EPSILON as f64;
    (time.abs() * ROUNDING).max(LEAST)
}

/// The time of the frame at a time that single precision cannot tell from it; else the time itself.
pub fn on_frame(time: f64, timeline: Timeline) -> f64 {
    let frame = timeline.snapped(time);
    let rounding = (time.abs() * f64::from(f32::EPSILON)).max(1e-7);
    if (frame - time).abs() <= rounding { frame } else { time }
}

/// Relative change of a value below which it counts as constant.
const LEAST: f64 = 1e-6;

/// Index of the in-tangent among the three rows of a cubic spline's key.
const IN_TANGENT: usize = 0;
/// Index of the value among the three rows of a cubic spline's key.
const VALUE: usize = 1;
/// Index of the out-tangent among the three rows of a cubic spline's key.
const OUT_TANGENT: usize = 2;

impl<'a> KeySampler<'a> {
    pub fn new(
        file: &GltfFile<'_>,
        buffers: &'a GltfBuffers<'_>,
        channel: UsedChannel<'a>,
    ) -> Result<Self, FieldError> {
        let UsedChannel { part, source: KeySource { curve, input, output, .. }, .. } = channel;
        let times = AccessorRows::new(file, buffers, input, "SCALAR")?;
        let shape = if part == AnimatedPart::Rotation { "VEC4" } else { "VEC3" };
        let values = AccessorRows::new(file, buffers, output, shape)?;
        if !times.is_float() {
            let reason = "must be 5126 (float) for times";
            return Err(FieldError::new(at_accessor(input).key("componentType"), reason));
        }
        if !(values.is_float() || part == AnimatedPart::Rotation && values.is_normalized()) {
            let reason =
                "must be 5126 (float) for values; rotations may also be normalized integers";
            return Err(FieldError::new(at_accessor(output).key("componentType"), reason));
        }
        if times.len() == 0 {
            return Err(FieldError::new(
                at_accessor(input).key("count"),
                "must be 1 or more, got 0",
            ));
        }
        let values_per_key = curve.values_per_key();
        if values.len() != values_per_key * times.len() {
            let (count, times) = (values.len(), times.len());
            let reason =
                format!("must be {values_per_key} for each of the {times} times, got {count}");
            return Err(FieldError::new(at_accessor(output).key("count"), reason));
        }
        Ok(Self { channel, times, order: None, values })
    }

    /// Sorts the keys by time. Of several keys at the same time, the last one counts. Returns
    /// whether anything changed, or an error if a time is not finite.
    pub fn sort(&mut self) -> Result<bool, FieldError> {
        let times = || (0..self.times.len()).map(|row| self.row_time(row));
        if let Some((key, time)) = times().enumerate().find(|(_, time)| !time.is_finite()) {
            let reason = format!("times must be finite, got {time} as time {key}");
            return Err(FieldError::new(at_accessor(self.channel.source.input), reason));
        }
        if times().is_sorted_by(|before, after| before < after) {
            return Ok(false);
        }
        let mut order: Vec<u32> = (0..self.times.len() as u32).collect();
        let time = |row: &u32| self.row_time(*row as usize);
        order.sort_by(|a, b| time(a).total_cmp(&time(b)));
        // The last of equal times is kept: in reverse, it comes first.
        order.reverse();
        order.dedup_by(|row, kept| time(row) == time(kept));
        order.reverse();
        self.order = Some(order);
        Ok(true)
    }

    /// Checks all keys. Fails if values are not finite or a rotation is zero.
    pub fn check(&self) -> Result<(), FieldError> {
        let error = |reason| Err(FieldError::new(at_accessor(self.channel.source.output), reason));
        for row in 0..self.values.len() {
            let value: [f64; 4] = self.values.row(row);
            if !value.into_iter().take(self.width()).all(f64::is_finite) {
                let reason =
                    format!("value {row} must be finite, got {:?}", &value[..self.width()]);
                return error(reason);
            }
        }
        if self.channel.part == AnimatedPart::Rotation {
            for key in 0..self.len() {
                if unit(self.row(key, VALUE)).is_none() {
                    return error(format!("rotation {key} must not be four zeros"));
                }
            }
        }
        Ok(())
    }

    /// Returns whether the value ever differs from that of the first key, or leaves it on a cubic
    /// spline.
    pub fn varies(&self) -> bool {
        self.varies_by(LEAST)
    }

    /// [`KeySampler::varies`] by more than `least` of the value.
    pub fn varies_by(&self, least: f64) -> bool {
        let width = self.width();
        let row = |row: usize| -> [f64; 4] { self.values.row(row) };
        let differs = |a: [f64; 4], b: [f64; 4]| {
            let size = a.iter().take(width).map(|part| part.abs()).fold(1e-3, f64::max);
            (0..width).any(|part| (a[part] - b[part]).abs() > least * size)
        };
        let is_cubic = self.is_cubic();
        let (each, value) = if is_cubic { (3, VALUE) } else { (1, 0) };
        let keys = self.times.len();
        (1..keys).any(|key| differs(row(value), row(each * key + value)))
            || is_cubic
                && keys > 1
                && (0..keys).any(|key| {
                    [IN_TANGENT, OUT_TANGENT]
                        .into_iter()
                        .any(|which| differs([0.0; 4], row(3 * key + which)))
                })
    }

    /// Returns whether a scale is uneven by more than `least` of itself at a key or a tangent of a
    /// key, or at a key not above 0.
    pub fn is_uneven(&self, least: f64) -> bool {
        let is_uneven =
            |scale: DVec3, size: f64| scale.max_element() - scale.min_element() > least * size;
        (0..self.len()).any(|key| {
            let scale = self.key_point(key);
            let slopes = self.tangents(key).into_iter().flatten();
            let size = scale.abs().max_element();
            scale.min_element() <= 0.0
                || is_uneven(scale, size)
                || slopes.into_iter().any(|slope| is_uneven(slope, size))
        })
    }

    /// The first key of a scale, or if that is next to 0 along an axis, the key with the greatest
    /// volume.
    pub fn key_with_volume(&self) -> usize {
        /// Part of the greatest factor along an axis at which a factor is next to 0.
        const FLAT: f64 = 1e-3;
        let scales = (0..self.len()).map(|key| self.key_point(key).abs());
        let greatest = scales.clone().fold(DVec3::ZERO, DVec3::max);
        if self.key_point(0).abs().cmpge(FLAT * greatest).all() {
            return 0;
        }
        let volumes = scales.map(DVec3::element_product).enumerate();
        volumes.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(key, _)| key)
    }

    /// Sets the animated part of the node's transform in `locals` to its value at a time.
    pub fn pose(&self, time: f64, locals: &mut [NodeTransform]) {
        if let Some(NodeTransform::TransformParts(parts)) = locals.get_mut(self.channel.node) {
            match self.channel.part {
                AnimatedPart::Translation => parts.translation = self.point(time),
                AnimatedPart::Rotation => parts.rotation = self.rotation(time),
                AnimatedPart::Scale => parts.scale = self.point(time),
            }
        }
    }

    pub fn is_cubic(&self) -> bool {
        self.channel.source.curve == KeyCurve::CubicSpline
    }

    /// The keys that this program has written beside the track; `None` if there are none.
    pub fn own_keys(&self) -> Option<Spline<Vec3>> {
        self.channel.source.own?.spline()
    }

    /// Translation or scale of a key.
    pub fn key_point(&self, key: usize) -> DVec3 {
        DVec3::from_array(self.row(key, VALUE))
    }

    /// Rotation of a key.
    pub fn key_rotation(&self, key: usize) -> DQuat {
        unit(self.row(key, VALUE)).unwrap_or_default()
    }

    /// In-tangent and out-tangent of a key, per second; `None` without cubic splines.
    pub fn tangents(&self, key: usize) -> Option<[DVec3; 2]> {
        let tangent = |which| DVec3::from_array(self.row(key, which));
        self.is_cubic().then(|| [IN_TANGENT, OUT_TANGENT].map(tangent))
    }

    /// Rotation on the cubic spline from a key to the next one, at a part of the way.
    pub fn spline_rotation(&self, key: usize, part: f64) -> DQuat {
        unit(self.cubic(key, part).to_array()).unwrap_or_else(|| self.key_rotation(key))
    }

    /// Number of keys.
    pub fn len(&self) -> usize {
        self.order.as_ref().map_or(self.times.len(), Vec::len)
    }

    /// Time of a key, in seconds.
    pub fn time(&self, key: usize) -> f64 {
        self.row_time(self.row_of(key))
    }

    fn row_time(&self, row: usize) -> f64 {
        let [time] = self.times.row(row);
        time
    }

    /// The row of the file that has a key.
    fn row_of(&self, key: usize) -> usize {
        self.order.as_ref().map_or(key, |order| order[key] as usize)
    }

    pub fn point(&self, time: f64) -> DVec3 {
        let (key, fraction) = self.locate(time);
        match fraction {
            None => self.key_point(key),
            Some(fraction) if self.is_cubic() => self.cubic(key, fraction).truncate(),
            Some(fraction) => self.key_point(key).lerp(self.key_point(key + 1), fraction),
        }
    }

    pub fn rotation(&self, time: f64) -> DQuat {
        let (key, fraction) = self.locate(time);
        match fraction {
            None => self.key_rotation(key),
            Some(fraction) if self.is_cubic() => self.spline_rotation(key, fraction),
            Some(fraction) => {
                self.key_rotation(key).slerp(self.key_rotation(key + 1), fraction).normalize()
            }
        }
    }

    /// Returns the key at or before `time`, and the fraction of the way from this key to the next.
    /// The fraction is `None` if the key's own value applies: at the key, after the last key, and
    /// with step interpolation. Before the first key, returns the first key with `None`.
    fn locate(&self, time: f64) -> (usize, Option<f64>) {
        // Only a step would be missed just before a key.
        let near = if self.channel.source.curve == KeyCurve::Step { tolerance(time) } else { 0.0 };
        let (mut until, mut after) = (0, self.len());
        while until < after {
            let middle = until + (after - until) / 2;
            if self.time(middle) <= time + near {
                until = middle + 1;
            } else {
                after = middle;
            }
        }
        let Some(key) = until.checked_sub(1) else { return (0, None) };
        let start = self.time(key);
        let is_between = key + 1 < self.len() && time - start > near;
        if !is_between || self.channel.source.curve == KeyCurve::Step {
            return (key, None);
        }
        (key, Some((time - start) / (self.time(key + 1) - start)))
    }

    /// Interpolates between `key` and the next key, at the fraction `s` of the way, by the cubic
    /// Hermite polynomial in appendix C of the glTF specification.
    fn cubic(&self, key: usize, s: f64) -> DVec4 {
        let span = self.time(key + 1) - self.time(key);
        let row = |key, which| DVec4::from_array(self.row(key, which));
        let [of_from, of_leaving, of_to, of_arriving] = hermite(s);
        row(key, VALUE) * of_from
            + row(key, OUT_TANGENT) * (span * of_leaving)
            + row(key + 1, VALUE) * of_to
            + row(key + 1, IN_TANGENT) * (span * of_arriving)
    }

    /// The numbers of a key. `which` selects the row of a cubic spline's key; other keys have one
    /// row.
    fn row<const N: usize>(&self, key: usize, which: usize) -> [f64; N] {
        let row = self.row_of(key);
        self.values.row(if self.is_cubic() { 3 * row + which } else { row })
    }

    fn width(&self) -> usize {
        if self.channel.part == AnimatedPart::Rotation { 4 } else { 3 }
    }
}
