//! CSV tables: positions of all joints, a row for each frame.

use crate::common::arm::{ArmDocument, channels};
use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig, Timeline};
use ik_arm::io::{self, MotionError, Progress};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use pollster::block_on;

fn table(document: &Document, fps: Option<f64>) -> String {
    let exported =
        block_on(io::to_csv(document, fps, &Progress::default())).expect("it is written");
    assert_eq!(exported.notes, Vec::<String>::new());
    String::from_utf8(exported.bytes).expect("UTF-8")
}

#[test]
fn a_small_skeleton_is_written_as_this_table() {
    let mut skeleton = Skeleton::with_root("hip, \"left\"");
    let thigh = Joint { offset: Vec3::X, ..Joint::new("thigh", Some(JointId::new(0)), Vec3::Y) };
    skeleton.add(thigh).expect("joint");
    skeleton.add(Joint::new("point", Some(JointId::new(0)), Vec3::ZERO)).expect("joint");
    let rig = SkeletonRig::new(skeleton);
    let mut document = Document::new(rig);
    document.timeline = Timeline { start: -1.0, end: 0.0, frame_rate: 2.0 };
    document.keys.insert(Channel::Translation, -1.0, Vec3::ZERO);
    document.keys.insert(Channel::Translation, 0.0, Vec3::new(0.0, 1.0, -0.0));
    assert_eq!(
        table(&document, None),
        "frame,time,\"hip, \"\"left\"\".x\",\"hip, \"\"left\"\".y\",\"hip, \"\"left\"\".z\",\
         thigh.x,thigh.y,thigh.z,point.x,point.y,point.z,thigh_tip.x,thigh_tip.y,thigh_tip.z\n\
         0,-1,0,0,0,1,0,0,0,0,0,1,1,0\n\
         1,-0.5,0,0.5,0,1,0.5,0,0,0.5,0,1,1.5,0\n\
         2,0,0,1,0,1,1,0,0,1,0,1,2,0\n"
    );
    assert_eq!(table(&document, Some(10.0)).lines().count(), 12);
}

#[test]
fn the_arm_is_its_four_joints() {
    let mut document = Document::default();
    document.timeline.end = 1.0;
    document.edit_arm(|arm| arm.root = Vec3::new(10.0, 20.0, 30.0));
    for (time, x) in [(0.0, 0.0), (1.0, 300.0)] {
        document.keys.insert(channels::HAND, time, Vec3::new(x, 250.0, 40.0));
    }
    let table = table(&document, Some(4.0));
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let header = rows.headers().expect("a header").iter().collect::<Vec<_>>().join(" ");
    let expected = "frame time root.x root.y root.z upper.x upper.y upper.z lower.x lower.y lower.z \
                    hand.x hand.y hand.z";
    assert_eq!(header, expected);
    let mut count = 0;
    for (frame, row) in rows.deserialize::<[f64; 14]>().enumerate() {
        let row = row.expect("numbers");
        let time = frame as f64 / 4.0;
        let arm = document.at(time).into_document().arm();
        let pose = arm.pose();
        assert_eq!((row[0], row[1]), (frame as f64, time));
        let points = [Vec3::ZERO, Vec3::ZERO, pose.elbow, pose.hand].map(|it| arm.root + it);
        for (found, point) in row[2..].chunks(3).zip(points) {
            let off = Vec3::new(found[0] as f32, found[1] as f32, found[2] as f32).distance(point);
            assert!(off < 3e-7 * 500.0, "{off}");
        }
        count += 1;
    }
    assert_eq!(count, 5);
}

#[test]
fn a_path_follower_moves_in_the_table() {
    let document = crate::common::documents::keyed_snake();
    let table = table(&document, None);
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    for (frame, row) in rows.records().enumerate().step_by(60) {
        let row = row.expect("a row");
        let time = document.timeline.time(frame);
        let rig = document.at(time).into_document().rig;
        let head = rig.skeleton_at(time).pose().base(JointId::new(0));
        let found = [2, 3, 4].map(|column| row[column].parse::<f32>().expect("a number"));
        assert_eq!(Vec3::from_array(found), head);
    }
}

#[test]
fn an_empty_skeleton_gives_one_row_and_a_cancelled_table_none() {
    let rig = SkeletonRig::new(Skeleton::default());
    let mut document = Document::new(rig);
    assert_eq!(table(&document, None), "frame,time\n0,0\n");
    let progress = Progress::default();
    progress.cancel();
    let stopped = block_on(io::to_csv(&document, None, &progress));
    assert!(matches!(stopped, Err(MotionError::Cancelled(_))));
    let mut far = Joint::new("far", None, Vec3::splat(3e38));
    far.offset = Vec3::splat(3e38);
    document.skeleton_mut().add(far).expect("joint");
    let refused = block_on(io::to_csv(&document, None, &Progress::default())).expect_err("refused");
    assert_eq!(refused.to_string(), "the position of \"far_tip\" must be within ±3.4028235e38");
}
