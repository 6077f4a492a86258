use core::fmt;

use glam::Vec3;

use crate::document::Ray;

/// A part of a point's gizmo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointHandle {
    /// The point itself: moves in a plane parallel to the picture.
    Free,
    /// An arrow: moves along x, y or z (0, 1, 2).
    Axis(usize),
    /// A square: moves in the plane in which coordinate 0, 1 or 2 is constant.
    Plane(usize),
}

impl PointHandle {
    /// True if the handle's axis, if it has one, is 0, 1 or 2.
    pub(in crate::session) fn has_valid_axis(self) -> bool {
        match self {
            Self::Free => true,
            Self::Axis(axis) | Self::Plane(axis) => axis < 3,
        }
    }
}

/// Axis or plane to which a drag is constrained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// Along x, y or z (0, 1, 2).
    Axis(usize),
    /// In the plane in which coordinate 0, 1 or 2 is constant.
    Plane(usize),
}

impl Constraint {
    /// True if the constraint's axis is 0, 1 or 2.
    pub(in crate::session) fn has_valid_axis(self) -> bool {
        let (Self::Axis(axis) | Self::Plane(axis)) = self;
        axis < 3
    }
}

/// Position of the mouse and modifier keys during a drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragInput {
    /// The ray through the mouse, in world space.
    pub ray: Ray,
    /// True if precision is on: the drag moves a tenth as far as the mouse.
    pub precise: bool,
    /// True if snapping is on: the drag ends on whole steps.
    pub snap: bool,
}

/// The drag of a point. The point is computed from the state at the press, never from its previous
/// position, so that nothing drifts.
#[derive(Clone, Debug, PartialEq)]
pub struct PointDrag {
    handle: PointHandle,
    constraint: Option<Constraint>,
    /// The point at the press, in world space.
    start: Vec3,
    /// Step of snapping, in world units.
    step: f32,
    /// Point from which whole steps are counted, in world space.
    snapped_from: Vec3,
    /// Normal of the picture, in the direction in which the camera looks.
    forward: Vec3,
    pressed: Ray,
    now: DragInput,
    /// State when precision was last switched on or off; `None` if it never was.
    precision: Option<PrecisionStart>,
    typed: String,
    last: Vec3,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct PrecisionStart {
    on: bool,
    ray: Ray,
    offset: Vec3,
}

impl PointDrag {
    const PRECISION: f32 = 0.1;
    /// Step of snapping for the default arm, in world units.
    const SNAP: f32 = 10.0;
    const PRECISE_SNAP: f32 = 0.1;
    /// Step of snapping, in cells of the grid.
    pub(in crate::session) const SNAP_CELLS: f32 = 0.1;

    /// Begins a drag of the point at `start` in world space. `forward` is the normal of the picture.
    pub(in crate::session) fn new(
        handle: PointHandle,
        start: Vec3,
        forward: Vec3,
        ray: Ray,
    ) -> Self {
        let now = DragInput { ray, precise: false, snap: false };
        Self {
            handle,
            constraint: None,
            start,
            step: Self::SNAP,
            snapped_from: Vec3::ZERO,
            forward,
            pressed: ray,
            now,
            precision: None,
            typed: String::new(),
            last: start,
        }
    }

    /// The same drag, which snaps to whole steps from a point.
    pub(in crate::session) fn with_steps(self, step: f32, snapped_from: Vec3) -> Self {
        Self { step, snapped_from, ..self }
    }

    /// The part of the gizmo that is dragged.
    pub fn handle(&self) -> PointHandle {
        self.handle
    }

    /// The constraint from the keyboard, else the one of the handle; `None` for a free drag.
    pub fn constraint(&self) -> Option<Constraint> {
        self.constraint.or(match self.handle {
            PointHandle::Free => None,
            PointHandle::Axis(axis) => Some(Constraint::Axis(axis)),
            PointHandle::Plane(axis) => Some(Constraint::Plane(axis)),
        })
    }

    /// The offset as typed; empty while the mouse sets the offset.
    pub fn typed(&self) -> &str {
        &self.typed
    }

    /// True if the mouse has moved, an offset was typed, or precision was switched on or off.
    pub(in crate::session) fn has_moved(&self) -> bool {
        !self.typed.is_empty() || self.precision.is_some() || self.now.ray != self.pressed
    }

    /// The point in world space; always finite.
    pub fn at(&self) -> Vec3 {
        self.last.clamp(Vec3::MIN, Vec3::MAX)
    }

    /// Offset of the point from its position at the press; always finite.
    pub fn moved(&self) -> Vec3 {
        (self.last - self.start).clamp(Vec3::MIN, Vec3::MAX)
    }

    pub(in crate::session) fn set_constraint(&mut self, constraint: Option<Constraint>) {
        self.constraint = constraint;
        self.precision = None;
    }

    pub(in crate::session) fn set_typed(&mut self, typed: String) {
        self.typed = typed;
    }

    pub(in crate::session) fn set_input(&mut self, input: DragInput) {
        if input.precise != self.now.precise {
            let offset = self.pointed();
            self.precision = Some(PrecisionStart { on: input.precise, ray: self.now.ray, offset });
        }
        self.now = input;
    }

    /// Computes the dragged point in world space. Coordinates that the drag does not move are
    /// unchanged, bit for bit.
    pub(in crate::session) fn point(&mut self) -> Vec3 {
        let offset = if self.typed.is_empty() {
            self.pointed()
        } else {
            offset_of(&self.typed, self.constraint()).unwrap_or(Vec3::ZERO)
        };
        let snap = self.now.snap && self.typed.is_empty();
        let step = self.step * if self.now.precise { Self::PRECISE_SNAP } else { 1.0 };
        for axis in 0..3 {
            if self.is_moved(axis) {
                let to = self.start[axis] + offset[axis];
                let from = self.snapped_from[axis];
                let to = if snap { ((to - from) / step).round() * step + from } else { to };
                self.last[axis] = to.clamp(f32::MIN, f32::MAX);
            } else {
                self.last[axis] = self.start[axis];
            }
        }
        self.last
    }

    fn is_moved(&self, axis: usize) -> bool {
        match self.constraint() {
            None => true,
            Some(Constraint::Axis(moved)) => axis == moved,
            Some(Constraint::Plane(kept)) => axis != kept,
        }
    }

    /// Offset of the point since the press as the mouse sets it, reduced while precision is on.
    fn pointed(&self) -> Vec3 {
        let Some(PrecisionStart { on, ray, offset }) = self.precision else {
            return self.between(self.pressed, self.now.ray).unwrap_or(self.last - self.start);
        };
        let since = self.between(ray, self.now.ray).unwrap_or(Vec3::ZERO);
        offset + since * if on { Self::PRECISION } else { 1.0 }
    }

    /// Offset of the point when the mouse moves from one ray to another; `None` if a ray does not
    /// meet the line or plane of the drag.
    fn between(&self, from: Ray, to: Ray) -> Option<Vec3> {
        let at_press = self.start;
        let offset = match self.constraint() {
            Some(Constraint::Axis(axis)) => {
                let axis = Vec3::AXES[axis];
                axis * (to.nearest_on_line(at_press, axis)?
                    - from.nearest_on_line(at_press, axis)?)
            }
            Some(Constraint::Plane(axis)) => {
                let normal = Vec3::AXES[axis];
                to.meets_plane(at_press, normal)? - from.meets_plane(at_press, normal)?
            }
            None => {
                to.meets_plane(at_press, self.forward)?
                    - from.meets_plane(at_press, self.forward)?
            }
        };
        offset.is_finite().then_some(offset)
    }
}

/// Parses a typed offset: numbers separated by commas for the coordinates that the drag moves, in
/// order. Missing numbers are 0; `None` for an invalid number.
fn offset_of(typed: &str, constraint: Option<Constraint>) -> Option<Vec3> {
    let axes: &[usize] = match constraint {
        None => &[0, 1, 2],
        Some(Constraint::Axis(0)) => &[0],
        Some(Constraint::Axis(1)) => &[1],
        Some(Constraint::Axis(_)) => &[2],
        Some(Constraint::Plane(0)) => &[1, 2],
        Some(Constraint::Plane(1)) => &[0, 2],
        Some(Constraint::Plane(_)) => &[0, 1],
    };
    let mut offset = Vec3::ZERO;
    for (axis, number) in axes.iter().zip(typed.split(',')) {
        let number = number.trim();
        if !number.is_empty() && number != "-" {
            offset[*axis] = number.parse().ok().filter(|number: &f32| number.is_finite())?;
        }
    }
    Some(offset)
}

impl fmt::Display for Constraint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Axis(0) => "along x",
            Self::Axis(1) => "along y",
            Self::Axis(_) => "along z",
            Self::Plane(0) => "in the yz-plane",
            Self::Plane(1) => "in the xz-plane",
            Self::Plane(_) => "in the xy-plane",
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::document::Camera;

    const START: Vec3 = Vec3::new(280.0, 100.0, 70.0);

    fn drag(handle: PointHandle) -> (PointDrag, crate::document::Projection) {
        let projection = Camera::default().projection(1.6);
        let at = projection.project(START).expect("in the picture");
        let ray = projection.ray(at);
        (PointDrag::new(handle, START, projection.forward, ray), projection)
    }

    fn input(ray: Ray) -> DragInput {
        DragInput { ray, precise: false, snap: false }
    }

    #[test]
    fn a_free_hand_stays_under_the_mouse() {
        let (mut drag, projection) = drag(PointHandle::Free);
        for at in [Vec2::new(0.1, 0.2), Vec2::new(-0.9, 0.8), Vec2::new(0.99, -0.99)] {
            drag.set_input(input(projection.ray(at)));
            let seen = projection.project(drag.point()).expect("in the picture");
            assert!(seen.distance(at) < 1e-4, "{seen} is not under {at}");
        }
    }

    #[test]
    fn an_arrow_moves_one_coordinate_and_keeps_the_others_bit_for_bit() {
        for axis in 0..3 {
            let (mut drag, projection) = drag(PointHandle::Axis(axis));
            drag.set_input(input(projection.ray(Vec2::new(0.31, 0.47))));
            let hand = drag.point();
            for other in 0..3 {
                assert_eq!(hand[other] == START[other], other != axis);
            }
        }
    }

    #[test]
    fn a_square_keeps_one_coordinate_bit_for_bit() {
        for axis in 0..3 {
            let (mut drag, projection) = drag(PointHandle::Plane(axis));
            drag.set_input(input(projection.ray(Vec2::new(0.31, 0.17))));
            let hand = drag.point();
            for other in 0..3 {
                assert_eq!(hand[other] == START[other], other == axis);
            }
        }
    }

    #[test]
    fn a_mouse_that_returns_to_the_press_restores_the_point() {
        for handle in [PointHandle::Free, PointHandle::Axis(1), PointHandle::Plane(2)] {
            let (mut drag, projection) = drag(handle);
            let pressed = drag.pressed;
            for step in 0..50 {
                drag.set_input(input(projection.ray(Vec2::new(step as f32 * 0.01, 0.3))));
                drag.point();
            }
            drag.set_input(input(pressed));
            assert_eq!(drag.point(), START);
        }
    }

    #[test]
    fn precision_moves_a_tenth_as_far() {
        let (mut drag, projection) = drag(PointHandle::Axis(0));
        let at = projection.project(START).expect("in the picture");
        let ray = |x: f32| projection.ray(at + Vec2::new(x, 0.0));
        drag.set_input(input(ray(0.2)));
        let coarse = drag.point().x;
        drag.set_input(DragInput { precise: true, ..input(ray(0.2)) });
        assert!((drag.point().x - coarse).abs() < 1e-3, "turning precision on moves nothing");
        drag.set_input(DragInput { precise: true, ..input(ray(0.4)) });
        let fine = drag.point().x - coarse;
        drag.set_input(input(ray(0.4)));
        drag.set_input(input(ray(0.2)));
        let back = drag.point().x - (coarse + fine);
        assert!((fine * 10.0 + back).abs() < 0.05, "{fine} is not a tenth of {back}");
    }

    #[test]
    fn snapping_lands_on_whole_steps_of_the_coordinates_that_move() {
        let (mut drag, projection) = drag(PointHandle::Plane(1));
        let ray = projection.ray(Vec2::new(0.3, 0.1));
        drag.set_input(DragInput { snap: true, ..input(ray) });
        let hand = drag.point();
        assert_eq!((hand.x % 10.0, hand.y, hand.z % 10.0), (0.0, START.y, 0.0));
        drag.set_input(DragInput { snap: true, precise: true, ..input(ray) });
        let hand = drag.point();
        assert_eq!((hand.x % 1.0, hand.z % 1.0), (0.0, 0.0));
    }

    #[test]
    fn a_constraint_moves_a_free_drag_along_its_axis() {
        let (mut drag, projection) = drag(PointHandle::Free);
        drag.set_input(input(projection.ray(Vec2::new(0.3, 0.4))));
        drag.set_constraint(Some(Constraint::Axis(2)));
        let hand = drag.point();
        assert_eq!((hand.x, hand.y), (START.x, START.y));
        assert_ne!(hand.z, START.z);
        drag.set_constraint(None);
        assert_ne!(drag.point().x, START.x);
    }

    #[test]
    fn typed_numbers_are_the_offset_of_moved_coordinates() {
        let typed = |handle, text: &str| {
            let (mut drag, projection) = drag(handle);
            drag.set_input(input(projection.ray(Vec2::new(0.3, 0.4))));
            drag.set_typed(text.to_owned());
            drag.point() - START
        };
        assert_eq!(typed(PointHandle::Axis(1), "12.5"), Vec3::new(0.0, 12.5, 0.0));
        assert_eq!(typed(PointHandle::Plane(1), "-3,4"), Vec3::new(-3.0, 0.0, 4.0));
        assert_eq!(typed(PointHandle::Free, "1,2,3"), Vec3::new(1.0, 2.0, 3.0));
        assert_eq!(typed(PointHandle::Free, "1,"), Vec3::new(1.0, 0.0, 0.0));
        assert_eq!(typed(PointHandle::Free, "-"), Vec3::ZERO);
        assert_eq!(typed(PointHandle::Free, "1e99"), Vec3::ZERO);
    }

    #[test]
    fn a_ray_that_misses_the_plane_leaves_the_point() {
        let (mut drag, _) = drag(PointHandle::Plane(1));
        let up = Ray { origin: Vec3::new(0.0, 500.0, 0.0), direction: Vec3::Y };
        drag.set_input(input(up));
        assert_eq!(drag.point(), START);
    }
}
