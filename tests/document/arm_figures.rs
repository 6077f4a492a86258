//! The arm's figures, lit up in the view: what is drawn has the solver's numbers.

use crate::common::arm::{Arm, Cursor};
use core::f32::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use ik_arm::document::{Display, Document, Overlay, Theme, Track, TwistReferenceKind};
use ik_arm::kinematics::fk::Fk;
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::scene::{Line, Scene, Solid};
use ik_arm::session::{LimbFigure, Overlays};

use crate::common::Random;

/// A random arm, posed by IK, FK or both. Its hand may be out of reach.
fn arm(random: &mut Random) -> Arm {
    let length = random.power_of_ten(-1.0..3.0) as f32;
    let bones = TwoBone::new(length, length * random.within(0.2..5.0)).expect("two lengths");
    let outer = bones.outer_limit();
    Arm {
        cursor: Cursor::unpinned(random.direction() * outer * random.within(0.05..1.5)),
        root: random.vector(outer),
        twist: random.within(0.0..TAU),
        twist_reference: random.one_of(&[TwistReferenceKind::Up, TwistReferenceKind::Pole]),
        pole: random.direction() * outer,
        influence: random.one_of(&[1.0, 1.0, 0.5, 0.0]),
        fk: Fk { shoulder: random.angles(), bend: random.within(0.1..3.0), stretch: 1.0 },
        bones,
        ..Arm::default()
    }
}

/// Additions of a figure to the picture of an arm.
struct Lit {
    solids: Vec<Solid>,
    lines: Vec<Line>,
    labels: Vec<String>,
}

fn scene(arm: Arm, display: &[Overlay], figure: Option<LimbFigure>) -> Scene {
    let display = Display::from_iter(display.iter().copied()).with(Overlay::Labels, true);
    let document = Document { display, ..arm.document() };
    let posed = document.at(0.0);
    let overlays = Overlays { figure, ..Overlays::new(&Track::new(&document), &posed) };
    Scene::new(&posed, &overlays, Theme::Dark)
}

fn added(with: &Scene, without: &Scene) -> Lit {
    let labels = with.labels[without.labels.len()..].iter();
    Lit {
        solids: with.guide_solids[without.guide_solids.len()..].to_vec(),
        lines: with.lines[without.lines.len()..].to_vec(),
        labels: labels.map(|label| with.text(label).to_owned()).collect(),
    }
}

fn lit(arm: Arm, figure: LimbFigure) -> Lit {
    added(&scene(arm, &[], Some(figure)), &scene(arm, &[], None))
}

fn ends(solid: &Solid) -> [DVec3; 2] {
    let base = Vec3::from(solid.transform.translation);
    let tip = solid.transform.transform_point3(solid.shape.length * Vec3::X);
    [base, tip].map(Vec3::as_dvec3)
}

/// The only line of a figure, from end to end.
fn line(arm: Arm, figure: LimbFigure) -> [DVec3; 2] {
    match lit(arm, figure).solids.as_slice() {
        [solid] => ends(solid),
        solids => panic!("{figure:?}: {} solids", solids.len()),
    }
}

/// The turn of an arc about its centre, in radians: the sum of the turns of its lines.
fn turn(lines: &[Line], centre: DVec3) -> f64 {
    let turns = lines.iter().map(|line| {
        let [from, to] = [line.from, line.to].map(|end| end.as_dvec3() - centre);
        from.angle_between(to)
    });
    turns.sum()
}

fn arms() -> impl Iterator<Item = (usize, Arm)> {
    let mut random = Random(19);
    (0..1000).map(move |case| (case, arm(&mut random)))
}

#[test]
fn lengths_are_drawn_from_joint_to_joint_with_the_solvers_lengths() {
    for (case, arm) in arms() {
        let pose = arm.pose();
        let bound = 1e-5 * f64::from(arm.bones.outer_limit().max(arm.root.length()));
        let [root, elbow, hand] =
            [Vec3::ZERO, pose.elbow, pose.hand].map(|point| (arm.root + point).as_dvec3());
        let stretch = f64::from(pose.stretch);
        let [upper, lower] =
            [arm.bones.upper(), arm.bones.lower()].map(|it| stretch * f64::from(it));
        let check = |figure, expected: [DVec3; 2], length: f64| {
            let [from, to] = line(arm, figure);
            let off = from.distance(expected[0]).max(to.distance(expected[1]));
            assert!(off < bound, "case {case}, {figure:?}: {off}");
            let off = (from.distance(to) - length).abs();
            assert!(off < bound, "case {case}, {figure:?}: length off by {off}");
        };
        check(LimbFigure::Upper, [root, elbow], upper);
        check(LimbFigure::Lower, [elbow, hand], lower);
        check(LimbFigure::Distance, [root, hand], pose.distance.into());
        // The point of the Pointer nearest to the elbow, from the points alone.
        let axis = (hand - root).normalize();
        let foot = root + axis * (elbow - root).dot(axis);
        if pose.out > 1e-3 * arm.bones.outer_limit() {
            check(LimbFigure::Along, [root, foot], f64::from(pose.along).abs());
            check(LimbFigure::Out, [foot, elbow], pose.out.into());
        }
    }
}

#[test]
fn angles_are_arcs_of_the_solvers_angles_with_their_degrees() {
    for (case, arm) in arms() {
        let pose = arm.pose();
        let shoulder = arm.root.as_dvec3();
        let elbow = (arm.root + pose.elbow).as_dvec3();
        let [x, y, z] = if arm.influence == 1.0 { arm.cursor_in_root() } else { pose.hand }
            .as_dvec3()
            .to_array();
        let [d1, d2, d] = [
            f64::from(arm.bones.upper() * pose.stretch),
            f64::from(arm.bones.lower() * pose.stretch),
            f64::from(pose.distance),
        ];
        let opposite = |a: f64, b: f64, c: f64| {
            ((a * a + b * b - c * c) / (2.0 * a * b)).clamp(-1.0, 1.0).acos()
        };
        for (figure, centre, expected) in [
            (LimbFigure::Yaw, shoulder, z.atan2(x)),
            (LimbFigure::Pitch, shoulder, y.atan2(x.hypot(z))),
            (LimbFigure::ShoulderAngle, shoulder, opposite(d1, d, d2)),
            (LimbFigure::ElbowAngle, elbow, opposite(d1, d2, d)),
        ] {
            let lit = lit(arm, figure);
            let arcs: Vec<_> = lit.lines.iter().filter(|line| !line.dashed).copied().collect();
            let one = &arcs[..arcs.len() / 3];
            // Near a straight or folded arm the angles change much with the last bit of D.
            let is_flat = pose.out < 0.05 * arm.bones.outer_limit();
            let bound = if is_flat { 2e-3 } else { 1e-4 };
            let drawn = turn(one, centre);
            let off = (drawn - expected.abs()).abs();
            assert!(off < bound, "case {case}, {figure:?}: {drawn} {expected}");
            let degrees: f64 = lit.labels[0].trim_end_matches('°').parse().expect("degrees");
            let off = (degrees - expected.to_degrees()).abs();
            assert!(
                off < 0.0501 + bound.to_degrees(),
                "case {case}, {figure:?}: {degrees} {expected}"
            );
        }
    }
}

#[test]
fn the_arcs_of_yaw_and_pitch_lead_to_the_cursor() {
    for (case, arm) in arms() {
        let pose = arm.pose();
        let cursor = if arm.influence == 1.0 { arm.cursor_in_root() } else { pose.hand };
        let level = Vec3 { y: 0.0, ..cursor };
        for (figure, from, to) in
            [(LimbFigure::Yaw, Vec3::X, level), (LimbFigure::Pitch, level, cursor)]
        {
            let lit = lit(arm, figure);
            let arc: Vec<_> = lit.lines.iter().filter(|line| !line.dashed).collect();
            let [first, last] = [arc[0].from, arc[arc.len() - 1].to].map(|end| end - arm.root);
            for (drawn, expected) in [(first, from), (last, to)] {
                let off = drawn.angle_between(expected);
                assert!(off < 1e-3, "case {case}, {figure:?}: {off}");
            }
        }
    }
}

#[test]
fn coordinates_lead_from_the_shoulder_along_the_axes_to_cursor_and_elbow() {
    for (case, arm) in arms() {
        let pose = arm.pose();
        let cursor = if arm.influence == 1.0 { arm.cursor_in_root() } else { pose.hand };
        for (figure, point) in [(LimbFigure::Cursor, cursor), (LimbFigure::Elbow, pose.elbow)] {
            let lit = lit(arm, figure);
            let ways: Vec<_> = lit.solids.iter().map(ends).collect();
            let bound = 1e-5 * f64::from(arm.bones.outer_limit().max(arm.root.length()));
            let end = arm.root.as_dvec3() + ways.iter().map(|[from, to]| to - from).sum::<DVec3>();
            let off = end.distance((arm.root + point).as_dvec3());
            assert!(off < bound, "case {case}, {figure:?}: {off}");
            for [from, to] in ways {
                let along = (to - from).abs();
                let others = along.element_sum() - along.max_element();
                assert!(others < bound, "case {case}, {figure:?}: along one axis");
            }
            let numbers = lit.labels[0].trim_matches(['(', ')']).split(", ");
            for (number, coordinate) in numbers.zip(point.as_dvec3().to_array()) {
                let digits = number.split('.').nth(1).map_or(0, str::len) as i32;
                let off = (number.parse::<f64>().expect("a number") - coordinate).abs();
                assert!(
                    off <= 0.51 * 10_f64.powi(-digits) + bound,
                    "case {case}: {number} {coordinate}"
                );
            }
        }
    }
}

#[test]
fn the_frames_are_the_turns_of_yaw_pitch_and_twist() {
    for (case, arm) in arms() {
        let pose = arm.pose();
        let [yaw, pitch, twist] = [pose.yaw(), pose.pitch(), pose.twist].map(f64::from);
        let limb = DMat3::from_rotation_y(-yaw) * DMat3::from_rotation_z(pitch);
        let frames = [
            (LimbFigure::Root, DMat3::IDENTITY),
            (LimbFigure::Limb, limb),
            (LimbFigure::Socket, limb * DMat3::from_rotation_x(twist)),
        ];
        let all = added(&scene(arm, &[Overlay::Frames], None), &scene(arm, &[], None));
        for (nth, (figure, frame)) in frames.into_iter().enumerate() {
            let lit = lit(arm, figure);
            assert_eq!(lit.solids, all.solids[6 * nth..6 * nth + 6], "{figure:?}");
            // Each axis is a shaft and a head.
            for (axis, shaft) in lit.solids.iter().step_by(2).map(ends).enumerate() {
                let drawn = (shaft[1] - shaft[0]).normalize();
                let off = drawn.distance(frame.col(axis));
                assert!(off < 1e-5, "case {case}, {figure:?}, axis {axis}: {off}");
            }
            let names = ["x", "y", "z"].map(|axis| format!("{figure:?} {axis}"));
            assert_eq!(lit.labels, names);
        }
    }
}

#[test]
fn the_level_lies_flat_below_the_cursor() {
    for (case, arm) in arms() {
        let cursor = if arm.influence == 1.0 { arm.cursor_in_root() } else { arm.pose().hand };
        let [from, to] = line(arm, LimbFigure::Level);
        let bound = 1e-5 * f64::from(arm.bones.outer_limit().max(arm.root.length()));
        let length = f64::from(cursor.x).hypot(cursor.z.into());
        assert!((from.distance(to) - length).abs() < bound, "case {case}");
        assert!((from.y - to.y).abs() < bound, "case {case}");
    }
}
