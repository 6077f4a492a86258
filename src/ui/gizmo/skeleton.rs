//! The skeleton's grips: targets, tips of bones, and the rings that turn the selected joint.

use egui::{Color32, Painter, Pos2, Stroke, Ui};
use glam::Vec3;

use super::rotate::RotateRing;
use super::shape::{bright, to_segment};
use super::translate::TranslateHandles;
use crate::session::{Grip, Handle, Session};
use crate::ui::style;
use crate::ui::viewport::projection::ScreenProjection;

/// In points.
const TIP: f32 = 7.0;
const TIP_HIT: f32 = 10.0;
const TARGET: f32 = 9.0;
const TARGET_HIT: f32 = 12.0;
const BONE_HIT: f32 = 8.0;

/// Where the skeleton's grips are in the picture.
pub(in crate::ui) struct SkeletonGizmo {
    bones: Vec<ScreenBone>,
    targets: Vec<TargetMark>,
    /// Arrows and squares of the selected joint's target.
    handles: Option<(usize, TranslateHandles)>,
    rings: Vec<RotateRing>,
}

/// A bone on screen, and how far from the eye.
struct ScreenBone {
    base: Pos2,
    tip: Pos2,
    depth: f32,
    can_be_posed: bool,
    is_selected: bool,
}

struct TargetMark {
    joint: usize,
    at: Pos2,
    enabled: bool,
}

impl SkeletonGizmo {
    pub fn new(picture: &ScreenProjection, session: &Session) -> Self {
        Self {
            bones: bones(picture, session),
            targets: targets(picture, session),
            handles: handles(picture, session),
            rings: rings(picture, session),
        }
    }

    /// What is under a point of the screen: the selection's own handles before anything else, then
    /// targets, then tips.
    pub fn at(&self, pointer: Pos2) -> Option<Grip> {
        let of_handles = self.handles.as_ref().and_then(|(joint, handles)| {
            handles.at(pointer).map(|handle| Grip::Target(*joint, handle))
        });
        of_handles
            .or_else(|| self.target_at(pointer))
            .or_else(|| {
                RotateRing::at(&self.rings, pointer).filter(|_| self.tip_at(pointer).is_none())
            })
            .or_else(|| self.tip_at(pointer))
    }

    fn target_at(&self, pointer: Pos2) -> Option<Grip> {
        let hit = self.targets.iter().find(|target| target.at.distance(pointer) <= TARGET_HIT)?;
        Some(Grip::Target(hit.joint, Handle::Free))
    }

    /// Of tips in the same place, the one that is selected, else that of the last bone.
    fn tip_at(&self, pointer: Pos2) -> Option<Grip> {
        let tips = self
            .bones
            .iter()
            .enumerate()
            .filter(|(_, bone)| bone.can_be_posed && bone.tip.distance(pointer) <= TIP_HIT);
        let (joint, _) = tips.max_by(|(_, a), (_, b)| {
            let rank = |bone: &ScreenBone| (bone.is_selected, -bone.tip.distance(pointer));
            let ((a_selected, a_near), (b_selected, b_near)) = (rank(a), rank(b));
            a_selected.cmp(&b_selected).then(a_near.total_cmp(&b_near))
        })?;
        Some(Grip::Tip(joint, Handle::Free))
    }

    /// The joint whose bone is under a point of the screen, the nearest to the eye of several.
    pub fn joint_at(&self, pointer: Pos2) -> Option<usize> {
        let hits = self
            .bones
            .iter()
            .enumerate()
            .filter(|(_, bone)| to_segment(pointer, bone.base, bone.tip) <= BONE_HIT);
        hits.min_by(|(_, a), (_, b)| a.depth.total_cmp(&b.depth)).map(|(joint, _)| joint)
    }

    pub fn paint(&self, painter: &Painter, ui: &Ui, pointed: Option<Grip>, held: Option<Grip>) {
        let stand_out =
            |grip: Grip| held == Some(grip) || (held.is_none() && pointed == Some(grip));
        let faded = |grip: Grip, colour: Color32| match held {
            Some(held) if held != grip => colour.gamma_multiply(0.25),
            _ if stand_out(grip) => bright(colour),
            _ => colour,
        };
        let axes = style::palette(ui).axes.map(style::colour);
        for ring in &self.rings {
            let colour = match ring.grip {
                Grip::Ring(_, axis) => axes[axis],
                _ => continue,
            };
            ring.paint(painter, faded(ring.grip, colour), stand_out(ring.grip));
        }
        let strong = ui.visuals().strong_text_color();
        for target in &self.targets {
            let grip = Grip::Target(target.joint, Handle::Free);
            let colour = if target.enabled { strong } else { strong.gamma_multiply(0.4) };
            painter.circle_stroke(target.at, TARGET, Stroke::new(1.5, faded(grip, colour)));
        }
        for (joint, bone) in self.bones.iter().enumerate() {
            let grip = Grip::Tip(joint, Handle::Free);
            if stand_out(grip) {
                painter.circle_stroke(bone.tip, TIP, Stroke::new(2.0, bright(strong)));
            }
        }
        if let Some((joint, handles)) = &self.handles {
            let of_target = |grip: Option<Grip>| match grip {
                Some(Grip::Target(of, handle)) if of == *joint => Some(handle),
                _ => None,
            };
            let others_held = held.is_some() && of_target(held).is_none();
            if !others_held {
                handles.paint(painter, ui, of_target(pointed), of_target(held));
            }
        }
    }
}

fn bones(picture: &ScreenProjection, session: &Session) -> Vec<ScreenBone> {
    let (rig, pose) = (session.skeleton_rig(), session.skeleton_pose());
    let joints = rig.skeleton.joints();
    let bone = |joint: usize| {
        let (base, tip) = (pose.base(joint), pose.tip(joint));
        let is_root_point = joints[joint].parent.is_none() && joints[joint].axis == Vec3::ZERO;
        let nowhere = Pos2::new(f32::INFINITY, f32::INFINITY);
        ScreenBone {
            base: picture.place(base).unwrap_or(nowhere),
            tip: picture.place(tip).unwrap_or(nowhere),
            depth: picture.depth(base.midpoint(tip)),
            can_be_posed: rig.follow_path.is_none()
                && (is_root_point || joints[joint].axis != Vec3::ZERO),
            is_selected: session.selection().contains(&joint),
        }
    };
    (0..pose.len()).map(bone).collect()
}

fn targets(picture: &ScreenProjection, session: &Session) -> Vec<TargetMark> {
    let mark = |target: &crate::document::Target| {
        let at = picture.place(target.at(session.time()))?;
        Some(TargetMark { joint: target.joint, at, enabled: target.enabled })
    };
    session.skeleton_rig().targets.iter().filter_map(mark).collect()
}

fn handles(picture: &ScreenProjection, session: &Session) -> Option<(usize, TranslateHandles)> {
    let joint = session.selected()?;
    let target = session.skeleton_rig().targets[session.skeleton_rig().target(joint)?];
    Some((joint, TranslateHandles::new(picture, target.at(session.time()), None)?))
}

/// The rings of the selected joint, all as large on screen wherever they are.
fn rings(picture: &ScreenProjection, session: &Session) -> Vec<RotateRing> {
    let Some(joint) = session.selected().filter(|_| session.skeleton_rig().follow_path.is_none())
    else {
        return Vec::new();
    };
    let ring = |axis| RotateRing::new(picture, Grip::Ring(joint, axis), session.ring(joint, axis)?);
    (0..3).filter_map(ring).collect()
}
