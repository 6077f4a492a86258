//! Edits of a 1,000-joint skeleton in a session: keying 60 joints, and turning one.

use core::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use ik_arm::document::{Channel, Document, SkeletonRig};
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::session::{Action, Edit, JointEdit, KeysEdit, Preferences, Session};

const JOINTS: usize = 1000;
const KEYED: usize = 60;

fn chain() -> Skeleton {
    let joint = |index: usize| {
        let parent = index.checked_sub(1).map(JointId::new);
        let offset = if index == 0 { Vec3::ZERO } else { Vec3::Y * 0.1 };
        Joint { offset, ..Joint::new(&format!("joint_{index}"), parent, Vec3::Y * 0.1) }
    };
    Skeleton::from_joints((0..JOINTS).map(joint).collect()).expect("a chain")
}

fn session() -> Session {
    let document = Document { rig: SkeletonRig::new(chain()), ..Document::default() };
    Session::with_document(Preferences::default(), document)
}

fn edits(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("edit_1000_joints");
    let keyed = (0..KEYED).map(JointId::new).map(Channel::Rotation).collect();
    let turned =
        JointEdit::SetRotation { joint: JointId::new(500), rotation: Vec3::new(0.1, 0.2, 0.3) };
    for (name, edit) in
        [("key_60_channels", Edit::from(KeysEdit::Key(keyed))), ("turn_one_joint", turned.into())]
    {
        let edit = Action::from(edit);
        group.bench_function(name, |bencher| {
            let apply = |mut session: Session| {
                session.apply(black_box(edit.clone()));
                session
            };
            bencher.iter_batched(session, apply, BatchSize::SmallInput);
        });
    }
    group.finish();
}

criterion_group!(benches, edits);
criterion_main!(benches);
