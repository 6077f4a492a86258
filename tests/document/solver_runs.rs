//! Solver runs and comparisons are views: they solve copies of the FK pose, keep every iterate, and
//! change the document only by "Apply pose".

use glam::Vec3;
use ik_arm::document::{
    Channel, Document, PathKind, SkeletonRig, Target, TargetMotion, TargetPath, Theme, WavyRing,
};
use ik_arm::io::to_json;
use ik_arm::kinematics::chain_ik::{ChainSolver, ChainTarget, Method, Root, SolverOptions, Status};
use ik_arm::kinematics::skeleton::{JointId, Skeleton};
use ik_arm::scene::Scene;
use ik_arm::session::{
    Action, Comparison, Edit, JointEdit, KeysEdit, PathEdit, PlaybackAction, Session,
    ShownIteration, SolverAction, SolverEdit, SolverRun, SolverState, TargetEdit,
    TransactionAction,
};

use crate::common::documents::open_example;
use crate::common::{Random, skeletons};

/// A tree with one to three targets that it can reach, some of which move, and a method that can
/// solve for them.
fn document(random: &mut Random) -> Document {
    let ends = 1 + random.below(3);
    let (mut skeleton, tips) = skeletons::tree(random, ends, 1.0);
    let targets = skeletons::reachable(random, &skeleton, &tips);
    skeletons::shake(random, &mut skeleton);
    let mut rig = SkeletonRig::new(skeleton);
    for target in targets {
        let path = random.one_of(&[TargetPath::Still, TargetPath::Circle]);
        let motion = TargetMotion { path, radius: 0.1, period: 2.0 };
        rig.targets.push(Target { motion, ..Target::new(target.joint, target.point, 1.0) });
    }
    rig.solver = options(random);
    rig.iterations_per_frame = 1 + random.below(4) as u32;
    Document::new(rig)
}

fn options(random: &mut Random) -> SolverOptions {
    let methods = Method::ALL.into_iter().filter(|method| *method != Method::TwoBone);
    let method = random.one_of(&methods.collect::<Vec<_>>());
    let mut options = SolverOptions::new(method).with_root(random.one_of(&Root::ALL));
    options.iterations = random.coin().then_some(20);
    options
}

fn open(document: Document) -> Session {
    Session::with_document(Default::default(), document)
}

fn example(name: &str) -> Session {
    let mut session = Session::default();
    session.apply(open_example(name));
    session
}

fn bytes(session: &Session) -> String {
    to_json(session.document()).expect("saved")
}

fn step(session: &mut Session, count: usize) {
    (0..count).for_each(|_| drop(session.apply(SolverAction::Step)));
}

/// Lets the solver run until it pauses, from a time in seconds on the window's clock.
fn run_to_the_end(session: &mut Session, from: f64) {
    session.apply(SolverAction::Run(true));
    for frame in 0..2000 {
        session.apply(PlaybackAction::Advance(from + f64::from(frame) / 60.0));
        if !session.solvers().is_running() {
            return;
        }
    }
    panic!("the solver ends");
}

/// Bits of all angles and offsets.
fn bits(skeleton: &Skeleton) -> Vec<[u32; 6]> {
    let of = |joint: &ik_arm::kinematics::skeleton::Joint| {
        let ([a, b, c], [d, e, f]) = (joint.rotation.to_array(), joint.offset.to_array());
        [a, b, c, d, e, f].map(f32::to_bits)
    };
    skeleton.iter().map(|(_, joint)| of(joint)).collect()
}

/// The pose of the motion's step before, or the FK pose, after some iterations of a new solver,
/// with the error that it reports.
fn fresh(session: &Session, options: &SolverOptions, iterations: u32) -> (Skeleton, f32) {
    let (rig, time) = (session.rig(), session.playback().time());
    let mut skeleton = Skeleton::clone(&rig.fk_at(time));
    let mut solver =
        ChainSolver::new(&skeleton, &rig.targets_at(time), options).expect("it can be solved");
    let carried = session.posed().carried();
    if let Some(start) = carried.and_then(|carried| carried.body_pose(&skeleton)) {
        solver.begin_from(&start);
        skeleton = start;
    }
    if iterations > 0 {
        for _ in 0..iterations {
            solver.step();
        }
        solver.write(&mut skeleton);
    }
    (skeleton, solver.report().error)
}

/// Checks that the shown iterate is that of a new solver for what the session shows.
fn assert_is_fresh(session: &Session, run: &SolverRun, options: &SolverOptions) {
    let shown = run.shown();
    let (skeleton, error) = fresh(session, options, shown.iteration);
    assert_eq!(bits(run.skeleton()), bits(&skeleton), "iterate {} of {options:?}", shown.iteration);
    assert_eq!(shown.error.to_bits(), error.to_bits());
}

fn view(random: &mut Random) -> SolverAction {
    match random.below(8) {
        0 => SolverAction::Run(random.coin()),
        1 => SolverAction::Compare,
        2 => SolverAction::Reset,
        3 | 4 => SolverAction::Show(random.below(40) as u32),
        _ => SolverAction::Step,
    }
}

#[test]
fn no_step_run_comparison_or_iteration_changes_a_byte_of_the_document() {
    let mut random = Random(41);
    for _ in 0..30 {
        let mut session = open(document(&mut random));
        let (before, revision) = (bytes(&session), session.history().revision());
        let evaluated = session.skeleton_pose().clone();
        let mut seconds = 0.0;
        for _ in 0..60 {
            session.apply(view(&mut random));
            seconds += 1.0 / 60.0;
            session.apply(PlaybackAction::Advance(seconds));
            assert_eq!(session.skeleton_pose(), &evaluated, "the evaluated pose remains");
        }
        assert!(bytes(&session) == before);
        assert_eq!(
            (session.history().revision(), session.history().undo_label()),
            (revision, None)
        );
        assert!(!session.history().is_unsaved());
    }
}

#[test]
fn iterate_k_is_that_of_a_new_solver_after_k_steps() {
    let mut random = Random(42);
    for _ in 0..40 {
        let mut session = open(document(&mut random));
        step(&mut session, 25);
        let run = session.solvers().run().expect("it steps").clone();
        let options = session.rig().solver;
        for iterate in run.iterates().iter() {
            session.apply(SolverAction::Show(iterate.iteration));
            let run = session.solvers().run().expect("it is shown");
            assert_eq!(run.shown(), iterate);
            assert_is_fresh(&session, run, &options);
        }
        let first = run.iterates().at(0).joints();
        let fk = session.rig().fk_at(session.playback().time());
        assert!(first.eq(fk.iter().map(|(_, joint)| (joint.rotation, joint.offset))));
    }
}

#[test]
fn a_run_and_a_comparison_always_solve_what_the_session_shows() {
    let mut random = Random(43);
    for _ in 0..60 {
        let mut session = open(document(&mut random));
        let mut seconds = 0.0;
        for _ in 0..50 {
            let action = change(&mut random, &session, &mut seconds);
            session.apply(action);
            let options = session.rig().solver;
            if let Some(run) = session.solvers().run() {
                assert_is_fresh(&session, run, &options);
            }
            for solver in session.solvers().comparison().into_iter().flat_map(Comparison::solvers) {
                let mut options = options.with_method(solver.method);
                options.iterations = None;
                if let Ok(run) = &solver.run {
                    assert_is_fresh(&session, run, &options);
                }
            }
        }
    }
}

/// Any action that a solver run may notice.
fn change(random: &mut Random, session: &Session, seconds: &mut f64) -> Action {
    let rig = session.rig();
    let joint = JointId::new(random.below(rig.skeleton.joints().len()));
    let target = (!rig.targets.is_empty()).then(|| rig.targets[random.below(rig.targets.len())]);
    match random.below(16) {
        0 => JointEdit::SetRotation { joint, rotation: random.vector(0.5) }.into(),
        1 => SolverEdit::SetSolver(options(random)).into(),
        2 => TargetEdit::AddTarget(joint).into(),
        3 => KeysEdit::Key(vec![Channel::Rotation(joint)]).into(),
        4 => SolverEdit::ApplyPose.into(),
        5 => JointEdit::AddChild { parent: joint, tip: None }.into(),
        6 => TransactionAction::Undo.into(),
        7 => PlaybackAction::SetTime(f64::from(random.within(0.0..4.0))).into(),
        8..11 => {
            *seconds += 0.02;
            PlaybackAction::Advance(*seconds).into()
        }
        11 if target.is_some() => {
            let target = target.expect("checked");
            let home = target.home + random.vector(0.3);
            TargetEdit::SetTarget(Target { home, influence: 1.0, ..target }).into()
        }
        _ => view(random).into(),
    }
}

#[test]
fn the_iterations_of_a_run_do_not_depend_on_the_times_that_were_shown_before() {
    let mut random = Random(44);
    for _ in 0..20 {
        let document = document(&mut random);
        let (mut direct, mut detour) = (open(document.clone()), open(document));
        let times = [(); 5].map(|()| f64::from(random.within(0.0..4.0)));
        for session in [&mut direct, &mut detour] {
            step(session, 7);
        }
        for time in times {
            detour.apply(PlaybackAction::SetTime(time));
        }
        direct.apply(PlaybackAction::SetTime(times[4]));
        let [a, b] = [&direct, &detour].map(|session| session.solvers().run().expect("it steps"));
        assert_eq!(a.iterates(), b.iterates());
        assert_eq!(bits(a.skeleton()), bits(b.skeleton()));
    }
}

#[test]
fn a_run_that_has_ended_solves_a_moved_target_to_its_end() {
    let mut session = example("ten-joints");
    run_to_the_end(&mut session, 0.0);
    let target = session.rig().targets[0];
    for home in [target.home + Vec3::Y * 0.2, target.home + Vec3::X * 0.1, target.home] {
        session.apply(TargetEdit::SetTarget(Target { home, ..target }));
        let run = session.solvers().run().expect("it is looked at");
        assert!(run.report().converged() && run.report().iterations > 0, "{:?}", run.report());
        let error = run.skeleton().tip(target.joint).distance(home);
        assert!(error <= session.rig().tolerance() * 1.01, "{error}");
    }
}

#[test]
fn a_held_iteration_stays_held_and_the_latest_one_is_followed() {
    let mut session = example("two-targets");
    step(&mut session, 4);
    session.apply(SolverAction::Show(2));
    let shown = |session: &Session| session.solvers().shown_iteration().expect("a run");
    let expected = ShownIteration { number: 2, latest: 4, previous: Some(1), next: Some(3) };
    assert_eq!(shown(&session), expected);
    let turned = JointEdit::SetRotation { joint: JointId::new(1), rotation: Vec3::Z * 0.1 };
    session.apply(turned);
    assert_eq!(shown(&session), expected, "it is made anew with as many iterations");
    session.apply(SolverAction::Show(9));
    assert_eq!((shown(&session).number, shown(&session).next), (4, None));
    step(&mut session, 1);
    assert_eq!((shown(&session).number, shown(&session).latest), (5, 5));
    session.apply(SolverAction::Show(0));
    assert_eq!((shown(&session).number, shown(&session).previous), (0, None));
}

#[test]
fn apply_pose_is_one_step_that_undo_takes_back_bit_for_bit() {
    let mut random = Random(45);
    for _ in 0..40 {
        let mut session = open(document(&mut random));
        let before = bytes(&session);
        let steps = 1 + random.below(6);
        step(&mut session, steps);
        session.apply(SolverAction::Show(1 + random.below(steps) as u32));
        let posed = bits(session.solvers().run().expect("it steps").skeleton());
        let is_still = posed == bits(session.skeleton());
        session.apply(SolverEdit::ApplyPose);
        assert_eq!(bits(session.skeleton()), posed);
        assert_eq!(bits(session.document().skeleton()), posed);
        assert!(session.solvers().run().is_none(), "the pose is in the document now");
        assert_eq!(session.history().undo_label(), (!is_still).then_some("Apply pose"));
        session.apply(TransactionAction::Undo);
        assert!(bytes(&session) == before);
        assert_eq!(session.history().undo_label(), None);
    }
}

#[test]
fn a_run_of_free_roots_applies_their_offsets() {
    let mut session = example("two-targets");
    let solver = session.rig().solver.with_root(Root::Free);
    session.apply(SolverEdit::SetSolver(solver));
    let targets = session.rig().targets.clone();
    for target in &targets {
        let home = target.home + Vec3::X * 9.0;
        session.apply(TargetEdit::SetTarget(Target { home, ..*target }));
    }
    run_to_the_end(&mut session, 0.0);
    session.apply(SolverEdit::ApplyPose);
    let root = &session.document().skeleton()[JointId::new(0)];
    assert!(root.offset.x > 5.0, "{}", root.offset);
}

#[test]
fn apply_pose_keys_with_auto_key_and_else_is_an_unkeyed_edit_of_keyed_joints() {
    let joint = JointId::new(1);
    for auto_key in [true, false] {
        let mut session = example("ten-joints");
        session.apply(KeysEdit::Key(vec![Channel::Rotation(joint)]));
        session.apply(PlaybackAction::SetTime(1.0));
        session.apply(PlaybackAction::SetAutoKey(auto_key));
        step(&mut session, 3);
        let posed = session.solvers().run().expect("it steps").skeleton()[joint].rotation;
        assert_ne!(posed, session.skeleton()[joint].rotation);
        session.apply(SolverEdit::ApplyPose);
        assert_eq!(session.skeleton()[joint].rotation, posed);
        let keys = session.document().keys.track(Channel::Rotation(joint)).expect("keyed");
        assert_eq!(keys.get(1.0), auto_key.then_some(posed));
        assert_eq!(session.history().is_overridden(Channel::Rotation(joint)), !auto_key);
        session.apply(TransactionAction::Undo);
        assert_ne!(session.skeleton()[joint].rotation, posed);
    }
}

#[test]
fn a_run_ends_when_there_is_nothing_to_solve() {
    let path = PathKind::Ring(WavyRing { radius: 1.0, amplitude: 0.2, waves: 3, period: 5.0 });
    let joint = example("ten-joints").rig().targets[0].joint;
    let follow = PathEdit::SetFollowPath { root: JointId::new(0), kind: Some(path) };
    for (begin, end) in [
        (SolverAction::Step, Edit::from(TargetEdit::RemoveTarget(joint))),
        (SolverAction::Compare, TargetEdit::RemoveTarget(joint).into()),
        (SolverAction::Run(true), follow.into()),
    ] {
        let mut session = example("ten-joints");
        session.apply(begin.clone());
        assert_eq!(session.overlays().ghosts.len(), session.solvers().runs().count());
        assert!(session.solvers().shown_iteration().is_some());
        session.apply(end);
        assert!(session.solvers().run().is_none() && session.solvers().comparison().is_none());
        assert!(session.overlays().ghosts.is_empty() && !session.is_moving());
        session.apply(begin);
        assert!(
            session.solvers().shown_iteration().is_none() && session.shell().message().is_some()
        );
    }
}

#[test]
fn a_run_ends_with_the_reason_if_its_solver_refuses_the_targets() {
    let mut session = example("human");
    step(&mut session, 1);
    let root = session.rig().targets[0].joint;
    let two_bone = session.rig().solver.with_method(Method::TwoBone);
    session.apply(JointEdit::SetLocked { joint: root, locked: true });
    session.apply(SolverEdit::SetSolver(two_bone));
    assert!(session.solvers().run().is_none());
    assert!(
        session.shell().message().expect("a reason").contains("locked"),
        "{:?}",
        session.shell().message()
    );
}

#[test]
fn the_status_is_that_of_the_shown_iterate_or_of_the_evaluated_pose() {
    let mut session = example("ten-joints");
    let status = |session: &Session| session.solvers().status(session.posed()).expect("a target");
    assert_eq!(
        (status(&session).state, status(&session).iteration),
        (SolverState::NotReached, None)
    );
    step(&mut session, 2);
    assert_eq!(status(&session).state, SolverState::Paused);
    run_to_the_end(&mut session, 0.0);
    let ended = status(&session);
    assert_eq!(ended.state, SolverState::Ended(Status::Converged));
    session.apply(SolverAction::Show(1));
    let earlier = status(&session);
    assert_eq!((earlier.state, earlier.iteration), (SolverState::Earlier, Some(1)));
    assert!(earlier.error > ended.error);
    session.apply(SolverAction::Reset);
    assert_eq!(status(&session).state, SolverState::NotReached, "nothing was applied");
    let target = session.rig().targets[0];
    session.apply(TargetEdit::SetTarget(Target { influence: 1.0, ..target }));
    assert_eq!(status(&session).state, SolverState::Reached, "the evaluated pose is at the target");
}

#[test]
fn a_comparison_shows_the_same_iteration_of_all_solvers() {
    let mut session = example("two-targets");
    session.apply(SolverAction::Compare);
    for frame in 0..200 {
        session.apply(PlaybackAction::Advance(f64::from(frame) / 60.0));
    }
    let race = session.solvers().comparison().expect("it is shown");
    assert!(!race.is_running(), "it ends");
    let latest = race.runs().map(|run| run.report().iterations).max();
    assert_eq!(session.solvers().shown_iteration().map(|shown| shown.latest), latest);
    for number in [0, 1, 5, 30] {
        session.apply(SolverAction::Show(number));
        let ghosts = session.overlays().ghosts;
        for (ghost, run) in ghosts.iter().zip(session.solvers().runs()) {
            assert_eq!(ghost.iteration, number.min(run.report().iterations));
            assert_eq!(ghost.pose, run.skeleton().pose());
            assert_eq!(ghost.method, run.method());
        }
    }
}

#[test]
fn the_labels_in_the_view_tell_the_shown_iteration_and_its_gaps() {
    let mut session = example("two-targets");
    step(&mut session, 3);
    for number in [0, 1, 2] {
        session.apply(SolverAction::Show(number));
        let texts = labels(&session);
        assert!(texts.contains(&format!("Iteration {number}")), "{texts:?}");
        let run = session.solvers().run().expect("it steps");
        let gap = |it: &ChainTarget| run.skeleton().tip(it.joint).distance(it.point);
        let gaps: Vec<f32> = run.targets().iter().map(gap).collect();
        let told: Vec<f32> = told_gaps(&texts).collect();
        // A gap that the target's ball hides is not told.
        let is_seen = |gap: &&f32| **gap > 0.022 * session.rig().reach();
        assert_eq!(gaps.iter().filter(is_seen).count(), told.len(), "{gaps:?} {told:?}");
        for told in told {
            assert!(gaps.iter().any(|gap| (gap - told).abs() < 0.0051), "{told} is in {gaps:?}");
        }
    }
    session.apply(SolverAction::Compare);
    let texts = labels(&session);
    assert_eq!(told_gaps(&texts).count(), 0, "too many to read: {texts:?}");
}

fn told_gaps(labels: &[String]) -> impl Iterator<Item = f32> {
    labels.iter().filter_map(|text| text.strip_prefix("gap ")?.parse().ok())
}

fn labels(session: &Session) -> Vec<String> {
    let scene = Scene::new(session.posed(), &session.overlays(), Theme::Dark);
    scene.labels.iter().map(|label| scene.text(label).to_owned()).collect()
}
