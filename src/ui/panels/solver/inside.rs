//! The parts of one iteration: a slider through them, switches for their marks in the view, and
//! their numbers.

use egui::{Align, Color32, Grid, Layout, RichText, Sense, Slider, Ui, vec2};

use crate::kinematics::chain_ik::{
    AngleChange, Ellipsoid, Gradient, MissedTurn, SolverOptions, StepTaken, SubStep, SubStepKind,
    Turn,
};
use crate::kinematics::skeleton::JointId;
use crate::session::{
    Actions, InsideLayer, Session, SolverAction, SolverEdit, SolverRun, ViewAction,
};
use crate::ui::keyboard::focus;
use crate::ui::widgets::{self, text};
use crate::ui::{commands, style};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(run) = session.solvers().run() else { return };
    switch(ui, run, actions);
    let Some(shown) = run.shown_part() else { return };
    let parts = run.parts();
    slider(ui, run, shown, parts.len(), actions);
    buttons(ui, session, run, actions);
    let title = parts[shown].kind.title();
    ui.add_space(4.0);
    ui.label(RichText::new(title).strong().color(style::accent(ui)));
    legend(ui, session, &parts[shown], actions);
    if run.method().uses_damping() {
        damping(ui, session, actions);
    }
    numbers(ui, session, run, shown);
}

fn switch(ui: &mut Ui, run: &SolverRun, actions: &mut Actions) {
    let is_on = run.shown_part().is_some() || run.is_walking();
    let nothing = match run.shown().iteration {
        _ if run.is_running() => Some("Pause the solver first"),
        0 => Some("Make an iteration first: press Step"),
        _ => None,
    };
    let tooltip = "Show what the method computes in this iteration (Shift .)";
    let changed = widgets::check_box(ui, "Look inside", tooltip, is_on, nothing);
    actions.extend(changed.map(|is_on| {
        let part = is_on.then_some(0);
        SolverAction::ShowPart { iteration: run.shown().iteration, part }
    }));
}

fn slider(ui: &mut Ui, run: &SolverRun, shown: usize, count: usize, actions: &mut Actions) {
    let mut number = shown + 1;
    ui.horizontal(|ui| {
        let label = ui.label("Part");
        // Room for the numbers of a long sweep, such as "100 / 100".
        const VALUE_WIDTH: f32 = 72.0;
        ui.spacing_mut().slider_width = (ui.available_width() - VALUE_WIDTH).max(40.0);
        // Without a second value the slider could not be laid out.
        let widget = Slider::new(&mut number, 1..=count.max(2)).suffix(format!(" / {count}"));
        let slider = ui.add(widget).labelled_by(label.id);
        focus::leave_letters(ui, slider.id);
        let tooltip = "Show a part of the iteration (Shift , and Shift .)";
        if slider.on_hover_text(tooltip).changed() {
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
        if widgets::wide_button(back, "Back", "Show the part before (Shift ,)", first) {
            actions.extend(commands::previous_part(session));
        }
        let (name, tooltip) = if run.is_walking() {
            ("Stand", "Stop at this part")
        } else {
            ("Walk", "Show the parts of all iterations slowly")
        };
        let disabled = if run.is_walking() { None } else { last };
        if widgets::wide_button(walk, name, tooltip, disabled) {
            actions.push(SolverAction::Walk(!run.is_walking()));
        }
        let tooltip = "Show the next part, or make an iteration (Shift .)";
        if widgets::wide_button(next, "Next", tooltip, last) {
            actions.extend(commands::next_part(session));
        }
    });
}

/// The damping λ, whose effect on the ellipsoid is seen at once.
fn damping(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let options = session.rig().solver;
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
        SolverEdit::SetSolver(SolverOptions { damping, ..options })
    });
}

/// A thing in the view: its colours, its name and what it means.
struct MarkLegend {
    layer: InsideLayer,
    colours: Vec<Color32>,
    name: &'static str,
    meaning: &'static str,
}

fn legend(ui: &mut Ui, session: &Session, part: &SubStep, actions: &mut Actions) {
    let of_turns = (!part.turns.is_empty()).then(|| entry_of_turns(ui, &part.kind));
    for entry in entries(ui, &part.kind).into_iter().chain(of_turns) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let is_shown = session.view().inside_layers().shows(entry.layer);
            let tooltip = format!("Show {}", entry.meaning);
            let changed = widgets::check_box(ui, entry.name, &tooltip, is_shown, None);
            actions.extend(changed.map(|shown| ViewAction::ShowInside(entry.layer, shown)));
            for colour in &entry.colours {
                let (rect, _) = ui.allocate_exact_size(vec2(12.0, 3.0), Sense::hover());
                ui.painter().rect_filled(rect, 1.0, *colour);
            }
        });
        ui.label(RichText::new(text::capitalized(entry.meaning)).weak().small());
    }
}

fn entries(ui: &Ui, kind: &SubStepKind) -> Vec<MarkLegend> {
    let palette = style::palette(ui);
    let axes = palette.axes.map(style::colour).to_vec();
    let (accent, guide) = (style::colour(palette.accent), style::colour(palette.guide));
    let entry = |layer, colours, name, meaning| MarkLegend { layer, colours, name, meaning };
    match kind {
        SubStepKind::Gradient(Gradient { damping, .. }) => {
            let columns = entry(
                InsideLayer::Columns,
                axes,
                "Columns of the Jacobian",
                "where the tip would go per radian of each angle, x, y and z; of the selected joint, or of all",
            );
            let ellipsoid = damping.map(|_| {
                entry(
                    InsideLayer::Ellipsoid,
                    vec![guide, accent],
                    "Manipulability ellipsoid",
                    "how fast the tip can go in each direction, not to scale, and what the damping λ leaves of it",
                )
            });
            [columns].into_iter().chain(ellipsoid).collect()
        }
        SubStepKind::Step(_) => vec![entry(
            InsideLayer::Step,
            vec![accent, guide],
            "Step",
            "how the tip moved, dashed where the Jacobian sent it, and by how much each angle turned; in thin lines, the pose before",
        )],
        SubStepKind::Turn(_) => vec![entry(
            InsideLayer::Rays,
            vec![guide, accent],
            "Rays and arc",
            "the rays from the joint to the tip and to its target, and the turn between them; in thin lines, the pose before",
        )],
        SubStepKind::Backward(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent],
            "Backward pass",
            "the tip at its target and each joint pulled after it, at its distance; the root has left its place",
        )],
        SubStepKind::Forward(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent, guide],
            "Forward pass",
            "after the backward pass, the root back in its place and each joint pushed after it, at its distance",
        )],
        SubStepKind::Relaxed(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent],
            "Points of the joints",
            "each joint where the bones at its ends have moved it: the root in its place, the last bone at its target, and other bones stretched or shortened until the points settle",
        )],
        SubStepKind::LaidOut(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent, guide],
            "Bones laid out",
            "from the root, each bone at its own length towards its point: the pose",
        )],
        SubStepKind::PlaceElbow(_) | SubStepKind::Aim(_) => vec![entry(
            InsideLayer::Triangle,
            vec![accent, guide],
            "Triangle and circle",
            "the triangle of shoulder, elbow and target, and the circle of all elbows; in thin lines, the pose before",
        )],
        _ => Vec::new(),
    }
}

/// The legend of the turns that joints miss.
fn entry_of_turns(ui: &Ui, kind: &SubStepKind) -> MarkLegend {
    let palette = style::palette(ui);
    let (accent, guide) = (style::colour(palette.accent), style::colour(palette.guide));
    let (name, more, meaning) = match kind {
        SubStepKind::Gradient(_) => (
            "Columns of rotation",
            palette.axes.map(style::colour).to_vec(),
            "the turn that the joint misses, as its axis and an arc; thin, the axis about which each angle turns the joint, x, y and z",
        ),
        SubStepKind::Step(_) => (
            "Missing turn",
            vec![guide],
            "the turn that the joint misses after the step, as its axis and an arc; dashed, what the Jacobian predicted",
        ),
        _ => ("Missing turn", Vec::new(), "the turn that the joint misses, as its axis and an arc"),
    };
    MarkLegend { layer: InsideLayer::Turns, colours: [vec![accent], more].concat(), name, meaning }
}

/// Number of angles in a table, so that it stays readable; those that turn most are listed.
const MOST: usize = 12;

fn numbers(ui: &mut Ui, session: &Session, run: &SolverRun, shown: usize) {
    let parts = run.parts();
    let part: &SubStep = &parts[shown];
    ui.add_space(4.0);
    match &part.kind {
        SubStepKind::Gradient(gradient) => jacobian(ui, session, gradient),
        SubStepKind::Step(step) => angles(ui, session, step),
        SubStepKind::Turn(turn) => turned(ui, session, turn),
        _ => {}
    }
    let before = match shown.checked_sub(1) {
        Some(before) => parts[before].error,
        None => {
            let iteration = run.shown().iteration.saturating_sub(1);
            run.iterates().at(iteration).error
        }
    };
    let rows = [("Error before", text::short(before)), ("Error after", text::short(part.error))];
    pairs(ui, "error", &rows);
    missing_turns(ui, session, &part.turns);
}

/// The angles of the turns that joints miss after the part.
fn missing_turns(ui: &mut Ui, session: &Session, turns: &[MissedTurn]) {
    let row = |missed: &MissedTurn| {
        let angle = missed.turn.length().to_degrees();
        [name(session, missed.joint), format!("{angle:.2}°")]
    };
    let rows: Vec<_> = turns.iter().map(row).collect();
    table(ui, "missing turns", ["Joint", "Missing turn"], &rows);
}

/// The lengths of the columns, and the axes of the ellipsoid.
fn jacobian(ui: &mut Ui, session: &Session, gradient: &Gradient) {
    let selection = session.selection().joints();
    let any = gradient.columns.iter().any(|column| selection.contains(&column.joint));
    let shown = gradient.columns.iter().filter(|it| !any || selection.contains(&it.joint));
    let columns = shown.take(MOST).map(|column| {
        let angle = format!("{} {}", name(session, column.joint), column.axis);
        [angle, text::short(column.by.length())]
    });
    let rows: Vec<_> = columns.collect();
    table(ui, "columns", ["Angle", "Column, per radian"], &rows);
    let selected = |joint| !any || selection.contains(&joint);
    let of_turns = gradient.turn_columns.iter().filter(|it| selected(it.joint)).take(MOST);
    let gains = of_turns.map(|column| {
        let angle = format!("{} {}", name(session, column.joint), column.axis);
        [angle, format!("{:+.2}", column.gain)]
    });
    let rows: Vec<_> = gains.collect();
    table(ui, "turn columns", ["Angle", "Of the missing turn, per radian"], &rows);
    if let (Some(damping), [ellipsoid]) = (gradient.damping, &gradient.ellipsoids[..]) {
        singular_values(ui, ellipsoid, damping);
    }
}

fn singular_values(ui: &mut Ui, ellipsoid: &Ellipsoid, damping: f32) {
    let gains = ellipsoid.gains(damping);
    let rows: Vec<[String; 2]> = ellipsoid
        .values
        .iter()
        .zip(gains)
        .map(|(value, gain)| [text::short(*value), format!("{:.0} %", 100.0 * gain)])
        .collect();
    table(ui, "ellipsoid", ["Singular value σ", "Kept: σ²/(σ² + λ²)"], &rows);
    pairs(ui, "damping", &[("Damping λ, as a length", text::short(damping))]);
}

/// Gradient and change of the angles that turn most, and the length of the step.
fn angles(ui: &mut Ui, session: &Session, step: &StepTaken) {
    let mut changes: Vec<&AngleChange> = step.changes.iter().filter(|it| it.by != 0.0).collect();
    changes.sort_by(|one, other| other.by.abs().total_cmp(&one.by.abs()));
    let rows: Vec<[String; 3]> = changes
        .into_iter()
        .take(MOST)
        .map(|change| {
            let limit = if change.is_at_limit { " limit" } else { "" };
            [
                format!("{} {}{limit}", name(session, change.joint), change.axis),
                text::short(change.gradient),
                format!("{:+.2}°", change.by.to_degrees()),
            ]
        })
        .collect();
    table(ui, "angles", ["Angle", "Gradient", "Δθ"], &rows);
    let length = step.length.map(|length| ("Step length τ", text::short(length)));
    let damping = step.damping.map(|damping| ("Damping λ, as a length", text::short(damping)));
    let refused = (step.refused > 0).then(|| ("Refused before", step.refused.to_string()));
    let rows: Vec<_> = [length, damping, refused].into_iter().flatten().collect();
    pairs(ui, "step", &rows);
}

fn turned(ui: &mut Ui, session: &Session, turn: &Turn) {
    let rows = [
        ("Joint", name(session, turn.joint)),
        ("Turned by", format!("{:.2}°", turn.angle.to_degrees())),
    ];
    pairs(ui, "turn", &rows);
}

fn name(session: &Session, joint: JointId) -> String {
    session.skeleton().joint(joint).map_or_else(String::new, |joint| joint.name.clone())
}

fn table<const N: usize>(ui: &mut Ui, id: &str, titles: [&str; N], rows: &[[String; N]]) {
    if rows.is_empty() {
        return;
    }
    Grid::new(id).num_columns(N).spacing(vec2(10.0, 2.0)).show(ui, |ui| {
        for (column, title) in titles.into_iter().enumerate() {
            cell(ui, column, RichText::new(title).weak().small());
        }
        ui.end_row();
        for row in rows {
            for (column, text) in row.iter().enumerate() {
                let text = RichText::new(text);
                cell(ui, column, if column == 0 { text } else { text.monospace() });
            }
            ui.end_row();
        }
    });
    ui.add_space(2.0);
}

fn pairs(ui: &mut Ui, id: &str, rows: &[(&str, String)]) {
    if rows.is_empty() {
        return;
    }
    Grid::new(id).num_columns(2).spacing(vec2(10.0, 2.0)).show(ui, |ui| {
        for (name, value) in rows {
            ui.label(*name);
            widgets::value(ui, value);
            ui.end_row();
        }
    });
}

fn cell(ui: &mut Ui, column: usize, text: RichText) {
    let layout = if column == 0 {
        Layout::left_to_right(Align::Center)
    } else {
        Layout::right_to_left(Align::Center)
    };
    ui.with_layout(layout, |ui| ui.label(text));
}
