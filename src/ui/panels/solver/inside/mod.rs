//! The parts of one iteration: a slider through them, what the view shows of each, and their numbers.

mod legend;
mod numbers;

use egui::{Align, Layout, RichText, Slider, Ui};

use crate::kinematics::chain_ik::{Method, SolverOptions};
use crate::session::{Actions, EditAction, Session, SolverAction, SolverRun};
use crate::ui::keyboard::focus;
use crate::ui::widgets;
use crate::ui::{commands, style};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(run) = session.solver_run() else { return };
    switch(ui, run, actions);
    let Some(shown) = run.shown_part() else { return };
    let parts = run.parts();
    slider(ui, run, shown, parts.len(), actions);
    buttons(ui, session, run, actions);
    let title = parts[shown].kind.title();
    ui.add_space(4.0);
    ui.label(RichText::new(title).strong().color(style::accent(ui)));
    legend::ui(ui, session, &parts[shown].kind, actions);
    if run.method() == Method::DampedLeastSquares {
        damping(ui, session, actions);
    }
    numbers::ui(ui, session, run, shown);
}

fn switch(ui: &mut Ui, run: &SolverRun, actions: &mut Actions) {
    let mut is_on = run.shown_part().is_some() || run.is_walking();
    let nothing = match run.shown().iteration {
        _ if run.is_running() => Some("Pause the solver first"),
        0 => Some("Make an iteration first: press Step"),
        _ => None,
    };
    let check = ui.add_enabled(nothing.is_none(), egui::Checkbox::new(&mut is_on, "Look inside"));
    let check = check.on_hover_text("Show what the method computes in this iteration (Shift .)");
    let check = check.on_disabled_hover_text(nothing.unwrap_or_default());
    if check.changed() {
        let part = is_on.then_some(0);
        actions.push(SolverAction::ShowPart { iteration: run.shown().iteration, part });
    }
}

fn slider(ui: &mut Ui, run: &SolverRun, shown: usize, count: usize, actions: &mut Actions) {
    let mut number = shown + 1;
    ui.horizontal(|ui| {
        let label = ui.label("Part");
        // Room for the numbers of a long sweep, such as "100 / 100".
        const VALUE_WIDTH: f32 = 72.0;
        ui.spacing_mut().slider_width = (ui.available_width() - VALUE_WIDTH).max(40.0);
        // Without a second value the slider could not be laid out.
        let slider = Slider::new(&mut number, 1..=count.max(2)).suffix(format!(" / {count}"));
        let slider = ui.add(slider).labelled_by(label.id);
        focus::leave_letters(ui, slider.id);
        let slider = slider.on_hover_text("Show a part of the iteration (Shift , and Shift .)");
        if slider.changed() {
            let part = Some(number.clamp(1, count) - 1);
            actions.push(SolverAction::ShowPart { iteration: run.shown().iteration, part });
        }
    });
}

fn buttons(ui: &mut Ui, session: &Session, run: &SolverRun, actions: &mut Actions) {
    let first = commands::previous_part(session).is_none().then_some("This is the first part");
    let last = (run.is_over() && commands::next_part(session).is_empty())
        .then_some("This is the last part of the last iteration");
    ui.columns(3, |columns| {
        let [back, walk, next] = columns else { return };
        if wide(back, "Back", "Show the part before (Shift ,)", first) {
            actions.extend(commands::previous_part(session));
        }
        let (name, tooltip) = match run.is_walking() {
            true => ("Stand", "Stop at this part"),
            false => ("Walk", "Show the parts of all iterations slowly"),
        };
        if wide(walk, name, tooltip, if run.is_walking() { None } else { last }) {
            actions.push(SolverAction::Walk(!run.is_walking()));
        }
        if wide(next, "Next", "Show the next part, or make an iteration (Shift .)", last) {
            actions.extend(commands::next_part(session));
        }
    });
}

fn wide(ui: &mut Ui, name: &str, tooltip: &str, disabled: Option<&str>) -> bool {
    let layout = Layout::top_down_justified(Align::Center);
    ui.with_layout(layout, |ui| widgets::button(ui, name, tooltip, disabled)).inner
}

/// The damping λ, whose effect on the ellipsoid is seen at once.
fn damping(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let options = session.skeleton_rig().solver;
    let slider = widgets::Slider {
        name: "Damping of this iteration",
        label: "λ",
        term: Some("Damping"),
        tooltip: "Set the damping λ, in chain lengths: the step turns less along short axes",
        value: options.damping,
        range: (0.001, 0.5),
        default: SolverOptions::default().damping,
        step: 0.01,
        ..widgets::Slider::default()
    };
    slider.show(ui, session, actions, |damping| {
        EditAction::SetSolver(SolverOptions { damping, ..options })
    });
}
