//! The slider through the iterations of a solver run, and the button that applies the shown pose.

use egui::{Align, Color32, Layout, Slider, Ui};

use crate::session::{Actions, EditAction, Session, ShownIteration, SolverAction};
use crate::ui::keyboard::focus;
use crate::ui::widgets;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    shown: ShownIteration,
    actions: &mut Actions,
) {
    slider(ui, shown, actions);
    apply(ui, session, shown, actions);
}

fn slider(ui: &mut Ui, shown: ShownIteration, actions: &mut Actions) {
    let (mut number, latest) = (shown.number, shown.latest);
    ui.horizontal(|ui| {
        let label = ui.label("Iteration");
        let value_width = number_width(ui, latest) + ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = (ui.available_width() - value_width).max(40.0);
        // Without a second value the slider could not be laid out.
        let slider = ui.add(Slider::new(&mut number, 0..=latest.max(1))).labelled_by(label.id);
        focus::leave_letters(ui, slider.id);
        let slider = slider.on_hover_text("Show the pose of an iteration: 0 is FK (, and .)");
        if slider.changed() {
            actions.push(SolverAction::Show(number));
        }
    });
}

/// Width of the box of a number of up to `most`, in points.
fn number_width(ui: &Ui, most: u32) -> f32 {
    let font = ui.style().drag_value_text_style.resolve(ui.style());
    let text = ui.painter().layout_no_wrap(most.to_string(), font, Color32::PLACEHOLDER);
    let spacing = ui.spacing();
    spacing.interact_size.x.max(text.size().x + 2.0 * spacing.button_padding.x)
}

fn apply(ui: &mut Ui, session: &Session, shown: ShownIteration, actions: &mut Actions) {
    let nothing = match shown.number {
        _ if session.comparison().is_some() => {
            Some("End the race and run one solver to apply its pose")
        }
        0 => Some("Iteration 0 is the FK pose already"),
        _ => None,
    };
    let tooltip = "Write the shown pose to the joints' own angles (FK)";
    let layout = Layout::top_down_justified(Align::Center);
    if ui.with_layout(layout, |ui| widgets::button(ui, "Apply pose", tooltip, nothing)).inner {
        actions.push(EditAction::ApplyPose);
    }
}
