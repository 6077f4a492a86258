//! The circle of elbows: what is drawn of it, and dragging the elbow along it.

use crate::common::arm::{Arm, ArmSession, Cursor, LOWER};
use core::f32::consts::TAU;

use glam::{DQuat, DVec3, Vec3};
use ik_arm::document::{Display, Document, Overlay, Ray, Theme, Track, TwistReferenceKind};
use ik_arm::kinematics::two_bone::TwoBone;
use ik_arm::scene::{Line, Scene};
use ik_arm::session::{DragInput, Grip, Overlays, Preferences, Session, TransactionAction};

use crate::common::Random;

/// A random arm whose hand is away from both limits, so that its elbow has a place.
fn arm(random: &mut Random) -> Arm {
    let length = random.power_of_ten(-1.0..3.0) as f32;
    let bones = TwoBone::new(length, length * random.within(0.2..5.0)).expect("two lengths");
    let (inner, outer) = (bones.inner_limit(), bones.outer_limit());
    let distance = inner + (outer - inner) * random.within(0.1..0.9);
    Arm {
        cursor: Cursor::unpinned(random.direction() * distance),
        root: random.vector(outer),
        twist: random.within(0.0..TAU),
        twist_reference: random.one_of(&[
            TwistReferenceKind::Up,
            TwistReferenceKind::Pole,
            TwistReferenceKind::Stereographic,
        ]),
        pole: random.direction() * outer,
        bones,
        ..Arm::default()
    }
}

fn scene_of(arm: Arm) -> Scene {
    let display = Display::from_iter([Overlay::ElbowCircle]);
    let document = Document { display, ..arm.document() };
    let posed = document.at(0.0);
    Scene::new(&posed, &Overlays::new(&Track::new(&document), &posed), Theme::Dark)
}

#[test]
fn every_drawn_point_has_both_limb_lengths() {
    let mut random = Random(17);
    for case in 0..1000 {
        let arm = arm(&mut random);
        let scene = scene_of(arm);
        let is_other = |line: &&Line| line.colour == scene.palette.accent || line.dashed;
        let circle = scene.lines.iter().filter(|line| !is_other(line));
        let hand = (arm.root + arm.pose().hand).as_dvec3();
        let root = arm.root.as_dvec3();
        let bound = 1e-5 * f64::from(arm.bones.outer_limit());
        let mut count = 0;
        for line in circle {
            count += 1;
            for point in [line.from, line.to].map(Vec3::as_dvec3) {
                let upper = point.distance(root) - f64::from(arm.bones.upper());
                let lower = point.distance(hand) - f64::from(arm.bones.lower());
                assert!(upper.abs() < bound && lower.abs() < bound, "case {case}: {upper} {lower}");
            }
        }
        assert_eq!(count, 96, "case {case}: the whole circle");
    }
}

/// The point of the circle at an angle from the elbow, by the law of cosines in f64.
fn on_circle(arm: &Arm, angle: f64) -> DVec3 {
    let (root, pose) = (arm.root.as_dvec3(), arm.pose());
    let to_hand = pose.hand.as_dvec3();
    let [upper, lower] = [arm.bones.upper(), arm.bones.lower()].map(f64::from);
    let distance = to_hand.length();
    let axis = to_hand / distance;
    let along = (upper.powi(2) - lower.powi(2) + distance.powi(2)) / (2.0 * distance);
    let out = (upper.powi(2) - along.powi(2)).sqrt();
    let elbow = pose.elbow.as_dvec3();
    let outward = (elbow - axis * elbow.dot(axis)).normalize();
    root + axis * along + DQuat::from_axis_angle(axis, angle) * outward * out
}

fn ray_from(eye: Vec3, point: DVec3) -> Ray {
    let direction = (point - eye.as_dvec3()).normalize().as_vec3();
    Ray { origin: eye, direction }
}

#[test]
fn an_elbow_dragged_along_the_circle_gets_the_twist_of_that_place() {
    let mut random = Random(18);
    for case in 0..1000 {
        let arm = arm(&mut random);
        let document = arm.document();
        let mut session = Session::with_document(Preferences::default(), document);
        // An eye from which the circle is not seen edge-on.
        let outer = arm.bones.outer_limit();
        let tilt = random.vector(0.5);
        let axis = arm.pose().pointer.direction;
        let eye = arm.root + (axis + tilt).normalize() * 4.0 * outer;
        let turned = f64::from(random.within(-2.5..2.5));
        let [start, end] = [on_circle(&arm, 0.0), on_circle(&arm, turned)];
        let forward = (arm.root - eye).normalize();
        let grab = ray_from(eye, start);
        session.apply(TransactionAction::Grab { grip: Grip::LimbTwist(LOWER), ray: grab, forward });
        let ray = ray_from(eye, end);
        session.apply(TransactionAction::Drag(DragInput { ray, precise: false, snap: false }));
        session.apply(TransactionAction::Commit);

        let twist = f64::from(session.arm().twist) - f64::from(arm.twist);
        let wrong = (twist - turned + 0.5 * f64::from(TAU)).rem_euclid(f64::from(TAU))
            - 0.5 * f64::from(TAU);
        assert!(wrong.abs() < 1e-4, "case {case}: turned by {twist} instead of {turned}");
        let elbow = (session.arm().root + session.pose().elbow).as_dvec3();
        let apart = elbow.distance(end) / f64::from(arm.pose().out);
        assert!(apart < 2e-4, "case {case}: the elbow is {apart} radians from there");
    }
}

#[test]
fn in_fk_and_for_a_straight_arm_there_is_no_circle() {
    let straight = Arm { cursor: Cursor::unpinned(Vec3::X * 600.0), ..Arm::default() };
    let blended = Arm { influence: 0.5, ..Arm::default() };
    for arm in [straight, blended, Arm { influence: 0.0, ..Arm::default() }] {
        assert!(scene_of(arm).lines.iter().all(|line| line.dashed), "only the gap is drawn");
    }
}
