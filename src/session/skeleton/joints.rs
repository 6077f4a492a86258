use glam::Vec3;

use crate::document::{Channel, Document, Overlay};
use crate::kinematics::skeleton::{
    Joint, JointId, JointLimits, JointRemap, Skeleton, SkeletonError,
};
use crate::session::outcome::{Consequence, Outcome};
use crate::session::session::Session;

/// A change of the skeleton's joints.
#[derive(Clone, Debug, PartialEq)]
pub enum JointEdit {
    /// Adds a child at the tip of a joint.
    AddChild {
        /// The joint that gets a child.
        parent: JointId,
        /// End of the new bone, in world space; `None` continues the parent's bone.
        tip: Option<Vec3>,
    },
    /// Adds a child to the selected joint; without a selection, to the joint with the highest
    /// index; without joints, to a new root.
    AddJoint {
        /// End of the new bone, in world space; `None` continues the parent's bone.
        tip: Option<Vec3>,
    },
    /// Adds a joint without a parent.
    AddRoot,
    /// Deletes joints and all their descendants.
    DeleteJoints(Vec<JointId>),
    /// Deletes joints; their children are attached to the next remaining ancestor and do not move.
    DissolveJoints(Vec<JointId>),
    /// Renames a joint. A name that another joint has is refused.
    RenameJoint {
        /// The joint.
        joint: JointId,
        /// The new name.
        name: String,
    },
    /// Attaches a joint to another parent; the joint does not move.
    ReparentJoint {
        /// The joint.
        joint: JointId,
        /// The new parent; `None` makes the joint a root.
        parent: Option<JointId>,
    },
    /// Sets the Euler angles of a joint about x, y and z in radians.
    SetRotation {
        /// The joint.
        joint: JointId,
        /// The angles.
        rotation: Vec3,
    },
    /// Sets the vector of a joint's bone, from base to tip.
    SetAxis {
        /// The joint.
        joint: JointId,
        /// The vector, in the joint's own space.
        axis: Vec3,
    },
    /// Sets the length of a joint's bone; children at its tip move with it.
    SetLength {
        /// The joint.
        joint: JointId,
        /// The length, in units of the skeleton.
        length: f32,
    },
    /// Moves a joint's base in its parent's space; a root in skeleton space.
    SetOffset {
        /// The joint.
        joint: JointId,
        /// Vector from the base of the parent.
        offset: Vec3,
    },
    /// Sets the limits of a joint's rotation.
    SetLimits {
        /// The joint.
        joint: JointId,
        /// All of its limits.
        limits: JointLimits,
    },
    /// Sets the stiffness of a joint's angles about x, y and z.
    SetStiffness {
        /// The joint.
        joint: JointId,
        /// The stiffness of each angle, from 0 to below 1.
        stiffness: Vec3,
    },
    /// Sets the factors by which a joint scales the skin along the axes of its frame.
    SetSkinScale {
        /// The joint.
        joint: JointId,
        /// The factors along x, y and z.
        scale: Vec3,
    },
    /// Locks or unlocks a joint: solvers do not turn locked joints.
    SetLocked {
        /// The joint.
        joint: JointId,
        /// True if the joint is to be locked.
        locked: bool,
    },
    /// Moves the origin of the skeleton to a point in world space.
    SetTranslation(Vec3),
    /// Turns the skeleton, in which z points up, so that y does.
    TurnYUp,
}

impl JointEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::AddChild { .. } | Self::AddJoint { .. } => "Add joint",
            Self::AddRoot => "Add root",
            Self::DeleteJoints(joints) | Self::DissolveJoints(joints) if joints.len() == 1 => {
                "Delete joint"
            }
            Self::DeleteJoints(_) | Self::DissolveJoints(_) => "Delete joints",
            Self::RenameJoint { .. } => "Rename joint",
            Self::ReparentJoint { .. } => "Re-parent joint",
            Self::SetRotation { .. } => "Turn joint",
            Self::SetAxis { .. } => "Change bone",
            Self::SetLength { .. } => "Change length",
            Self::SetOffset { .. } => "Move joint",
            Self::SetLimits { .. } => "Change limit",
            Self::SetStiffness { .. } => "Change stiffness",
            Self::SetSkinScale { .. } => "Scale skin",
            Self::SetLocked { locked: true, .. } => "Lock joint",
            Self::SetLocked { locked: false, .. } => "Unlock joint",
            Self::SetTranslation(_) => "Move skeleton",
            Self::TurnYUp => "Turn to y up",
        }
    }

    pub(in crate::session) fn apply(self, session: &mut Session) -> Outcome {
        match self {
            Self::AddChild { parent, tip } => add(session, Some(parent), tip),
            Self::AddJoint { tip } => add_next(session, tip),
            Self::AddRoot => add(session, None, None),
            Self::DeleteJoints(joints) => delete(session, &joints, Document::delete),
            Self::DissolveJoints(joints) => delete(session, &joints, Document::dissolve),
            Self::RenameJoint { joint, name } => {
                let renamed = Outcome::edit_rig(session.shown(), |rig| {
                    rig.skeleton_mut().rename(joint, name.trim())
                });
                Outcome::from(Consequence::TakeDialog).and(renamed)
            }
            Self::ReparentJoint { joint, parent } => reparent(session, joint, parent),
            Self::SetRotation { joint, rotation } => Outcome::edit_rig(session.shown(), |rig| {
                rig.skeleton_mut().set_rotation(joint, rotation)
            }),
            Self::SetAxis { joint, axis } => {
                Outcome::edit_rig(session.shown(), |rig| rig.skeleton_mut().set_axis(joint, axis))
            }
            Self::SetLength { joint, length } if length.is_finite() && length > 0.0 => {
                Outcome::change(session.shown(), |document| {
                    Channel::Length(joint).set(document, Vec3::X * length);
                })
            }
            Self::SetLength { length, .. } => Outcome::fail(format!(
                "The length of a bone must be finite and above 0, got {length}"
            )),
            Self::SetOffset { joint, offset } => {
                Outcome::edit_joint(session.shown(), joint, |joint| joint.offset = offset)
            }
            Self::SetLimits { joint, limits } => {
                Outcome::edit_joint(session.shown(), joint, |joint| joint.limits = limits)
            }
            Self::SetStiffness { joint, stiffness } => {
                Outcome::edit_joint(session.shown(), joint, |joint| joint.stiffness = stiffness)
            }
            Self::SetSkinScale { joint, scale } => {
                Outcome::edit_joint(session.shown(), joint, |joint| joint.skin.scale = scale)
            }
            Self::SetLocked { joint, locked } => {
                Outcome::edit_joint(session.shown(), joint, |joint| joint.locked = locked)
            }
            Self::SetTranslation(to) => Outcome::edit_rig(session.shown(), |rig| {
                let mut transform = rig.skeleton.transform();
                transform.translation = to.into();
                rig.skeleton_mut().set_transform(transform)
            }),
            Self::TurnYUp => turn_y_up(session),
        }
    }
}

/// Adds a child at the tip of `parent` and selects it. The child's bone ends at `tip` in world
/// space; if `tip` is `None`, it continues the parent's bone. Without a parent, adds a root without
/// a bone.
fn add(session: &Session, parent: Option<JointId>, tip: Option<Vec3>) -> Outcome {
    let added = Outcome::edit_with(session.shown(), |document| {
        // Within a skin alone, the new joint would not be seen.
        document.display = document.display.with(Overlay::Bones, true);
        let skeleton = document.rig.skeleton_mut();
        let Some(parent) = parent else {
            let name = skeleton.free_name("root");
            let root = Joint { locked: true, ..Joint::new(&name, None, Vec3::ZERO) };
            return skeleton.add(root);
        };
        let above = skeleton.joint(parent).ok_or(SkeletonError::NoJoint(parent))?.clone();
        let axis = match tip {
            Some(tip) => {
                let from_world = skeleton.full_transform(parent).inverse();
                from_world.transform_point3(tip) - above.axis
            }
            None => skeleton.next_axis(parent),
        };
        let joint = Joint::new(&skeleton.free_name("joint"), Some(parent), axis);
        let radius = radius_of_next(skeleton, parent, joint.radius);
        skeleton.add(Joint { offset: above.axis, radius, ..joint })
    });
    match added {
        Ok((written, joint)) => written.and(Consequence::Select(vec![joint])),
        Err(refused) => refused,
    }
}

/// Adds a child to the selected joint; without a selection, to the joint with the highest index;
/// without joints, to a new root.
fn add_next(session: &mut Session, tip: Option<Vec3>) -> Outcome {
    if next_parent(session).is_none() {
        let root = add(session, None, None);
        session.act(root);
    }
    match next_parent(session) {
        Some(parent) => add(session, Some(parent), tip).and(Consequence::KeepInView),
        None => Outcome::default(),
    }
}

/// Deletes joints by `delete` and selects the last of their parents that remains.
fn delete(
    session: &Session,
    joints: &[JointId],
    delete: fn(&mut Document, &[JointId]) -> Result<JointRemap, SkeletonError>,
) -> Outcome {
    let closed = Outcome::from(Consequence::TakeDialog);
    let deleted = Outcome::edit_with(session.shown(), |document| delete(document, joints));
    let (written, moved) = match deleted {
        Ok(deleted) => deleted,
        Err(refused) => return closed.and(refused),
    };
    let parents = joints.iter().rev().filter_map(|joint| session.skeleton().joint(*joint)?.parent);
    let left = parents.into_iter().find_map(|parent| moved.get(parent));
    let keys = session.selection().in_timeline();
    closed
        .and(written)
        .and(Consequence::RemapKeys(Box::new(moved), keys))
        .and(Consequence::Select(left.into_iter().collect()))
}

fn reparent(session: &Session, joint: JointId, parent: Option<JointId>) -> Outcome {
    let changed = Outcome::edit_with(session.shown(), |document| {
        let moved = document.skeleton_mut().reparent(joint, parent)?;
        document.remap_joints(&moved);
        Ok::<_, SkeletonError>(moved)
    });
    let (written, moved) = match changed {
        Ok(changed) => changed,
        Err(refused) => return refused,
    };
    let hovered = session.selection().hovered().and_then(|joint| moved.get(joint));
    let selected =
        session.selection().joints().iter().filter_map(|joint| moved.get(*joint)).collect();
    let keys = session.selection().in_timeline();
    written
        .and(Consequence::RemapKeys(Box::new(moved), keys))
        .and(Consequence::Hover(hovered))
        .and(Consequence::Select(selected))
}

/// Turns the skeleton so that y points up in place of z, and frames it. Other animations of its
/// file will be turned, too.
fn turn_y_up(session: &mut Session) -> Outcome {
    session.act(Outcome::from(Consequence::DiscardUnkeyed).and(Consequence::Refresh));
    Outcome::change(session.shown(), Document::turn_y_up)
        .and(Consequence::TakeZAsUp)
        .and(Consequence::FrameAll)
}

/// Resets all angles of the joints.
pub(in crate::session) fn bind_pose(session: &Session) -> Outcome {
    Outcome::edit_rig(session.shown(), |rig| {
        let mut joints = rig.skeleton.ids();
        joints.try_for_each(|joint| rig.skeleton_mut().set_rotation(joint, Vec3::ZERO))
    })
}

fn next_parent(session: &Session) -> Option<JointId> {
    session.selection().active().or(session.skeleton_pose().ids().next_back())
}

impl JointEdit {
    /// Base of the next joint that would be added, in world space.
    pub fn next_base(session: &Session) -> Vec3 {
        let origin = session.skeleton().transform().translation.into();
        next_parent(session).map_or(origin, |parent| session.skeleton_pose().tip(parent))
    }
}

/// Radius of a new child of `parent`: nine tenths of the largest radius of `parent` and its
/// ancestors, so that the bones of a skeleton are about equally thick, but at most 2.5 times `own`,
/// the default radius for the child's length.
fn radius_of_next(skeleton: &Skeleton, parent: JointId, own: f32) -> f32 {
    const TAPER: f32 = 0.9;
    const THICKEST: f32 = 2.5;
    let above = skeleton.ancestors(parent).filter_map(|joint| skeleton.joint(joint));
    let thickest = above.map(|joint| joint.radius).fold(0.0, f32::max);
    if thickest > 0.0 && own > 0.0 { (TAPER * thickest).min(THICKEST * own) } else { own }
}
