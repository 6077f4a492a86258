//! The balance of a figure: a switch, and what its centre of mass goes over.

use egui::{RichText, Ui};
use glam::Vec2;

use crate::document::{BalanceOver, BalanceTarget, Channel};
use crate::rig::BalanceReport;
use crate::session::{Actions, Session, SolverEdit};
use crate::ui::style;
use crate::ui::widgets::{self, Choice, NumberField, Slider, text};

const OVERS: [(bool, &str, &str); 2] = [
    (true, "Feet", "Over the middle of what stands on the ground"),
    (false, "Point", "Over a point on the ground"),
];

/// Shows the balance of a figure with limbs on a body, or with several targets.
pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    let is_body = rig.has_body_to_follow() || rig.targets.len() > 1;
    if !is_body && rig.balance.is_none() {
        return;
    }
    let report = session.posed().evaluated_skeleton().balance.as_ref();
    let mut is_on = rig.balance.is_some();
    ui.horizontal(|ui| {
        let tooltip = "Move the body so that its centre of mass is over the feet or a point";
        if ui.checkbox(&mut is_on, "Keep balance").on_hover_text(tooltip).changed() {
            actions.push(SolverEdit::SetBalance(is_on.then(BalanceTarget::default)));
        }
        if let Some(report) = report {
            widgets::at_right(ui, |ui| distance(ui, session, report));
        }
    });
    let Some(balance) = rig.balance else { return };
    if let Some(error) = report.and_then(|report| report.refused.as_ref()) {
        ui.colored_label(style::accent(ui), format!("Not solved: {error}"));
    }
    influence(ui, session, balance, actions);
    let choice = Choice {
        label: "Over",
        name: "Balance over",
        tooltip: "Choose where the centre of mass should be",
        shown: "",
    };
    if let Some(is_feet) =
        choice.pick(ui, &OVERS, |feet| *feet == (balance.over == BalanceOver::Feet))
    {
        let at = report.and_then(|it| it.over).or(report.map(|it| it.centre)).unwrap_or_default();
        let over = if is_feet { BalanceOver::Feet } else { BalanceOver::Point(at) };
        actions.push(SolverEdit::SetBalance(Some(BalanceTarget { over, ..balance })));
    }
    if let BalanceOver::Point(point) = balance.over {
        place(ui, session, balance, point, actions);
    }
    let weight = NumberField {
        name: "Weight of the balance",
        value: balance.weight,
        unit: "",
        step: 0.1,
        digits: 2,
        tooltip: "Weigh the balance against the targets of the body",
    };
    weight.row(ui, session, "Weight", actions, |weight| {
        let weight = weight.max(f32::MIN_POSITIVE);
        SolverEdit::SetBalance(Some(BalanceTarget { weight, ..balance }))
    });
}

/// Shows how far the centre of mass is from where it should be; a tick if it is there.
fn distance(ui: &mut Ui, session: &Session, report: &BalanceReport) {
    let is_balanced = session.rig().is_balanced(session.posed().evaluated_skeleton());
    if report.over.is_none() {
        ui.weak("in the air").on_hover_text("Nothing stands on the ground");
    } else if !is_balanced {
        let missing = ui.label(RichText::new(text::short(report.error())).monospace());
        missing.on_hover_text("Distance of the centre of mass from where it should be");
    } else {
        ui.weak("balanced").on_hover_text("The centre of mass is where it should be");
    }
}

fn influence(ui: &mut Ui, session: &Session, balance: BalanceTarget, actions: &mut Actions) {
    let slider = Slider {
        name: "Balance influence",
        label: "Influence",
        term: Some("Balance"),
        tooltip: "Blend from the pose without balance at 0 to the balanced one at 1",
        value: balance.influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        channel: Some(Channel::BalanceInfluence),
        ..Slider::default()
    };
    slider.show(ui, session, actions, |influence| {
        let influence = influence.clamp(0.0, 1.0);
        SolverEdit::SetBalance(Some(BalanceTarget { influence, ..balance }))
    });
}

fn place(
    ui: &mut Ui,
    session: &Session,
    balance: BalanceTarget,
    point: Vec2,
    actions: &mut Actions,
) {
    let step = session.shown().grid_cell() * 0.1;
    widgets::pair(ui, "", |ui| {
        let coordinates = [("z", "Balance z", point.y), ("x", "Balance x", point.x)];
        for (index, (label, name, value)) in coordinates.into_iter().enumerate() {
            let field = NumberField {
                name,
                value,
                unit: "",
                step,
                digits: text::decimals(step),
                tooltip: "Move the point under the centre of mass",
            };
            let set = |value| {
                let over = if index == 0 { point.with_y(value) } else { point.with_x(value) };
                let over = BalanceOver::Point(over);
                SolverEdit::SetBalance(Some(BalanceTarget { over, ..balance }))
            };
            field.show(ui, session, actions, set);
            ui.weak(label);
        }
    });
}
