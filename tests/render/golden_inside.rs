//! Pictures of what a solver computes in a part of an iteration, of a wiggle, of why a target is
//! not reached, and of the arm's figures, compared with those in `tests/golden`.

use crate::common::arm::{ArmEdit, ArmSession};
use glam::Vec3;
use ik_arm::document::{Camera, Overlay, Target, Theme};
use ik_arm::kinematics::chain_ik::Method;
use ik_arm::kinematics::skeleton::{JointId, RotationAxis};
use ik_arm::scene::Scene;
use ik_arm::session::{
    DisplayEdit, LimbFigure, PlaybackAction, Preferences, SelectAction, Session, SkinEdit,
    SolverAction, SolverEdit, TargetEdit, ViewAction,
};

use crate::common::documents::open_example;
use crate::pictures;

fn example(name: &str) -> Session {
    let mut session = Session::new(Preferences::default());
    session.apply(open_example(name));
    session
}

/// An example of the inside of a solver, at a part of its first iteration.
fn inside(name: &str, part: usize) -> Session {
    let mut session = example(name);
    session.apply(SolverAction::ShowPart { iteration: 1, part: Some(part) });
    session
}

fn check(name: &str, session: &Session) {
    for (name, theme) in [(name.to_owned(), Theme::Dark), (format!("{name}-light"), Theme::Light)] {
        pictures::check(&name, &Scene::new(session.posed(), &session.overlays(), theme));
    }
}

#[test]
fn the_jacobian_and_its_ellipsoid_at_the_tip_of_a_chain() {
    check("inside_columns", &inside("inside-dls", 0));
}

#[test]
fn the_step_of_damped_least_squares_and_the_angles_that_it_turned() {
    check("inside_step", &inside("inside-dls", 1));
}

#[test]
fn the_rays_and_the_turn_of_one_joint_of_ccd() {
    check("inside_turn", &inside("inside-ccd", 1));
}

#[test]
fn both_passes_of_fabrik() {
    check("inside_backward", &inside("inside-fabrik", 0));
    check("inside_forward", &inside("inside-fabrik", 1));
}

#[test]
fn the_triangle_and_the_circle_of_two_bones() {
    let mut session = example("inside-ccd");
    session.apply(SolverAction::Reset);
    let target = session.rig().targets[0];
    let home = session.skeleton().base(JointId::new(2)) + Vec3::new(0.45, 0.2, 0.25);
    session.apply(TargetEdit::SetTarget(Target { home, ..target }));
    let options = session.rig().solver.with_method(Method::TwoBone);
    session.apply(SolverEdit::SetSolver(options));
    session.apply(SolverAction::Step);
    let parts = session.solvers().run().expect("a run").parts().len();
    session.apply(SolverAction::ShowPart { iteration: 1, part: Some(parts - 1) });
    check("inside_two_bones", &session);
}

#[test]
fn a_joint_that_swings_with_its_path_and_the_line_of_the_jacobian() {
    let mut session = example("inside-dls");
    session.apply(SolverAction::Reset);
    session.apply(SelectAction::Joints(vec![JointId::new(1)]));
    session.apply(SelectAction::Wiggle(Some((JointId::new(1), RotationAxis::Z))));
    for seconds in [0.0, 0.2, 0.4] {
        session.apply(PlaybackAction::Advance(seconds));
    }
    check("wiggle", &session);
}

#[test]
fn the_joints_that_keep_a_tip_from_its_target() {
    let session = example("at-a-limit");
    assert_eq!(session.why(true)[0].joints, [JointId::new(2)]);
    check("why_limits", &session);
}

#[test]
fn the_circles_of_the_elbows_and_knees_of_a_figure() {
    let mut session = example("human");
    session.apply(DisplayEdit::ShowOverlay(Overlay::ElbowCircle, true));
    session.apply(SkinEdit::ShowSkin { skin: false, bones: true });
    let camera = Camera { distance: 2.6, ..*session.camera() };
    session.apply(ViewAction::SetCamera(camera));
    check("limb_circles", &session);
}

/// The arm with a line of its figures lit up.
fn lit(figure: LimbFigure) -> Session {
    let mut session = Session::new(Preferences::default());
    session.edit_arm(ArmEdit::SetHand(Vec3::new(250.0, 150.0, 200.0)));
    session.edit_arm(ArmEdit::SetTwist(0.5));
    session.apply(SelectAction::Figure(Some(figure)));
    let camera = Camera { distance: 640.0, ..*session.camera() };
    session.apply(ViewAction::SetCamera(camera));
    session
}

#[test]
fn the_axes_of_root_limb_and_socket() {
    let mut session = lit(LimbFigure::Distance);
    session.apply(SelectAction::Figure(None));
    session.apply(DisplayEdit::ShowOverlay(Overlay::Frames, true));
    check("frames", &session);
}

#[test]
fn the_yaw_and_the_pitch_of_the_pointer() {
    check("figure_yaw", &lit(LimbFigure::Yaw));
    check("figure_pitch", &lit(LimbFigure::Pitch));
}

#[test]
fn the_coordinates_of_the_elbow() {
    check("figure_elbow", &lit(LimbFigure::Elbow));
}

#[test]
fn a_limb_and_the_angle_at_the_elbow() {
    check("figure_upper", &lit(LimbFigure::Upper));
    check("figure_elbow_angle", &lit(LimbFigure::ElbowAngle));
}
