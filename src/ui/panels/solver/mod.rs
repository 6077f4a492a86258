//! The solver of the skeleton: method, settings, status, convergence and comparison.

mod inside;
mod runs;

use egui::{Align, Button, ComboBox, Layout, RichText, Ui};

use crate::kinematics::chain_ik::{Method, Root, SolverOptions};
use crate::session::{Actions, Session, ShownIteration, SolverAction, SolverEdit};
use crate::ui::widgets::{self, NumberField, text};
use runs::why_not;

/// The method and its settings, a run of it, and the iterations of that run.
pub(in crate::ui) fn solver(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    method(ui, session, actions);
    settings(ui, session, actions);
    buttons(ui, session, actions);
    // The comparison shows its own table.
    if session.solvers().comparison().is_none() {
        report(ui, session, actions);
    }
    if session.solvers().run().is_some() {
        widgets::section(ui, "Inside the iteration", |ui| inside::ui(ui, session, actions));
    }
    widgets::section(ui, "Convergence", |ui| {
        iterations(
            ui,
            session,
            "Press Run to see how the error falls, iteration by iteration.",
            actions,
        );
    });
}

/// All solvers on the same targets.
pub(in crate::ui) fn race(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    runs::race(ui, session, actions);
    let empty =
        "The race runs every solver from the same pose, each as a thin figure in its colour.";
    ui.add_space(4.0);
    iterations(ui, session, empty, actions);
}

/// Shows the errors of the shown runs and the slider through their iterations; without a run,
/// `empty`.
fn iterations(ui: &mut Ui, session: &Session, empty: &str, actions: &mut Actions) {
    let Some(shown) = session.solvers().shown_iteration() else {
        match why_not(session) {
            Some(reason) => ui.label(format!("{reason}.")),
            None => ui.label(empty),
        };
        return;
    };
    ui.weak("Up: error · across: iterations · dashed: tolerance");
    runs::convergence(ui, session);
    runs::iteration(ui, session, shown, actions);
}

fn method(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let options = session.skeleton_rig().solver;
    let combo = ComboBox::from_id_salt("method")
        .selected_text(options.method.title())
        .width(ui.available_width() - 12.0)
        .truncate();
    let response = combo.show_ui(ui, |ui| {
        for method in Method::ALL {
            let item = ui.selectable_label(method == options.method, method.title());
            if item.on_hover_text(method.summary()).clicked() {
                actions.push(SolverEdit::SetSolver(SolverOptions { method, ..options }));
            }
        }
    });
    let response = response.response;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Method"));
    response.on_hover_text(options.method.summary());
}

fn settings(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.skeleton_rig();
    let options = rig.solver;
    let set = |options| SolverEdit::SetSolver(options);
    widgets::pair(ui, "Iterations per frame", |ui| {
        let value = rig.iterations_per_frame as f32;
        let tooltip = "Set the iterations of a running solver per frame";
        NumberField {
            name: "Iterations per frame",
            value,
            unit: "",
            step: 1.0,
            digits: 0,
            tooltip,
        }
        .show(ui, session, actions, |value| {
            SolverEdit::SetIterationsPerFrame(value.round().clamp(1.0, 1000.0) as u32)
        });
    });
    widgets::pair(ui, "Maximum iterations", |ui| {
        let value = options.iterations.unwrap_or_else(|| options.method.budget()) as f32;
        let tooltip = "Stop the solver after this many iterations";
        NumberField { name: "Maximum iterations", value, unit: "", step: 1.0, digits: 0, tooltip }
            .show(ui, session, actions, |value| {
                let iterations = Some(value.round().clamp(1.0, 1e6) as u32);
                set(SolverOptions { iterations, ..options })
            });
    });
    tolerance(ui, session, actions);
    if options.method.uses_damping() {
        widgets::term_pair(ui, "Damping λ", "Damping", actions, |ui, actions| {
            let tooltip = "Set the damping λ, in chain lengths: more is stabler, slower";
            let value = options.damping;
            NumberField { name: "Damping", value, unit: "", step: 0.01, digits: 3, tooltip }.show(
                ui,
                session,
                actions,
                |damping| set(SolverOptions { damping, ..options }),
            );
        });
    }
    if options.method.uses_step() {
        widgets::pair(ui, "Step", |ui| {
            let tooltip = "Set the step, as a fraction of the largest stable one";
            let value = options.step;
            NumberField { name: "Step length", value, unit: "", step: 0.1, digits: 2, tooltip }
                .show(ui, session, actions, |step| set(SolverOptions { step, ..options }));
        });
    }
    roots(ui, options, actions);
}

fn roots(ui: &mut Ui, options: SolverOptions, actions: &mut Actions) {
    let mut chosen = None;
    widgets::pair(ui, "Root", |ui| {
        widgets::at_right(ui, |ui| {
            for root in Root::ALL {
                let (name, tooltip) = match root {
                    Root::Locked => ("Locked", "Keep the roots' angles and positions"),
                    Root::Turns => ("Turns", "Let the solver turn the roots in place"),
                    Root::Free => ("Free", "Let the solver turn and move the roots"),
                };
                let button = Button::selectable(root == options.root, name);
                let button = ui.add(button.frame_when_inactive(true)).on_hover_text(tooltip);
                if button.clicked() && root != options.root {
                    chosen = Some(root);
                }
            }
        });
    });
    let set = |root| SolverEdit::SetSolver(SolverOptions { root, ..options });
    actions.extend(chosen.map(set));
}

fn tolerance(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let options = session.skeleton_rig().solver;
    widgets::term_pair(ui, "Tolerance", "Tolerance", actions, |ui, actions| {
        let auto = session.skeleton_rig().tolerance();
        widgets::at_right(ui, |ui| {
            let mut is_auto = options.tolerance.is_none();
            let tooltip = "Use 1/10,000 of the chain length";
            if ui.checkbox(&mut is_auto, "Auto").on_hover_text(tooltip).changed() {
                let tolerance = (!is_auto).then_some(auto);
                actions.push(SolverEdit::SetSolver(SolverOptions { tolerance, ..options }));
            }
            if let Some(tolerance) = options.tolerance {
                let tooltip = "Set the distance at which a tip has converged";
                let step = 0.05 * tolerance;
                let short = |value: f64| text::short(value as f32);
                NumberField {
                    name: "Tolerance",
                    value: tolerance,
                    unit: "",
                    step,
                    digits: 0,
                    tooltip,
                }
                .show_as(ui, session, actions, &short, |tolerance| {
                    SolverEdit::SetSolver(SolverOptions { tolerance: Some(tolerance), ..options })
                });
            }
        });
    });
}

fn buttons(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let disabled = why_not(session);
    ui.add_space(2.0);
    ui.columns(3, |columns| {
        for column in columns.iter_mut() {
            column.set_min_height(24.0);
        }
        let [run, step, reset] = columns else { return };
        let running = session.solvers().is_running();
        let name = if running { "Pause solver" } else { "Run" };
        if wide(run, name, "Iterate until converged (R)", disabled) {
            actions.push(SolverAction::Run(!running));
        }
        if wide(step, "Step", "Make one iteration (S)", disabled) {
            actions.push(SolverAction::Step);
        }
        let nothing = session.solvers().run().is_none().then_some("The solver has not run yet");
        if wide(reset, "Reset", "End the run and remove its ghost (Esc)", nothing) {
            actions.push(SolverAction::Reset);
        }
    });
}

fn wide(ui: &mut Ui, name: &str, tooltip: &str, disabled: Option<&str>) -> bool {
    let layout = Layout::top_down_justified(Align::Center);
    ui.with_layout(layout, |ui| widgets::button(ui, name, tooltip, disabled)).inner
}

/// Shows the report on the shown iterate or the evaluated pose, at constant height so that nothing
/// below moves.
fn report(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let status = session.solver_status();
    let value = |ui: &mut Ui, text: String| ui.label(RichText::new(text).monospace());
    let none = || "–".to_owned();
    widgets::pair(ui, "Shown", |ui| {
        let shown = match session.solvers().shown_iteration() {
            Some(ShownIteration { number, latest, .. }) => {
                format!("iteration {number} of {latest}")
            }
            None => "evaluated pose".to_owned(),
        };
        ui.label(shown).on_hover_text("The pose that error and status describe")
    });
    widgets::term_pair(ui, "Error", "Error", actions, |ui, _| {
        value(ui, status.map_or_else(none, |status| text::short(status.error)))
            .on_hover_text("Largest distance from a tip to its target")
    });
    widgets::pair(ui, "Status", |ui| {
        ui.label(status.map_or("no target".to_owned(), |status| status.state.to_string()))
    });
}
