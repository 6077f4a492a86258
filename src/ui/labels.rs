//! What channels are called.

use crate::document::{Channel, Overlay, RigKind, TwistReferenceKind};
use crate::kinematics::chain_ik::Method;
use crate::session::Session;

/// As in "Hand" or "left_1 · rotation".
pub(in crate::ui) fn channel(session: &Session, channel: Channel) -> String {
    let of_joint = |joint: usize, what: &str| {
        let name = session.skeleton().joint(joint).map_or("–", |joint| &joint.name);
        format!("{name} · {what}")
    };
    match channel {
        Channel::Hand => "Hand".to_owned(),
        Channel::Twist => "Elbow spin".to_owned(),
        Channel::Pin => "Hand, pinned".to_owned(),
        Channel::Pole => "Pole".to_owned(),
        Channel::Influence => "IK weight".to_owned(),
        Channel::Shoulder => "Shoulder angles".to_owned(),
        Channel::Bend => "Elbow bend".to_owned(),
        Channel::Stretch => "Stretch of the angles' limbs".to_owned(),
        Channel::Wrist => "Hand angles".to_owned(),
        Channel::Root => "Shoulder".to_owned(),
        Channel::Upper => "Upper length".to_owned(),
        Channel::Lower => "Lower length".to_owned(),
        Channel::Translation => "Skeleton".to_owned(),
        Channel::Rotation(joint) => of_joint(joint, "rotation"),
        Channel::Offset(joint) => of_joint(joint, "offset"),
        Channel::Target(joint) => of_joint(joint, "target"),
        Channel::Enabled(joint) => of_joint(joint, "target on"),
        Channel::Overlay(layer) => {
            format!("{} shown", overlay(session.rig(), layer).0)
        }
    }
}

/// As in "1 key" or "3 keys".
pub(in crate::ui) fn count_of_keys(count: usize) -> String {
    match count {
        1 => "1 key".to_owned(),
        _ => format!("{count} keys"),
    }
}

/// What a layer is called, and what it is.
pub(in crate::ui) fn overlay(rig: RigKind, layer: Overlay) -> (&'static str, &'static str) {
    match (rig, layer) {
        (RigKind::Skeleton, Overlay::Cursor) => {
            ("Targets", "Where tips are asked to be, with their ways and the gaps to them")
        }
        (RigKind::Skeleton, Overlay::Pointer) => ("Path", "The way that the head goes"),
        (RigKind::Arm, Overlay::Trail) => {
            ("Trail", "The way of the hand, with a dot for every frame")
        }
        (RigKind::Skeleton, Overlay::Trail) => {
            ("Trail", "The way of the selected joint's tip, with a dot for every frame")
        }
        (_, Overlay::OnionSkins) => {
            ("Onion skins", "The rig as it stands 5, 10 and 15 frames before and after")
        }
        (RigKind::Skeleton, Overlay::Labels) => ("Labels", "Names of the selected joints"),
        (RigKind::Arm, Overlay::Cursor) => {
            ("Cursor", "A small sphere where the hand is asked to be")
        }
        (RigKind::Arm, Overlay::Pointer) => (
            "Pointer",
            "The axis from the Root through the hand to the Cursor, as long as the whole arm",
        ),
        (_, Overlay::InnerLimit) => (
            "Inner limit",
            "The sphere that the hand cannot enter: its radius is the difference of the lengths",
        ),
        (_, Overlay::OuterLimit) => (
            "Outer limit",
            "The sphere that the hand cannot leave: its radius is the sum of the lengths",
        ),
        (_, Overlay::Hand) => {
            ("Hand", "A hand at the wrist, and stripes that show the forearm's roll")
        }
        (_, Overlay::Globe) => (
            "Singularity globe",
            "The outer limit, hot where a small move of the hand turns the elbow far",
        ),
        (_, Overlay::References) => (
            "Four references",
            "The elbow as each reference would have it, with how far apart they are",
        ),
        (_, Overlay::GridXy) => ("XY grid", "The grid in which z is 0"),
        (_, Overlay::GridXz) => ("XZ grid", "The grid in which y is 0"),
        (_, Overlay::GridYz) => ("YZ grid", "The grid in which x is 0"),
        (_, Overlay::Ground) => ("Ground", "A floor at y = 0"),
        (_, Overlay::Axes) => ("Axes", "Arrows along the world's x, y and z"),
        (RigKind::Arm, Overlay::Labels) => ("Labels", "Names at root, elbow and hand"),
        (_, Overlay::Shadow) => ("Shadow", "Soft on the floor: the higher the rig, the softer"),
    }
}

/// What a reference is.
pub(in crate::ui) fn twist_reference(twist_reference: TwistReferenceKind) -> &'static str {
    match twist_reference {
        TwistReferenceKind::Limb => {
            "Up, as far as the Pointer lets it, as in the paper. The elbow turns around where the \
             hand passes straight above or below the shoulder"
        }
        TwistReferenceKind::Pole => {
            "Towards a point, as most programs have it. The elbow turns around where the hand \
             passes between the shoulder and the pole, or behind"
        }
        TwistReferenceKind::Stereographic => {
            "As on a map of all directions that leaves out one, straight behind: smooth everywhere \
             else"
        }
        TwistReferenceKind::Transport => {
            "Carried along with the hand: never turns around, but a hand that goes in a circle and \
             comes back finds the elbow elsewhere. Made for posing; keys are measured from the map"
        }
    }
}

/// As panels and pictures call a solver.
pub(in crate::ui) fn method(method: Method) -> &'static str {
    match method {
        Method::TransposeFixed => "Jacobian transpose, fixed step",
        Method::Transpose => "Jacobian transpose",
        Method::DampedLeastSquares => "Damped least squares",
        Method::Ccd => "Cyclic coordinate descent",
        Method::Fabrik => "FABRIK",
        Method::TwoBone => "Two-bone",
    }
}

/// What a solver does, and what it is good and bad at.
pub(in crate::ui) fn method_tooltip(method: Method) -> &'static str {
    match method {
        Method::TransposeFixed => {
            "Gradient descent: every angle goes down the slope of the squared distance, by a step \
             of one length throughout. Slow, but never leaps"
        }
        Method::Transpose => {
            "Gradient descent whose step is searched for: doubled while it helps, halved when it \
             does not. Slow at the end"
        }
        Method::DampedLeastSquares => {
            "Least squares on the Jacobian, damped so that it stays calm near a straight chain. Few \
             iterations, good with limits and many targets"
        }
        Method::Ccd => {
            "One joint after the other, from the tip to the root, each turned to bring the tip \
             nearest. Cheap; bends the tip more than the root"
        }
        Method::Fabrik => {
            "Pulls points from the target to the root and back. Very few, very cheap iterations; \
             may stop short where limits are in the way"
        }
        Method::TwoBone => {
            "The closed form of the arm, for a target's joint and its parent: one iteration, and no \
             other joint moves"
        }
    }
}
