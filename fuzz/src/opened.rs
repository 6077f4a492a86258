use std::collections::HashSet;

use ik_arm::document::Document;
use ik_arm::io::{self, OpenOptions, Opened, Upwards};
use ik_arm::kinematics::skeleton::{JointId, Skeleton};
use ik_arm::kinematics::skin::Skinning;
use ik_arm::rig::SkinSource;

/// Checks the content of a file, or that its error is readable.
pub fn opened(bytes: &[u8], options: &OpenOptions) -> Option<Opened> {
    match io::read("file", bytes, options) {
        Ok(opened) => {
            check(&opened);
            Some(opened)
        }
        Err(error) => {
            is_readable(&error.to_string());
            None
        }
    }
}

/// Every skeleton and every animation of a file.
pub fn every_skeleton(bytes: &[u8]) {
    const ENOUGH: usize = 4;
    if let Some(first) = opened(bytes, &OpenOptions::default()) {
        for name in first.skeletons.iter().take(ENOUGH) {
            opened(bytes, &OpenOptions::of_skeleton(name));
        }
        for animation in first.animations.iter().skip(1).take(ENOUGH) {
            opened(bytes, &OpenOptions::of_animation(&animation.name));
        }
        turned(bytes);
    }
}

/// The file with z up.
pub fn turned(bytes: &[u8]) {
    opened(bytes, &OpenOptions::of_up(Upwards::Z));
}

/// The message is not empty and fits a window.
pub fn is_readable(message: &str) {
    assert!((1..1000).contains(&message.chars().count()), "{message}");
}

fn check(opened: &Opened) {
    let Opened { document, warnings, order, skeletons, skeleton, animations, animation } = opened;
    assert!(skeleton.is_none_or(|skeleton| skeleton < skeletons.len()));
    assert!(animation.is_none_or(|animation| animation < animations.len()));
    warnings.iter().for_each(|warning| is_readable(&warning.to_string()));
    let names: HashSet<_> = skeletons.iter().collect();
    assert_eq!(names.len(), skeletons.len(), "{skeletons:?}");

    check_skeleton(document, order);
    check_skin(document);
    check_poses(document);
    is_read_as_it_is_written(document);
}

fn check_skeleton(document: &Document, order: &[JointId]) {
    let rig = &document.rig;
    let joints: Vec<_> = rig.skeleton.iter().map(|(_, joint)| joint.clone()).collect();
    assert!(order.iter().all(|joint| joint.index() < joints.len()), "{order:?}");
    let mut again = Skeleton::from_joints(joints.clone()).expect("one that can be");
    again.set_transform(rig.skeleton.transform()).expect("one that can be");
    assert_eq!(again, *rig.skeleton);

    let aimed: HashSet<_> = rig.targets.iter().map(|target| target.joint).collect();
    assert_eq!(aimed.len(), rig.targets.len());
    assert!(aimed.into_iter().all(|joint| joint.index() < joints.len()));
}

/// The vertices of a skin follow joints of the skeleton with the sum 1, in every pose.
fn check_skin(document: &Document) {
    let rig = &document.rig;
    let Some(skin) = &rig.skin else { return };
    // A mesh from bones takes too long for a fuzzer.
    let SkinSource::Mesh(skin) = &skin.source else { return };
    let Ok(attached) = skin.mesh() else { return };
    let mesh = &attached.mesh;
    let joints = rig.skeleton.joints().len().max(1);
    for weights in mesh.weights() {
        let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
        assert!((sum - 1.0).abs() < 1e-4, "{weights:?}");
        assert!(weights.iter().all(|(joint, _)| joint.index() < joints), "{weights:?}");
    }
    let listed: usize = attached.parts.iter().map(|part| part.triangles).sum();
    assert!(listed >= mesh.mesh().triangles.len());
    for skinning in Skinning::ALL {
        let posed = mesh.posed(&mesh.pose(&rig.skeleton), skinning);
        assert_eq!(posed.positions.len(), mesh.weights().len());
    }
}

fn check_poses(document: &Document) {
    let timeline = document.timeline;
    assert!(timeline.is_valid(), "{timeline:?}");
    for time in [-1.0, 0.0, 0.3, 1e9, timeline.start, timeline.end] {
        let at = document.at(time);
        let rig = &at.document().rig;
        for target in &rig.targets {
            if let Some(limb) = at.limb_frames(target.joint) {
                let pose = limb.pose();
                assert!(pose.elbow.is_finite() && pose.hand.is_finite(), "{pose:?} at {time}");
            }
        }
        let skeleton = rig.skeleton_at(time);
        let of_rig = rig.bounds(&skeleton.pose(), time);
        for (centre, radius) in [at.bounds(), of_rig] {
            assert!(centre.is_finite() && radius.is_finite(), "{centre} ± {radius} at {time}");
        }
        for joint in skeleton.joints() {
            assert!(joint.rotation.is_finite() && joint.offset.is_finite(), "{joint:?} at {time}");
            assert_eq!(joint.limits.project(joint.rotation), joint.rotation, "{joint:?} at {time}");
        }
    }
}

/// Numbers that are not finite could not be written.
fn is_read_as_it_is_written(document: &Document) {
    let json = io::to_json(document).expect("every document can be written");
    let again =
        io::parse("again", &json, &io::OpenOptions::default()).expect("what was written is read");
    assert_eq!(again.document, *document);
    assert_eq!(again.warnings, []);
    // Equal numbers may differ in the sign of 0; their texts do not.
    assert_eq!(io::to_json(&again.document).expect("written"), json);
}
