//! The gizmo: targets, bone tips, and rings of the selected joint, of its target and of its limb.

use egui::{Color32, Painter, Pos2, Stroke, Ui};
use glam::Vec3;

use super::handles::{OUTER_RADIUS, RADIUS, RotateRing, TranslateHandles};
use super::limit_marks::LimitMarks;
use super::screen::{ScreenProjection, bright, circle, to_segment};
use super::twist_ring::TwistRing;
use crate::document::Target;
use crate::kinematics::skeleton::{Joint, JointId, RotationAxis};
use crate::rig::TargetReport;
use crate::session::{Grip, GripRing, PointHandle, Session};
use crate::ui::style;

/// Radius in points of the circle around a bone's tip.
const TIP: f32 = 7.0;
/// Maximum distance in points at which the mouse hits a tip.
const TIP_HIT: f32 = 10.0;
/// Radius in points of the circle around a target.
const TARGET: f32 = 9.0;
/// Maximum distance in points at which the mouse hits a target.
const TARGET_HIT: f32 = 12.0;
/// Maximum distance in points at which the mouse hits a bone.
const BONE_HIT: f32 = 8.0;
/// A circle wins over a ring if its centre is nearer to the mouse by this distance in points.
const CLEARLY: f32 = 3.0;

/// Screen positions of the rig's handles; there are none while a crowd is shown.
#[derive(Default)]
pub(in crate::ui) struct Gizmo {
    bones: Vec<ScreenBone>,
    marks: Vec<Mark>,
    /// Translation handles of the selected joint's target and its pole, or of the selected head.
    handles: Vec<JointHandles>,
    rings: Vec<RotateRing>,
    /// The limits of the selected joint, while they are shown.
    limits: LimitMarks,
    /// The ring of the twist of the selected limb.
    twist: Option<TwistRing>,
}

/// A bone on screen. `depth` is the distance of its middle from the eye along the view direction.
struct ScreenBone {
    base: Pos2,
    tip: Pos2,
    depth: f32,
    /// True if its tip can be dragged by a circle around it, which is hidden with the bones.
    has_circle: bool,
    is_selected: bool,
}

/// A variant of [`Grip`] for a handle of a joint.
type GripOfJoint = fn(JointId, PointHandle) -> Grip;

/// Translation handles of a point, with the grip of each.
struct JointHandles {
    joint: JointId,
    grip: GripOfJoint,
    handles: TranslateHandles,
}

/// The circle of a target or of a head that can be dragged.
struct Mark {
    grip: Grip,
    at: Pos2,
    enabled: bool,
    /// True for the target of the limb that the open page is about.
    is_of_page: bool,
}

impl Gizmo {
    pub fn new(screen: &ScreenProjection, session: &Session) -> Self {
        if session.crowd().is_some() {
            return Self::default();
        }
        Self {
            bones: bones(screen, session),
            marks: marks(screen, session),
            handles: handles(screen, session),
            rings: rings(screen, session),
            limits: LimitMarks::new(screen, session),
            twist: twist_ring(screen, session),
        }
    }

    /// The handle at a screen position; `None` if there is no handle. The ends of the selected
    /// joint's limits and its handles come first, then the ring of its limb's twist, other rings,
    /// targets, tips. A target or tip wins over a ring if its centre is clearly nearer.
    pub fn at(&self, mouse: Pos2) -> Option<Grip> {
        let of_twist = || self.twist.as_ref().and_then(|ring| ring.at(mouse));
        let of_joint = || self.handles.iter().find_map(|of| of.at(mouse));
        self.limits.at(mouse).or_else(of_joint).or_else(of_twist).or_else(|| {
            let circle = self.mark_at(mouse).or_else(|| self.tip_at(mouse));
            match (RotateRing::nearest(&self.rings, mouse), circle) {
                (Some((to_ring, _)), Some((to_centre, grip))) if to_centre + CLEARLY < to_ring => {
                    Some(grip)
                }
                (Some((_, ring)), _) => Some(ring),
                (None, circle) => circle.map(|(_, grip)| grip),
            }
        })
    }

    /// The target or head at a screen position, with the distance of its centre in points; `None`
    /// if there is none.
    fn mark_at(&self, mouse: Pos2) -> Option<(f32, Grip)> {
        let marks = self.marks.iter().map(|mark| (mark.at.distance(mouse), mark.grip));
        marks.into_iter().find(|(distance, _)| *distance <= TARGET_HIT)
    }

    /// The tip at a screen position, with its distance in points; `None` if there is no tip. Among
    /// several tips, it prefers one of a selected joint, then the nearest to the mouse, then the
    /// one of the joint with the highest index.
    fn tip_at(&self, mouse: Pos2) -> Option<(f32, Grip)> {
        let tips = self
            .bones
            .iter()
            .enumerate()
            .filter(|(_, bone)| bone.has_circle && bone.tip.distance(mouse) <= TIP_HIT);
        let (joint, bone) = tips.max_by(|(_, a), (_, b)| {
            let rank = |bone: &ScreenBone| (bone.is_selected, -bone.tip.distance(mouse));
            let ((a_selected, a_near), (b_selected, b_near)) = (rank(a), rank(b));
            a_selected.cmp(&b_selected).then(a_near.total_cmp(&b_near))
        })?;
        let grip = Grip::Tip(JointId::new(joint), PointHandle::Free);
        Some((bone.tip.distance(mouse), grip))
    }

    /// The joint whose bone is at a screen position; of several, the one nearest to the eye. `None`
    /// if there is no bone.
    pub fn joint_at(&self, mouse: Pos2) -> Option<JointId> {
        let hits = self
            .bones
            .iter()
            .enumerate()
            .filter(|(_, bone)| to_segment(mouse, bone.base, bone.tip) <= BONE_HIT);
        hits.min_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth)).map(|(joint, _)| joint.into())
    }

    pub fn paint(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, dragged: Option<Grip>) {
        let stand_out =
            |grip: Grip| dragged == Some(grip) || (dragged.is_none() && pointed == Some(grip));
        let faded = |grip: Grip, colour: Color32| match dragged {
            Some(dragged) if dragged != grip => colour.gamma_multiply(0.25),
            _ if stand_out(grip) => bright(colour),
            _ => colour,
        };
        let axes = style::palette(ui).axes.map(style::colour);
        for ring in &self.rings {
            let colour = match ring.grip {
                Grip::Ring(_, axis) | Grip::Orientation(_, axis) => axes[axis.index()],
                _ => continue,
            };
            ring.paint(painter, faded(ring.grip, colour), stand_out(ring.grip));
        }
        if let Some(twist) = &self.twist {
            let colour = faded(twist.grip(), style::accent(ui));
            twist.paint(painter, colour, stand_out(twist.grip()));
        }
        let strong = ui.visuals().strong_text_color();
        for mark in &self.marks {
            let colour = if mark.is_of_page { style::accent(ui) } else { strong };
            let colour = if mark.enabled { colour } else { colour.gamma_multiply(0.4) };
            circle(painter, ui, mark.at, TARGET, Stroke::new(1.5, faded(mark.grip, colour)));
        }
        for (joint, bone) in self.bones.iter().enumerate() {
            let grip = Grip::Tip(JointId::new(joint), PointHandle::Free);
            if stand_out(grip) {
                painter.circle_stroke(bone.tip, TIP, Stroke::new(2.0, bright(strong)));
            }
        }
        self.limits.paint(painter, ui, stand_out, faded);
        for of in &self.handles {
            let own = |grip: Option<Grip>| grip.and_then(|grip| of.handle(grip));
            if dragged.is_none() || own(dragged).is_some() {
                of.handles.paint(painter, ui, own(pointed), own(dragged));
            }
        }
    }
}

impl JointHandles {
    /// The grip at a screen position; `None` if there is none.
    fn at(&self, mouse: Pos2) -> Option<Grip> {
        self.handles.at(mouse).map(|handle| (self.grip)(self.joint, handle))
    }

    /// The handle of a grip; `None` if it belongs to another point.
    fn handle(&self, grip: Grip) -> Option<PointHandle> {
        let (Grip::Target(_, handle)
        | Grip::LimbPole(_, handle)
        | Grip::Aim(_, handle)
        | Grip::Head(_, handle)
        | Grip::Tip(_, handle)) = grip
        else {
            return None;
        };
        ((self.grip)(self.joint, handle) == grip).then_some(handle)
    }
}

fn bones(screen: &ScreenProjection, session: &Session) -> Vec<ScreenBone> {
    let (rig, pose) = (session.rig(), session.skeleton_pose());
    let hides_bones = session.shown().hides_bones();
    let bone = |joint: JointId| {
        let (base, tip) = (pose.base(joint), pose.tip(joint));
        let has_tip = rig.skeleton[joint].is_root_point() || rig.skeleton[joint].axis != Vec3::ZERO;
        let is_selected = session.selection().joints().contains(&joint);
        let nowhere = Pos2::new(f32::INFINITY, f32::INFINITY);
        ScreenBone {
            base: screen.place(base).unwrap_or(nowhere),
            tip: screen.place(tip).unwrap_or(nowhere),
            depth: screen.depth(base.midpoint(tip)),
            has_circle: has_tip
                && !rig.is_joint_on_path(joint, session.playback().time())
                && (is_selected || !hides_bones),
            is_selected,
        }
    };
    pose.ids().map(bone).collect()
}

fn marks(screen: &ScreenProjection, session: &Session) -> Vec<Mark> {
    let targets = targets(screen, session).into_iter();
    targets.chain(aims(screen, session)).chain(heads(screen, session)).collect()
}

/// The circles of the points at which targets aim their joints.
fn aims(screen: &ScreenProjection, session: &Session) -> Vec<Mark> {
    let pose = &session.posed().evaluated_skeleton().solved;
    let mark = |target: &Target| {
        let at = screen.place(target.aim_point_in_world(pose)?)?;
        let grip = Grip::Aim(target.joint, PointHandle::Free);
        Some(Mark { grip, at, enabled: target.is_posing(), is_of_page: false })
    };
    session.rig().targets.iter().filter_map(mark).collect()
}

fn targets(screen: &ScreenProjection, session: &Session) -> Vec<Mark> {
    let reports = &session.posed().evaluated_skeleton().targets;
    let of_page = session.limb_of_page().map(|limb| limb.target);
    let mark = |(target, report): (&Target, &TargetReport)| {
        let at = screen.place(report.position)?;
        let grip = Grip::Target(target.joint, PointHandle::Free);
        let is_of_page = of_page == Some(target.joint);
        Some(Mark { grip, at, enabled: target.enabled, is_of_page })
    };
    let rig = session.rig();
    // A figure that is one limb has handles at its target instead.
    let has_mark = |target: &Target| {
        !target.has_free_place() && (rig.sole_limb().is_none() || !target.is_posing())
    };
    let targets = rig.targets.iter().zip(reports);
    targets.filter(|(target, _)| has_mark(target)).filter_map(mark).collect()
}

/// The ring of the twist of the limb that has the selected joint, or of a figure that is one limb.
fn twist_ring(screen: &ScreenProjection, session: &Session) -> Option<TwistRing> {
    let of_limb = |joint| session.rig().limb_target_of(joint);
    let is_selected = session.selection().active().and_then(of_limb).is_some();
    let limb = session.limb().filter(|_| is_selected || session.rig().sole_limb().is_some())?;
    TwistRing::new(screen, Grip::LimbTwist(limb.target), &limb.frames, is_selected)
}

/// The circles of heads that can be dragged.
fn heads(screen: &ScreenProjection, session: &Session) -> Vec<Mark> {
    let mark = |head: JointId| {
        let at = screen.place(session.posed().evaluated_skeleton().fk.base(head))?;
        let grip = Grip::Head(head, PointHandle::Free);
        Some(Mark { grip, at, enabled: true, is_of_page: false })
    };
    Grip::draggable_heads(session.rig()).filter_map(mark).collect()
}

fn handles(screen: &ScreenProjection, session: &Session) -> Vec<JointHandles> {
    let rig = session.rig();
    // The target of a figure that is one limb has its handles at all times.
    let sole = rig.sole_limb().filter(|target| target.is_posing());
    let active = session.selection().active();
    let Some(selected) = active.or(sole.map(|target| target.joint)) else { return Vec::new() };
    let of_end = rig.target_of_end(selected).map(|index| rig.targets[index].joint);
    let target = of_end.or(sole.map(|target| target.joint));
    let report = target.and_then(|joint| session.posed().target_report(joint));
    let is_placed =
        |joint| rig.target(joint).is_some_and(|index| !rig.targets[index].has_free_place());
    let place = report.filter(|_| target.is_some_and(is_placed)).map(|report| report.position);
    let head = Grip::draggable_heads(session.rig()).find(|head| *head == selected);
    let root = is_dragged_root(session, selected).then(|| session.skeleton_pose().base(selected));
    let aim = target.and_then(|joint| rig.target(joint)).and_then(|index| {
        let pose = &session.posed().evaluated_skeleton().solved;
        rig.targets[index].aim_point_in_world(pose)
    });
    let points: [(JointId, GripOfJoint, Option<Vec3>); 5] = [
        (target.unwrap_or(selected), Grip::Target, place),
        (target.unwrap_or(selected), Grip::LimbPole, report.and_then(|report| report.pole)),
        (target.unwrap_or(selected), Grip::Aim, aim),
        (selected, Grip::Tip, root),
        (selected, Grip::Head, head.map(|head| session.posed().evaluated_skeleton().fk.base(head))),
    ];
    // Of a limb that IK alone poses, the hand is a handle, too.
    let is_full = |joint| rig.target(joint).is_some_and(|it| rig.targets[it].influence >= 1.0);
    let hand = target.filter(|joint| sole.is_some() && is_full(*joint));
    let hand = hand.map(|joint| session.posed().skeleton().tip(joint));
    let handles = |(joint, grip, point): (JointId, GripOfJoint, Option<Vec3>)| {
        let is_target = matches!(grip(joint, PointHandle::Free), Grip::Target(..));
        let handles = TranslateHandles::new(screen, point?, hand.filter(|_| is_target))?;
        Some(JointHandles { joint, grip, handles })
    };
    points.into_iter().filter_map(handles).collect()
}

/// True if a joint is a root without a bone that can be dragged; it has arrows while it is
/// selected.
fn is_dragged_root(session: &Session, joint: JointId) -> bool {
    session.skeleton().joint(joint).is_some_and(Joint::is_root_point)
        && Grip::can_drag_tip(session.posed(), joint)
}

/// The rings of the selected joint, and those of the orientation that its target holds; without a
/// selection those of a figure that is one limb and posed by FK, else none. A joint on a path has
/// none.
fn rings(screen: &ScreenProjection, session: &Session) -> Vec<RotateRing> {
    let rig = session.rig();
    let Some(joint) = session.selection().active() else {
        let by_fk = rig.sole_limb().filter(|target| !target.is_posing());
        let joints = by_fk.into_iter().flat_map(|target| rig.limb_joints(target.joint).take(2));
        let rings = joints.flat_map(|joint| RotationAxis::ALL.map(|axis| (joint, axis)));
        let ring = |(joint, axis)| {
            let ring = GripRing::of_joint(session.posed(), joint, axis)?;
            RotateRing::new(screen, Grip::Ring(joint, axis), ring, RADIUS)
        };
        return rings.filter_map(ring).collect();
    };
    let target = rig.target_of_end(joint).map(|index| rig.targets[index].joint);
    let has_arrows = is_dragged_root(session, joint) || target.is_some_and(|it| it != joint);
    let radius = if has_arrows { OUTER_RADIUS } else { RADIUS };
    let is_on_path = rig.is_joint_on_path(joint, session.playback().time());
    let own = |axis| {
        let ring = GripRing::of_joint(session.posed(), joint, axis).filter(|_| !is_on_path)?;
        RotateRing::new(screen, Grip::Ring(joint, axis), ring, radius)
    };
    let of_target = |axis| {
        let target = target?;
        let ring = GripRing::of_orientation(session.posed(), target, axis)?;
        RotateRing::new(screen, Grip::Orientation(target, axis), ring, OUTER_RADIUS)
    };
    let all = RotationAxis::ALL.into_iter();
    all.clone().filter_map(own).chain(all.filter_map(of_target)).collect()
}
