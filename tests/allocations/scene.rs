//! Scenes change without allocating. The test has its own binary because its allocator
//! counts.

use crate::common::arm::{ArmDocument, ArmEdit, Cursor, Step, channels};
use allocation_counter::measure;
use glam::Vec3;
use ik_arm::document::{
    Channel, Display, Document, Overlay, TargetPath, Theme, Track, TwistReferenceKind,
};
use ik_arm::io::Example;
use ik_arm::kinematics::skeleton::JointId;
use ik_arm::scene::{Scene, SceneBuilder};
use ik_arm::session::{
    Action, Overlays, PlaybackAction, Preferences, SelectAction, Session, SolverAction,
};

/// The window's work between two frames, with the buffers that it reuses.
struct Bench {
    session: Session,
    overlays: Overlays,
    builder: SceneBuilder,
    scene: Scene,
    shown: Scene,
}

impl Bench {
    fn new(document: Document) -> Self {
        let session = Session::with_document(Preferences::default(), document);
        let overlays = session.overlays();
        let mut builder = SceneBuilder::default();
        let scene = builder.build(session.posed(), &overlays, Theme::Dark);
        Self { session, overlays, builder, shown: scene.clone(), scene }
    }

    /// Applies an action and builds the next scene. Returns the number of allocations, and whether
    /// it is another scene than the one before.
    fn frame(&mut self, action: Action) -> (u64, bool) {
        self.session.apply(action);
        // Built and solved on first use.
        self.session.overlays();
        self.session.posed().skeleton_by_itself();
        let counted = measure(|| {
            self.session.write_overlays(&mut self.overlays);
            self.builder.refill(&mut self.scene, self.session.posed(), &self.overlays, Theme::Dark);
        });
        let has_changed = self.scene != self.shown;
        std::mem::swap(&mut self.scene, &mut self.shown);
        (counted.count_total, has_changed)
    }

    /// Once warm, which takes two rounds for each of the two scenes, every action changes the picture and allocates nothing.
    fn assert_takes_nothing(&mut self, steps: &[Step]) {
        for round in 0..5 {
            for step in steps {
                let action = &step.clone().action(&self.session);
                let (taken, has_changed) = self.frame(action.clone());
                assert!(has_changed, "{action:?} is seen");
                assert!(round < 4 || taken == 0, "{action:?} takes memory {taken} times");
            }
        }
    }
}

fn all_layers_but_onion_skins() -> Display {
    Overlay::all().filter(|overlay| *overlay != Overlay::OnionSkins).collect()
}

#[test]
fn a_moving_arm_with_all_guides_allocates_nothing() {
    for twist_reference in TwistReferenceKind::ALL {
        let mut document =
            Document { display: all_layers_but_onion_skins(), ..Document::default() };
        document.edit_arm(|arm| arm.twist_reference = twist_reference);
        document.edit_arm(|arm| arm.cursor = Cursor::pinned(arm.cursor_in_world()));
        for (time, hand) in [(0.0, Vec3::X), (1.0, Vec3::Y)] {
            document.edit_arm(|arm| arm.set_cursor(hand * 300.0));
            document.key(channels::PIN, time);
        }
        // Within reach, out of it, too close, and turned.
        Bench::new(document).assert_takes_nothing(&[
            Step::from(ArmEdit::SetHand(Vec3::new(250.0, 120.0, 60.0))),
            ArmEdit::SetHand(Vec3::new(-900.5, 120.25, 60.0)).into(),
            ArmEdit::SetHand(Vec3::new(12.0, -40.0, 9.0)).into(),
            ArmEdit::SetTwist(1.25).into(),
            ArmEdit::SetTwist(-0.5).into(),
            PlaybackAction::SetTime(0.5).into(),
            PlaybackAction::SetTime(0.25).into(),
        ]);
    }
}

#[test]
fn a_moving_skeleton_with_targets_keys_and_trails_allocates_nothing() {
    let opened = Example::find("ten-joints").expect("an example").open().expect("it opens");
    let mut document = opened.document;
    document.display = all_layers_but_onion_skins();
    let joints = document.skeleton().joints().len();
    assert!(joints >= 10);
    let target = document.rig.targets.first_mut().expect("a target");
    target.motion.path = TargetPath::FigureEight;
    for (time, angle) in [(0.0, 0.2), (1.0, 0.9)] {
        let turned = Vec3::splat(angle);
        document.skeleton_mut().set_rotation(JointId::new(3), turned).expect("a joint");
        document.key(Channel::Rotation(JointId::new(3)), time);
    }
    let mut bench = Bench::new(document);
    bench.session.apply(SelectAction::Joints(vec![JointId::new(joints - 1)]));
    assert!(bench.session.overlays().trail.points.len() > 10, "a motion path");
    bench.assert_takes_nothing(&[
        Step::from(PlaybackAction::SetTime(0.1)),
        PlaybackAction::SetTime(0.6).into(),
        SolverAction::Step.into(),
        SolverAction::Show(0).into(),
        SelectAction::Hover(Some(JointId::new(2))).into(),
        SelectAction::Hover(None).into(),
        SelectAction::Joints(vec![JointId::new(joints - 1), JointId::new(4)]).into(),
        SelectAction::Joints(vec![JointId::new(3)]).into(),
        SelectAction::Joints(vec![JointId::new(joints - 1)]).into(),
    ]);
}

#[test]
fn a_solver_comparison_allocates_nothing() {
    let opened = Example::find("two-targets").expect("an example").open().expect("it opens");
    let mut bench = Bench::new(opened.document);
    bench.session.apply(SolverAction::Compare);
    bench.frame(PlaybackAction::Advance(0.0).into());
    for frame in 1..8 {
        let (taken, has_changed) =
            bench.frame(PlaybackAction::Advance(f64::from(frame) / 60.0).into());
        assert!(has_changed && (frame < 3 || taken == 0), "frame {frame}: {taken}");
    }
}

#[test]
fn a_snake_that_follows_its_path_allocates_nothing() {
    let document = crate::common::documents::keyed_snake();
    let times = [0.1, 0.4, 1.7, 2.3].map(|time| PlaybackAction::SetTime(time).into());
    Bench::new(document).assert_takes_nothing(&times);
}

#[test]
fn a_scene_built_in_reused_memory_equals_a_new_one() {
    let mut scene: Option<Scene> = None;
    let mut builder = SceneBuilder::default();
    for example in Example::ALL {
        let mut document = example.open().expect("it opens").document;
        for overlays in [document.display, Overlay::all().collect(), Display::from_iter([])] {
            document.display = overlays;
            for theme in [Theme::Dark, Theme::Light] {
                let (track, posed) = (Track::new(&document), document.at(0.3));
                let overlays = Overlays::new(&track, &posed);
                let anew = Scene::new(&posed, &overlays, theme);
                let scene = scene.get_or_insert_with(|| anew.clone());
                builder.refill(scene, &posed, &overlays, theme);
                assert_eq!(*scene, anew, "{}", example.name);
                for (label, same) in scene.labels.iter().zip(&anew.labels) {
                    assert_eq!(scene.text(label), anew.text(same));
                    assert!(!scene.text(label).is_empty());
                }
            }
        }
    }
}
