//! The crowd's window: number of arms, solver, and solve times.

use egui::{Align2, Rect, Slider, Ui, Window, vec2};

use crate::rig::{Crowd, Processor};
use crate::session::{Actions, Session, ViewAction};
use crate::ui::frame_times::Machine;
use crate::ui::widgets::{self, text::grouped};

const WIDTH: f32 = 232.0;

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    viewport: Rect,
    session: &Session,
    machine: &Machine,
    actions: &mut Actions,
) {
    let Some(crowd) = session.crowd() else {
        return;
    };
    let mut open = true;
    Window::new("Crowd")
        .open(&mut open)
        .resizable(false)
        .collapsible(false)
        .pivot(Align2::LEFT_TOP)
        .default_pos(viewport.min + vec2(12.0, 12.0))
        .constrain_to(viewport)
        .default_width(WIDTH)
        .show(ui.ctx(), |ui| {
            count(ui, &crowd, actions);
            ui.add_space(8.0);
            solver(ui, &crowd, actions);
            ui.add_space(8.0);
            figures(ui, &crowd, machine);
            ui.add_space(8.0);
            moving(ui, session, actions);
        });
    if !open {
        actions.push(ViewAction::ShowCrowd(false));
    }
}

fn count(ui: &mut Ui, crowd: &Crowd, actions: &mut Actions) {
    let mut arms = crowd.arms;
    ui.horizontal(|ui| {
        let label = ui.label("Arms");
        ui.spacing_mut().slider_width = 110.0;
        let slider = Slider::new(&mut arms, 1..=Crowd::MOST)
            .logarithmic(true)
            .custom_formatter(|value, _| grouped(value as u64))
            .custom_parser(|text| text.replace(',', "").trim().parse().ok());
        if ui.add(slider).labelled_by(label.id).changed() {
            actions.push(ViewAction::SetCrowdSize(arms));
        }
    });
}

fn solver(ui: &mut Ui, crowd: &Crowd, actions: &mut Actions) {
    let solvers = [
        (Processor::Cpu, "CPU", "Solve in batches on all CPU cores"),
        (Processor::Gpu, "GPU", "Solve in a shader on the GPU"),
    ];
    ui.horizontal(|ui| {
        ui.label("Solver");
        for (processor, name, tooltip) in solvers {
            let button = ui.radio(crowd.processor == processor, name);
            if button.on_hover_text(tooltip).clicked() {
                actions.push(ViewAction::SetCrowdSolver(processor));
            }
        }
    });
}

fn figures(ui: &mut Ui, crowd: &Crowd, machine: &Machine) {
    let times = machine.crowd.filter(|times| times.arms == crowd.arms);
    let solve_ms = times.map(|times| times.solve.as_secs_f64() * 1e3);
    let work_ms = machine.times.last().map(|frame| frame.work().as_secs_f64() * 1e3);
    let rest_ms = work_ms.zip(solve_ms).map(|(work, solve)| (work - solve).max(0.0));
    let per_arm = solve_ms.map(|solve| solve * 1e6 / f64::from(crowd.arms));
    let rows = [
        ("Solve", solve_ms, "ms", "Time to solve all arms"),
        ("Per arm", per_arm, "ns", "Solve time divided by the number of arms"),
        ("Rest of the frame", rest_ms, "ms", "Targets, upload, drawing and panels"),
    ];
    for (name, value, unit, tooltip) in rows {
        ui.horizontal(|ui| {
            ui.label(name).on_hover_text(tooltip);
            let text = value.map_or("–".to_owned(), |value| format!("{value:.2} {unit}"));
            widgets::value(ui, text);
        });
    }
}

fn moving(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let is_moving = session.view().is_crowd_animated();
    let changed = widgets::check_box(ui, "Moving targets", "", is_moving, None);
    actions.extend(changed.map(ViewAction::AnimateCrowd));
}
