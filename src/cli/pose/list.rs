//! `ik-arm pose FILE --list`: what a file has.

use serde::Serialize;

use crate::document::{Channel, Document};
use crate::io::{FileAnimation, Opened};

/// The skeletons, animations and targets of a file.
#[derive(Serialize)]
pub struct FileList {
    skeletons: Vec<ListedSkeleton>,
    animations: Vec<ListedAnimation>,
    targets: Vec<String>,
}

#[derive(Serialize)]
struct ListedSkeleton {
    name: String,
    /// Number of joints of the open skeleton; `None` for the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    joints: Option<usize>,
}

#[derive(Serialize)]
struct ListedAnimation {
    name: String,
    /// First and last time in seconds.
    start: f64,
    end: f64,
    moving_joints: usize,
    /// True if it is the open one.
    open: bool,
}

impl FileList {
    pub fn new(opened: &Opened, skeleton: Option<&str>) -> Self {
        let document = &opened.document;
        let rig = &document.skeleton_rig;
        let names = match &opened.skeletons[..] {
            [] => vec!["skeleton".to_owned()],
            names => names.to_vec(),
        };
        let open = skeleton.unwrap_or(names.first().map_or("", String::as_str)).to_owned();
        let joints = |name: &String| (*name == open).then(|| rig.skeleton.joints().len());
        let animations = match (&opened.animations[..], document.is_animated()) {
            ([], true) => vec![own_motion(document)],
            (animations, _) => animations.to_vec(),
        };
        let is_open = |index| opened.animation.is_none_or(|animation| animation == index);
        let listed = |(index, animation): (usize, FileAnimation)| {
            let FileAnimation { name, start, end, moving_joints } = animation;
            ListedAnimation { name, start, end, moving_joints, open: is_open(index) }
        };
        let target = |target| {
            let joint = rig.skeleton.joint(rig.end_of(target));
            joint.map_or_else(String::new, |joint| joint.name.clone())
        };
        Self {
            skeletons: names
                .iter()
                .map(|name| ListedSkeleton { name: name.clone(), joints: joints(name) })
                .collect(),
            animations: animations.into_iter().enumerate().map(listed).collect(),
            targets: rig.targets.iter().map(target).collect(),
        }
    }
}

/// The motion of a format whose files have one motion without a name.
fn own_motion(document: &Document) -> FileAnimation {
    let keys = &document.keys;
    let moves = |joint| keys.has(Channel::Rotation(joint)) || keys.has(Channel::Offset(joint));
    FileAnimation {
        name: "motion".to_owned(),
        start: document.timeline.start,
        end: document.timeline.end,
        moving_joints: document.skeleton().ids().filter(|joint| moves(*joint)).count(),
    }
}
