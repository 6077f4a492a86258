//! Checks of scenes: every number is finite.

use glam::Vec3;
use ik_arm::document::Theme;
use ik_arm::scene::{Ball, Line, Scene, Shadow, Solid};
use ik_arm::session::Session;

use crate::soak::{Broken, hold};

pub fn all(session: &Session) -> Result<(), Broken> {
    let scene = Scene::new(session.posed(), &session.overlays(), Theme::Dark);
    let planes = scene.planes;
    let are_planes =
        planes.centre.is_finite() && planes.radius.is_finite() && planes.cell.is_finite();
    hold!(are_planes, "the planes are finite: {planes:?}");
    for solid in scene.solids.iter().chain(&scene.guide_solids) {
        let Solid { transform, shape, .. } = solid;
        let sizes = [shape.length, shape.base_radius, shape.tip_radius].into_iter().all(is_size);
        hold!(transform.is_finite() && sizes, "a solid is finite: {solid:?}");
    }
    for ball in scene.balls.iter().chain(&scene.guide_balls) {
        let Ball { centre, radius, .. } = *ball;
        hold!(centre.is_finite() && is_size(radius), "a ball is finite: {ball:?}");
    }
    for shell in &scene.shells {
        hold!(shell.centre.is_finite() && is_size(shell.radius), "a shell is finite: {shell:?}");
    }
    for Line { from, to, .. } in &scene.lines {
        hold!(from.is_finite() && to.is_finite(), "a line is finite: {from} {to}");
    }
    for label in &scene.labels {
        let is_somewhere = label.at.is_finite() && is_size(label.clearance);
        hold!(is_somewhere, "a label is finite: {label:?}");
    }
    for Shadow { base, tip, base_radius, tip_radius } in &scene.shadows {
        let are_finite = [base, tip].into_iter().all(|end: &Vec3| end.is_finite());
        hold!(are_finite && is_size(*base_radius) && is_size(*tip_radius), "a shadow is finite");
    }
    Ok(())
}

fn is_size(value: f32) -> bool {
    value.is_finite() && value >= 0.0
}
