//! The solver of the skeleton: method, settings, status, convergence and comparison.

mod inside;
mod runs;

use egui::{ComboBox, RichText, Ui};

use crate::kinematics::chain_ik::{Method, Root, SolverOptions};
use crate::kinematics::skeleton::Joint;
use crate::session::{Actions, Session, ShellAction, ShownIteration, SolverAction, SolverEdit};
use crate::ui::widgets::{self, NumberField, text};
use runs::why_not;

/// The method and its settings, a run of it, and the iterations of that run.
pub(in crate::ui) fn solver(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    method(ui, session, actions);
    buttons(ui, session, actions);
    // Who poses limbs does not need them.
    if session.limb().is_some() {
        let id = "settings beside limbs";
        widgets::named_folded_section(ui, id, "Settings", |ui| settings(ui, session, actions));
    } else {
        widgets::section(ui, "Settings", |ui| settings(ui, session, actions));
    }
    // The comparison shows its own table.
    if session.solvers().comparison().is_none() {
        report(ui, session, actions);
    }
    if session.solvers().run().is_some() {
        widgets::section(ui, "Inside the iteration", |ui| inside::ui(ui, session, actions));
    }
    let empty = "Press Run to see how the error falls, iteration by iteration.";
    widgets::section(ui, "Convergence", |ui| iterations(ui, session, empty, actions));
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
    let options = session.rig().solver;
    let combo = ComboBox::from_id_salt("method")
        .selected_text(options.method.title())
        .width(ui.available_width() - 12.0)
        .truncate();
    let list = combo.show_ui(ui, |ui| {
        for method in Method::ALL {
            let item = ui.selectable_label(method == options.method, method.title());
            if item.on_hover_text(method.summary()).clicked() {
                actions.push(SolverEdit::SetSolver(SolverOptions { method, ..options }));
            }
        }
    });
    widgets::name(ui, &list.response, "Method");
    list.response.on_hover_text(options.method.summary());
}

fn settings(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    let options = rig.solver;
    let set = |options| SolverEdit::SetSolver(options);
    let field = |name, value, step, digits, tooltip| NumberField {
        name,
        value,
        unit: "",
        step,
        digits,
        tooltip,
    };
    let (name, tooltip) =
        ("Iterations per frame", "Set the iterations of a running solver per frame");
    let per_frame = field(name, rig.iterations_per_frame as f32, 1.0, 0, tooltip);
    per_frame.row(ui, session, name, actions, |value| {
        SolverEdit::SetIterationsPerFrame(value.round().clamp(1.0, 1000.0) as u32)
    });
    let (name, tooltip) = ("Maximum iterations", "Stop the solver after this many iterations");
    let most = options.iterations.unwrap_or_else(|| options.method.budget());
    field(name, most as f32, 1.0, 0, tooltip).row(ui, session, name, actions, |value| {
        let iterations = Some(value.round().clamp(1.0, 1e6) as u32);
        set(SolverOptions { iterations, ..options })
    });
    tolerance(ui, session, actions);
    if options.method.uses_damping() {
        widgets::term_pair(ui, "Damping λ", "Damping", actions, |ui, actions| {
            let tooltip = "Set the damping λ, in chain lengths: more is stabler, slower";
            let damping = field("Damping", options.damping, 0.01, 3, tooltip);
            let set = |damping| set(SolverOptions { damping, ..options });
            damping.show(ui, session, actions, set);
        });
    }
    if options.method.uses_step() {
        let tooltip = "Set the step, as a fraction of the largest stable one";
        let step = field("Step length", options.step, 0.1, 2, tooltip);
        let set = |step| set(SolverOptions { step, ..options });
        step.row(ui, session, "Step", actions, set);
    }
    roots(ui, options, actions);
    if options.root == Root::Free {
        let tooltip =
            "Set how little free roots move where joints can turn instead, from 0 to 0.99";
        let stiffness = field("Root stiffness", options.root_stiffness, 0.05, 2, tooltip);
        let set = |stiffness: f32| {
            let root_stiffness = stiffness.clamp(0.0, Joint::MAX_STIFFNESS);
            set(SolverOptions { root_stiffness, ..options })
        };
        stiffness.row(ui, session, "Root stiffness", actions, set);
    }
    motion(ui, session, actions);
}

/// Settings of motions: the posture rate, whether frames continue from each other, and the posture of the first.
fn motion(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let rig = session.rig();
    let options = rig.solver;
    widgets::term_pair(ui, "Posture rate", "Posture rate", actions, |ui, actions| {
        let field = NumberField {
            name: "Posture rate",
            value: options.posture_rate,
            unit: "",
            step: 1.0,
            digits: 0,
            tooltip: "Set how fast a motion returns to the joint angles: 0 never, 20 hastily",
        };
        field.show(ui, session, actions, |posture_rate| {
            let posture_rate = posture_rate.max(0.0);
            SolverEdit::SetSolver(SolverOptions { posture_rate, ..options })
        });
    });
    let tooltip = "Solve each frame from its joint angles, not from the frame before. Off by default: \
                   neighbouring frames then find different poses, and joints jump";
    let is_alone = !rig.is_tracked;
    ui.horizontal(|ui| {
        let changed = widgets::check_box(ui, "Each frame by itself", tooltip, is_alone, None);
        actions.extend(changed.map(|is_alone| SolverEdit::SetTracked(!is_alone)));
        widgets::at_right(ui, |ui| {
            let disabled = rig.posture.is_none().then_some("Drags of targets have left no posture");
            let tooltip = "Begin the motion with the pose that is solved from the joint angles";
            if widgets::button(ui, "Reset posture", tooltip, disabled) {
                actions.push(SolverEdit::ResetPosture);
            }
        });
    });
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
                let is_now = root == options.root;
                if widgets::segment(ui, is_now, name, tooltip).clicked() && !is_now {
                    chosen = Some(root);
                }
            }
        });
    });
    let set = |root| SolverEdit::SetSolver(SolverOptions { root, ..options });
    actions.extend(chosen.map(set));
}

fn tolerance(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let options = session.rig().solver;
    widgets::term_pair(ui, "Tolerance", "Tolerance", actions, |ui, actions| {
        let auto = session.rig().tolerance();
        widgets::at_right(ui, |ui| {
            let set = |tolerance| SolverEdit::SetSolver(SolverOptions { tolerance, ..options });
            let tooltip = "Use 1/10,000 of the chain length";
            let is_auto = options.tolerance.is_none();
            let changed = widgets::check_box(ui, "Auto", tooltip, is_auto, None);
            actions.extend(changed.map(|is_auto| set((!is_auto).then_some(auto))));
            if let Some(tolerance) = options.tolerance {
                let short = |value: f64| text::short(value as f32);
                let field = NumberField {
                    name: "Tolerance",
                    value: tolerance,
                    unit: "",
                    step: 0.05 * tolerance,
                    digits: 0,
                    tooltip: "Set the distance at which a tip has converged",
                };
                field.show_as(ui, session, actions, &short, |value| set(Some(value)));
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
        if widgets::wide_button(run, name, "Iterate until converged (R)", disabled) {
            actions.push(SolverAction::Run(!running));
        }
        if widgets::wide_button(step, "Step", "Make one iteration (S)", disabled) {
            actions.push(SolverAction::Step);
        }
        let nothing = session.solvers().run().is_none().then_some("The solver has not run yet");
        let tooltip = "End the run and remove its ghost (Esc)";
        if widgets::wide_button(reset, "Reset", tooltip, nothing) {
            actions.push(SolverAction::Reset);
        }
    });
    start(ui, session, actions);
}

/// Lets runs start from the FK pose, where the motion gives another start.
fn start(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    if !session.posed().carried().is_some_and(|carried| carried.has_body()) {
        return;
    }
    let from_fk = session.preferences().runs_from_fk;
    let tooltip = "Start runs from the joint angles alone, not from the frame before";
    let changed = widgets::check_box(ui, "Start from the FK pose", tooltip, from_fk, None);
    actions.extend(changed.map(ShellAction::RunFromFk));
}

/// Shows the report on the shown iterate or the evaluated pose, at constant height so that nothing
/// below moves.
fn report(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let status = session.solvers().status(session.posed());
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
