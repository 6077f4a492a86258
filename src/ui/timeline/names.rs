//! What channels are called.

use crate::document::Channel;
use crate::session::Session;
use crate::ui::controls;

/// As in "Hand" or "left_1 · rotation".
pub(in crate::ui) fn channel(session: &Session, channel: Channel) -> String {
    let of_joint = |joint: usize, what: &str| {
        let name = session.skeleton().skeleton.joint(joint).map_or("–", |joint| &joint.name);
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
            format!("{} shown", controls::describe(session.rig(), layer).0)
        }
    }
}

/// As in "1 key" or "3 keys".
pub(super) fn count_of_keys(count: usize) -> String {
    match count {
        1 => "1 key".to_owned(),
        _ => format!("{count} keys"),
    }
}
