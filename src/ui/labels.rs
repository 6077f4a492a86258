//! Names and tooltips of channels, overlays, twist references and solvers.

use crate::document::{Channel, Overlay, PathKind, Target, TwistReferenceKind};
use crate::kinematics::skeleton::{Extreme, JointId, LimitEnd, SwingAxis};
use crate::session::{Grip, Session};
use crate::ui::widgets::text;

/// Name of the part that a grip moves, such as "pelvis", "the limb of left_hand" or
/// "the target of left_hand"; empty for other grips.
pub(in crate::ui) fn grip(session: &Session, grip: Grip) -> String {
    let rig = session.rig();
    let name = |joint: JointId| rig.skeleton.joint(joint).map_or("–", |joint| &joint.name);
    let end = |target: Option<&Target>| target.map_or("–", |target| name(rig.end_of(target)));
    let of_joint = |joint: JointId| end(rig.target(joint).map(|index| &rig.targets[index]));
    match grip {
        Grip::Tip(joint, _) if Grip::turns_elbow(session.posed(), joint) => {
            format!("the limb of {}", end(rig.target_that_turns(joint)))
        }
        Grip::Bone(joint) if let Some(target) = Grip::turned_limb(session.posed(), joint) => {
            format!("the limb of {}", end(Some(target)))
        }
        Grip::Tip(joint, _) | Grip::Bone(joint) | Grip::Ring(joint, _) => name(joint).to_owned(),
        Grip::Target(joint, _) => format!("the target of {}", of_joint(joint)),
        Grip::Orientation(joint, _) => of_joint(joint).to_owned(),
        Grip::Limit(joint, end) => format!("the {} of {}", limit_end(end), name(joint)),
        Grip::Aim(joint, _) => format!("the aim of {}", of_joint(joint)),
        Grip::LimbTwist(joint) => format!("the limb of {}", of_joint(joint)),
        _ => String::new(),
    }
}

/// Name of an end of a joint's limits, such as "least angle about x".
pub(in crate::ui) fn limit_end(end: LimitEnd) -> String {
    let extreme = |extreme| match extreme {
        Extreme::Least => "least",
        Extreme::Greatest => "greatest",
    };
    match end {
        LimitEnd::Range(axis, of) => format!("{} angle about {axis}", extreme(of)),
        LimitEnd::Swing(SwingAxis::X, _) => "greatest swing about x".to_owned(),
        LimitEnd::Swing(SwingAxis::Z, _) => "greatest swing about z".to_owned(),
        LimitEnd::Twist(of) => format!("{} twist", extreme(of)),
    }
}

/// Name of a channel, such as "Hand" or "left_1 · rotation". Channels of a target have the name of
/// the joint that the target is named after.
pub(in crate::ui) fn channel(session: &Session, channel: Channel) -> String {
    if let Some(name) = morph_name(session, channel) {
        return name.to_owned();
    }
    let name = channel_of_joint(channel);
    match session.document().joint_of(channel) {
        Some(joint) => {
            let joint = session.rig().skeleton.joint(joint);
            format!("{} · {name}", joint.map_or("–", |joint| &joint.name))
        }
        None => name,
    }
}

/// Name of the morph target that a channel is the weight of; `None` for another channel.
fn morph_name(session: &Session, channel: Channel) -> Option<&str> {
    let Channel::Morph(morph) = channel else { return None };
    let mesh = session.rig().skin.as_ref()?.mesh_skin()?.in_file()?;
    Some(&mesh.mesh.morphs().get(usize::from(morph))?.name)
}

/// Name of a channel beside that of its joint, such as "rotation".
pub(in crate::ui) fn channel_of_joint(channel: Channel) -> String {
    let label = channel.label();
    match channel {
        Channel::Overlay(shown) => format!("{} {label}", overlay(shown).0),
        Channel::Morph(morph) => format!("{label} {morph}"),
        _ => label.to_owned(),
    }
}

/// The same in a list of channels of one joint, with a capital: the target of a figure that is one limb
/// is called *Hand* as beside its sliders.
pub(in crate::ui) fn channel_alone(session: &Session, channel: Channel) -> String {
    match channel {
        Channel::Target(_) if session.rig().sole_limb().is_some() => "Hand".to_owned(),
        _ => text::capitalized(&channel_of_joint(channel)),
    }
}

/// Name and sign of the unit of lengths, in a document with these metres in a unit.
pub(in crate::ui) fn unit_of_length(metres_per_unit: f32) -> (&'static str, &'static str) {
    match metres_per_unit {
        1.0 => ("metres", "m"),
        0.01 => ("centimetres", "cm"),
        0.001 => ("millimetres", "mm"),
        _ => ("units of the scene", "units"),
    }
}

/// Formats a number of keys, such as "1 key" or "3 keys".
pub(in crate::ui) fn count_of_keys(count: usize) -> String {
    match count {
        1 => "1 key".to_owned(),
        _ => format!("{count} keys"),
    }
}

/// Name and tooltip of an overlay.
pub(in crate::ui) fn overlay(overlay: Overlay) -> (&'static str, &'static str) {
    match overlay {
        Overlay::Cursor => ("Cursor", "Show the targets of hands and feet, and the gaps to them"),
        Overlay::Pointer => ("Pointer", "Show the axis from the shoulder through hand and Cursor"),
        Overlay::Trail => {
            ("Trail", "Show the path of the hand or the selected tip, one dot a frame")
        }
        Overlay::Paths => ("Paths", "Show the paths that heads follow"),
        Overlay::Cylinders => ("Cylinders", "Draw limbs as tapered cylinders instead of bones"),
        Overlay::Labels => ("Labels", "Show names and numbers in the view"),
        Overlay::OnionSkins => ("Onion skins", "Show the rig 10 and 20 frames before and after"),
        Overlay::InnerLimit => ("Inner limit", "Show the sphere that the hand cannot enter"),
        Overlay::OuterLimit => ("Outer limit", "Show the sphere that the hand cannot leave"),
        Overlay::ElbowCircle => ("Elbow circle", "Show all places where the elbow could be"),
        Overlay::FkPose => {
            ("FK pose", "Show the pose of the joint angles alone; shown anyway while blended")
        }
        Overlay::ByItself => (
            "Frame by itself",
            "Show the pose that this frame would have without the frames before it",
        ),
        Overlay::Skin => ("Skin", "Show the skin"),
        Overlay::Bones => ("Bones", "Show the bones through the skin"),
        Overlay::Wireframe => ("Wireframe", "Show the edges of the skin's triangles"),
        Overlay::SkinWeights => ("Weights", "Colour the skin by the weights of the selected joint"),
        Overlay::Stiffness => ("Stiffness", "Colour the bones by the stiffness of their joints"),
        Overlay::Balance => {
            ("Balance", "Show the centre of mass above the ground and what the figure stands on")
        }
        Overlay::JointLimits => (
            "Joint limits",
            "Show how far the limits let the selected joint turn, and drag their ends",
        ),
        Overlay::ReachRegion => {
            ("Reach region", "Show where the target of the selected joint can be reached")
        }
        Overlay::CompareSkinning => {
            ("Compare", "Show the skin three times, once for each way of blending")
        }
        Overlay::Hand => ("Hand", "Show the hand; the forearm winds as it rolls"),
        Overlay::Frames => ("Frames", "Show the axes of Root, Limb and Socket"),
        Overlay::SingularityGlobe => {
            ("Globe", "Colour the outer limit by how fast the elbow turns")
        }
        Overlay::TwistReferences => {
            ("Twist references", "Show the limb with each of the other twist references")
        }
        Overlay::GridXy => ("XY grid", "Show the grid at z = 0"),
        Overlay::GridXz => ("XZ grid", "Show the grid at y = 0"),
        Overlay::GridYz => ("YZ grid", "Show the grid at x = 0"),
        Overlay::Ground => ("Ground", "Show a floor at y = 0"),
        Overlay::Axes => ("Axes", "Show rods along world x, y and z"),
        Overlay::Shadow => ("Shadow", "Show a soft shadow on the floor"),
    }
}

/// Tooltip of a twist reference.
pub(in crate::ui) fn twist_reference(twist_reference: TwistReferenceKind) -> &'static str {
    match twist_reference {
        TwistReferenceKind::Up => "Measure from straight up; flips above and below the shoulder",
        TwistReferenceKind::Pole => {
            "Measure from the Pole; flips where the Pointer passes through it"
        }
        TwistReferenceKind::Stereographic => {
            "Measure from a map of all directions; flips only at −x"
        }
        TwistReferenceKind::Transport => "Transport along the hand's path; never flips",
        TwistReferenceKind::Fk => {
            "Measure from the elbow of the FK pose; flips opposite to its Pointer"
        }
    }
}

/// The reason why a joint's own angles do not pose it; `None` if they do.
pub fn why_on_path(session: &Session, joint: JointId) -> Option<&'static str> {
    let rig = session.rig();
    let reason = match rig.path_kind(rig.root_of(joint)?)? {
        PathKind::Ring(_) => "The joints follow a ring; set Path → Follow to None",
        PathKind::Head => {
            "The joints follow the head; go to its first key, or set Path → Follow to None"
        }
        PathKind::Target => "The joints follow a target; set Path → Follow to None",
    };
    rig.is_joint_on_path(joint, session.playback().time()).then_some(reason)
}
