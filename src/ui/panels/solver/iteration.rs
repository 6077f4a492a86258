//! The slider through the iterations of a solver run, and the button that applies the shown pose.

use egui::{Align, Layout, Slider, Ui};

use crate::session::{Actions, EditAction, Session, ShownIteration, SolverAction};
use crate::ui::keyboard::focus;
use crate::ui::widgets;

/// Reason why there is no iteration to show.
const NO_RUN: &str = "Run or step the solver first";

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    slider(ui, session.shown_iteration(), actions);
    apply(ui, session, actions);
}

fn slider(ui: &mut Ui, shown: Option<ShownIteration>, actions: &mut Actions) {
    let (mut number, latest) = shown.map_or((0, 0), |shown| (shown.number, shown.latest));
    let row = ui.add_enabled_ui(shown.is_some(), |ui| {
        ui.horizontal(|ui| {
            let label = ui.label("Iteration");
            let value_width = ui.spacing().interact_size.x + ui.spacing().item_spacing.x;
            ui.spacing_mut().slider_width = (ui.available_width() - value_width).max(40.0);
            // Without a second value the slider could not be laid out.
            let slider = ui.add(Slider::new(&mut number, 0..=latest.max(1))).labelled_by(label.id);
            focus::leave_space(ui, slider.id);
            let slider = slider.on_hover_text("Show the pose of an iteration: 0 is FK (, and .)");
            if slider.changed() {
                actions.push(SolverAction::Show(number));
            }
        });
    });
    row.response.on_disabled_hover_text(NO_RUN);
}

fn apply(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let nothing = if session.comparison().is_some() {
        Some("End the race and run one solver to apply its pose")
    } else {
        match session.solver_run().map(|run| run.shown().iteration) {
            None => Some(NO_RUN),
            Some(0) => Some("Iteration 0 is the FK pose already"),
            Some(_) => None,
        }
    };
    let tooltip = "Write the shown pose to the joints' own angles (FK)";
    let layout = Layout::top_down_justified(Align::Center);
    if ui.with_layout(layout, |ui| widgets::button(ui, "Apply pose", tooltip, nothing)).inner {
        actions.push(EditAction::ApplyPose);
    }
}
