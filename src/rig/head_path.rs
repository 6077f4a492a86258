use core::iter::once;

use glam::Vec3;

use crate::kinematics::spline::Spline;

/// The path that the head of a chain has left until a time, in skeleton space.
///
/// The path has three parts, from the oldest to the newest: the line of the body as it was at the
/// head's first key, continued straight behind its end; the spline through the head's keys up to the
/// time; and the straight line from there to where the head is, if an edit without a key has moved it.
///
/// The parameter of a point is negative on the body, with one unit per joint. On the spline it counts
/// the keys from 0, with one unit from the last key to the time. One more unit leads to the head.
pub(super) struct HeadPath<'a> {
    keys: &'a Spline<Vec3>,
    time: f64,
    /// Index of the last key until the time.
    last: usize,
    head: Vec3,
    /// Points of the body at the first key, the head's first.
    body: Vec<Vec3>,
    /// The last bone of non-zero length.
    end: Vec3,
}

impl<'a> HeadPath<'a> {
    /// Step of the parameter over which the path is nearly straight.
    pub const STRIDE: f64 = 1.0 / 64.0;

    /// The path at a time in seconds for a head at `head`. `bones` are the vectors from joint to joint
    /// behind the head at the first key. `None` without keys.
    pub fn new(
        keys: &'a Spline<Vec3>,
        time: f64,
        head: Vec3,
        bones: impl Iterator<Item = Vec3>,
    ) -> Option<Self> {
        let first = keys.knots().first()?;
        let until = keys.knots().partition_point(|knot| knot.time <= time);
        let mut end = Vec3::ZERO;
        let behind = bones.scan(first.value, |point, bone| {
            *point += bone;
            end = if bone == Vec3::ZERO { end } else { bone };
            Some(*point)
        });
        let body = once(first.value).chain(behind).collect();
        let last = until.saturating_sub(1);
        Some(Self { keys, time: time.max(first.time), last, head, body, end })
    }

    /// Parameter of the head.
    pub fn head(&self) -> f64 {
        self.last as f64 + 2.0
    }

    /// Point at a parameter.
    pub fn point(&self, at: f64) -> Vec3 {
        let last = self.last as f64;
        if at < 0.0 {
            self.on_body(-at)
        } else if at <= last + 1.0 {
            self.on_spline(at)
        } else {
            self.on_spline(last + 1.0).lerp(self.head, (at - last - 1.0) as f32)
        }
    }

    fn on_spline(&self, at: f64) -> Vec3 {
        let knots = self.keys.knots();
        let from = (at as usize).min(self.last);
        let to = if from < self.last { knots[from + 1].time } else { self.time };
        let from_time = knots[from].time;
        let time = from_time + (to - from_time) * (at - from as f64);
        self.keys.at(time).unwrap_or(self.head)
    }

    fn on_body(&self, joints: f64) -> Vec3 {
        let last = self.body.len() - 1;
        let from = (joints as usize).min(last);
        let beyond = (joints - from as f64) as f32;
        match self.body.get(from + 1) {
            Some(next) => self.body[from].lerp(*next, beyond),
            None => self.body[from] + self.end * beyond,
        }
    }
}
