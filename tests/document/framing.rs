//! Cameras that frame a rig: they see its whole motion, and follow it.

use glam::Vec3;
use ik_arm::document::{Camera, Channel, Document, Projection, SkeletonRig, Timeline};
use ik_arm::io::{self, OpenOptions};
use ik_arm::kinematics::skeleton::{JointId, SkeletonPose};

use crate::common::{Random, skeletons};

/// A tree whose root walks along random corners, up to ten times its size away.
fn walk(random: &mut Random) -> Document {
    let (skeleton, _) = skeletons::tree(random, 3, 1.0);
    let rig = SkeletonRig::new(skeleton);
    let reach = rig.reach();
    let mut document = Document::new(rig);
    let seconds = random.within(1.0..200.0);
    document.timeline = Timeline { start: -1.0, end: f64::from(seconds), frame_rate: 29.97 };
    for corner in 0..5 {
        let time = document.timeline.start + document.timeline.duration() * f64::from(corner) / 4.0;
        document.keys.insert(Channel::Translation, time, random.vector(10.0 * reach));
        let joint = random.below(document.skeleton().joints().len());
        document.keys.insert(Channel::Rotation(JointId::new(joint)), time, random.angles());
    }
    document
}

fn pose_at(document: &Document, time: f64) -> SkeletonPose {
    document.at(time).skeleton().pose()
}

fn is_seen(projection: &Projection, point: Vec3) -> bool {
    projection.project(point).is_some_and(|at| at.abs().max_element() <= 1.0)
}

#[test]
fn the_camera_of_a_rig_sees_it_in_every_frame() {
    let mut random = Random(41);
    for _ in 0..60 {
        let document = walk(&mut random);
        let projection = document.framing_camera().projection(1.0);
        let timeline = document.timeline;
        for frame in 0..timeline.frames() {
            let pose = pose_at(&document, timeline.time(frame));
            assert!(pose.points().all(|point| is_seen(&projection, point)), "frame {frame}");
        }
    }
}

#[test]
fn a_still_rig_fills_the_picture_as_before() {
    let mut random = Random(42);
    for _ in 0..40 {
        let (skeleton, _) = skeletons::tree(&mut random, 3, 1.0);
        let rig = SkeletonRig::new(skeleton);
        let bounds = rig.bounds(&rig.skeleton.pose(), 0.0);
        let document = Document::new(rig);
        assert_eq!(document.motion_bounds(), bounds);
        let (centre, radius) = bounds;
        assert_eq!(document.framing_camera(), Camera::default().framing(centre, radius, 1.0));
    }
}

#[test]
fn a_figure_of_a_bvh_file_that_walks_away_stays_in_the_picture() {
    let rows: String = (0..300).map(|frame| format!("{} 90 0 0 0 0\n", 6 * frame)).collect();
    let text = format!(
        "HIERARCHY\nROOT hip\n{{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation \
         Xrotation Yrotation\nEnd Site\n{{\nOFFSET 0 90 0\n}}\n}}\nMOTION\nFrames: 300\nFrame Time: \
         0.0333333\n{rows}"
    );
    let document = io::parse("walk.bvh", &text, &OpenOptions::default()).expect("opens").document;
    let projection = document.camera.projection(1.6);
    for frame in [0, 150, 299] {
        let pose = pose_at(&document, document.timeline.time(frame));
        assert!(pose.points().all(|point| is_seen(&projection, point)), "frame {frame}");
    }
}

#[cfg(feature = "app")]
mod following {
    use super::{Random, is_seen, walk};
    use ik_arm::document::{Channel, Document};
    use ik_arm::kinematics::skeleton::JointId;
    use ik_arm::session::{
        CameraMotion, JointEdit, PlaybackAction, SelectAction, Session, ViewAction,
    };

    /// The session with its camera at rest and close to the selection, which it follows.
    fn follower(document: &Document, joints: &[JointId]) -> Session {
        let mut session = Session::with_document(Default::default(), document.clone());
        session.apply(SelectAction::Joints(joints.to_vec()));
        session.apply(ViewAction::FollowSelection(true));
        session.apply(PlaybackAction::Advance(0.0));
        session.apply(PlaybackAction::Advance(1.0));
        assert!(!session.view().is_gliding());
        session
    }

    #[test]
    fn the_followed_joint_stays_where_it_is_in_the_picture() {
        let mut random = Random(43);
        for _ in 0..40 {
            let document = walk(&mut random);
            let joint = JointId::new(random.below(document.skeleton().joints().len()));
            let mut session = follower(&document, &[joint]);
            let before = session.skeleton_pose().base(joint) - session.camera().target;
            let size = session.rig().reach();
            assert!(before.length() < 1e-4 * size, "it starts in the middle");
            let near = session.camera().zoomed(0.05, glam::Vec2::ZERO, 1.6);
            session.apply(ViewAction::SetCamera(near));
            for _ in 0..50 {
                let part = f64::from(random.within(0.0..1.0));
                let time = document.timeline.start + part * document.timeline.duration();
                session.apply(PlaybackAction::SetTime(time));
                let base = session.skeleton_pose().base(joint);
                assert!(base.distance(session.camera().target) < 1e-3 * size);
                assert!(is_seen(&session.camera().projection(1.6), base));
            }
        }
    }

    #[test]
    fn it_moves_only_with_the_time_and_keeps_what_the_mouse_does_meanwhile() {
        let mut random = Random(44);
        let document = walk(&mut random);
        let mut session = follower(&document, &[]);
        let still = *session.camera();
        session.apply(JointEdit::SetTranslation(glam::Vec3::ONE));
        assert_eq!(*session.camera(), still, "an edit does not move the camera");

        let orbit = ViewAction::Grab(CameraMotion::Orbit, glam::Vec2::ZERO);
        session.apply(orbit);
        session.apply(PlaybackAction::SetTime(document.timeline.end));
        let target = session.camera().target;
        assert_ne!(target, still.target);
        let to = glam::Vec2::new(0.3, 0.1);
        session.apply(ViewAction::Drag { to, aspect: 1.6 });
        assert_eq!(session.camera().target, target, "the orbit goes on around the new place");

        session.apply(ViewAction::Drop);
        session.apply(ViewAction::FollowSelection(false));
        session.apply(PlaybackAction::SetTime(document.timeline.start));
        assert_eq!(session.camera().target, target);
        assert!(document.keys.has(Channel::Translation));
    }
}
