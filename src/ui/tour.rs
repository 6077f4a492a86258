//! The tour: its offer at the start, and the card of a step below the view.
//!
//! The card has the text of the step, a question, a task, and at last the result with the answer.
//! After the last step it lists the conclusions of the tour.

use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Align2, Area, Color32, FontId, Frame, Id, Label, Layout, Order, Pos2, Rect, Response,
    RichText, Role, ScrollArea, Sense, Stroke, Ui, WidgetInfo, vec2,
};

use super::viewport::CORNER_AXES;
use super::{commands, style, widgets};
use crate::session::{Actions, Session, TourAction, TourEnd, TourState, TourStep, filled};

/// Distance from the edges of the view, in points.
const MARGIN: f32 = 16.0;

pub(super) fn offer(ui: &Ui, viewport: Rect, actions: &mut Actions) {
    /// Width of the card in a wide view, at most.
    const WIDTH: f32 = 288.0;
    let frame = Frame::window(ui.style());
    // In a narrow view the buttons take two rows, so that the corner axes stay in sight.
    let free = viewport.width() - CORNER_AXES - 2.0 * MARGIN - frame.total_margin().sum().x;
    Area::new(Id::unique("offer of the tour"))
        .order(Order::Middle)
        .pivot(Align2::LEFT_BOTTOM)
        .fixed_pos(viewport.left_bottom() + vec2(MARGIN, -MARGIN))
        .show(ui.ctx(), |ui| {
            frame.show(ui, |ui| {
                ui.set_max_width(free.min(WIDTH));
                contents(ui, actions);
            });
        });
}

fn contents(ui: &mut Ui, actions: &mut Actions) {
    let steps = TourStep::all().len();
    ui.label(RichText::new("New to inverse kinematics?").strong());
    ui.label(format!("See how it works, in {steps} short steps."));
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        let take = widgets::primary_button(ui, "Take the tour", None);
        if take.on_hover_text("Begin the tour; your document is kept").clicked() {
            actions.push(TourAction::Enter(0));
        }
        let examples = ui.button("Examples…");
        if examples.on_hover_text("Choose an example by its picture").clicked() {
            actions.push(commands::show_examples());
        }
        let play = ui.button("Just play");
        if play.on_hover_text("Close this for good; Help → Tour has it too").clicked() {
            actions.push(TourAction::Decline);
        }
    });
}

/// Width from which a card is wide, in points.
const WIDE: f32 = 560.0;
/// Width of the text, which long lines would make hard to read.
const TEXT_WIDTH: f32 = 720.0;

/// Height of the lower row of buttons, with the space around it, in points.
const FOOTER: f32 = 38.0;

/// Height of the card in a window in which it has a width. It is the same for all steps, so that
/// the view does not change its size.
pub(super) fn height(width: f32) -> f32 {
    if width < WIDE { 270.0 } else { 216.0 }
}

/// Unfolds the section of the left panel that a step needs, once, when the step begins. When the
/// tour ends, folds the sections again that it unfolded.
pub(super) fn open_section(ui: &Ui, session: &Session) {
    let shown = Id::unique("step of the tour");
    let now = session.tour().map(TourState::number);
    let before: Option<usize> = ui.data(|data| data.get_temp(shown)).flatten();
    if now == before {
        return widgets::open_section(ui, None);
    }
    ui.data_mut(|data| data.insert_temp(shown, now));
    let step = session.tour().and_then(TourState::step);
    widgets::open_section(ui, step.and_then(|step| step.section));
    if now.is_none() {
        widgets::fold_opened_sections(ui);
    }
    // The sections below take their places in the next frame.
    ui.ctx().request_repaint();
}

/// Shows the card of the step.
pub(super) fn card(ui: &mut Ui, session: &Session, tour: &TourState, actions: &mut Actions) {
    ui.add_space(4.0);
    header(ui, tour, actions);
    // The body comes first, as in the order of reading, and leaves room for the buttons.
    let size = vec2(ui.available_width(), ui.available_height() - FOOTER);
    ui.allocate_ui(size, |ui| {
        ui.set_min_size(size);
        body(ui, session, tour, actions);
    });
    ui.horizontal(|ui| footer(ui, tour, actions));
}

fn header(ui: &mut Ui, tour: &TourState, actions: &mut Actions) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(tour.title()).strong().size(16.0));
        if tour.step().is_some() {
            let (number, all) = (tour.number() + 1, TourStep::all().len());
            ui.label(RichText::new(format!("{number} of {all}")).weak());
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let leave = ui.small_button("Leave");
            if leave.on_hover_text("End the tour and put your document back").clicked() {
                actions.push(TourAction::Leave);
            }
        });
    });
}

fn footer(ui: &mut Ui, tour: &TourState, actions: &mut Actions) {
    let (number, is_end) = (tour.number(), tour.step().is_none());
    let back = ui.add_enabled(number > 0, egui::Button::new("Back"));
    let back = back.on_hover_text("Go to the step before");
    if back.on_disabled_hover_text("This is the first step").clicked() {
        actions.push(TourAction::Enter(number - 1));
    }
    ui.add_space(4.0);
    ui.scope(|ui| progress(ui, tour, actions));
    ui.add_space(4.0);
    let (name, tooltip, action) = if is_end {
        ("Finish", "End the tour and put your document back", TourAction::Leave)
    } else {
        ("Next", "Go to the next card", TourAction::Enter(number + 1))
    };
    let next = if tour.shows_result() || is_end {
        widgets::primary_button(ui, name, None)
    } else {
        ui.button(name)
    };
    if next.on_hover_text(tooltip).clicked() {
        actions.push(action);
    }
}

fn body(ui: &mut Ui, session: &Session, tour: &TourState, actions: &mut Actions) {
    ScrollArea::vertical().id_salt(tour.number()).auto_shrink([false, false]).show(ui, |ui| {
        ui.set_max_width(ui.available_width().min(TEXT_WIDTH));
        ui.spacing_mut().item_spacing.y = 4.0;
        let Some(step) = tour.step() else { return end(ui) };
        if tour.shows_result() {
            return result(ui, session, step, tour.guess());
        }
        paragraph(ui, &filled(step.text, session));
        ui.add_space(4.0);
        match tour.guess() {
            None => question(ui, step, actions),
            Some(_) => task(ui, session, step, actions),
        }
    });
}

fn question(ui: &mut Ui, step: &TourStep, actions: &mut Actions) {
    caption(ui, "Guess first");
    paragraph(ui, step.guess.question);
    ui.horizontal_wrapped(|ui| {
        for (number, answer) in step.guess.answers.iter().enumerate() {
            if ui.button(*answer).on_hover_text("Guess this, then try it").clicked() {
                actions.push(TourAction::Guess(number));
            }
        }
    });
}

fn task(ui: &mut Ui, session: &Session, step: &TourStep, actions: &mut Actions) {
    caption(ui, "Now try it");
    paragraph(ui, &filled(step.task, session));
    ui.horizontal_wrapped(|ui| {
        let demonstrate = ui.small_button("Do it for me");
        if demonstrate.on_hover_text("Show the result without the mouse").clicked() {
            actions.push(TourAction::Demonstrate);
        }
        let colour = ui.visuals().weak_text_color();
        let keys = format!("Without a mouse: {}", step.keyboard);
        ui.add(Label::new(layout(ui, &keys, 12.0, colour)).selectable(false));
    });
}

fn result(ui: &mut Ui, session: &Session, step: &TourStep, guess: Option<usize>) {
    ui.horizontal(|ui| {
        caption(ui, "What happened");
        let mark = match guess {
            None => "Answer",
            Some(guess) if step.guess.is_right(guess) => "Right",
            Some(_) => "Not quite",
        };
        let answer = RichText::new(format!("{mark}: {}", step.guess.right_answer()));
        ui.add(Label::new(answer.strong().size(12.0)).truncate().selectable(false));
    });
    paragraph(ui, &filled(step.result, session));
}

fn end(ui: &mut Ui) {
    let TourEnd { sentences, next, .. } = TourEnd::get();
    ui.spacing_mut().item_spacing.y = 2.0;
    for sentence in *sentences {
        paragraph(ui, &format!("• {sentence}"));
    }
    ui.add_space(4.0);
    paragraph(ui, next);
}

fn caption(ui: &mut Ui, text: &str) {
    let colour = style::accent(ui);
    ui.add(Label::new(RichText::new(text).color(colour).strong().size(12.0)).selectable(false));
}

fn paragraph(ui: &mut Ui, text: &str) {
    let colour = ui.visuals().text_color();
    let label = Label::new(layout(ui, text, 13.5, colour)).selectable(false);
    ui.add(label.wrap());
}

/// Lays out text in which the parts between asterisks stand out.
fn layout(ui: &Ui, text: &str, size: f32, colour: egui::Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    for (number, part) in text.split('*').enumerate() {
        let color = if number % 2 == 1 { ui.visuals().strong_text_color() } else { colour };
        let font_id = FontId::proportional(size);
        let underline = match number % 2 {
            1 => egui::Stroke::new(1.0, ui.visuals().weak_text_color()),
            _ => egui::Stroke::NONE,
        };
        job.append(part, 0.0, TextFormat { font_id, color, underline, ..Default::default() });
    }
    job
}

/// Width and height of a dot's button, in points.
const CELL: f32 = 15.0;

/// Shows a dot for each step: filled where the user has done the task, ringed for the present step.
fn progress(ui: &mut Ui, tour: &TourState, actions: &mut Actions) {
    ui.spacing_mut().item_spacing.x = 0.0;
    for (number, step) in TourStep::all().iter().enumerate() {
        let name = format!("Step {}: {}", number + 1, step.title);
        let is_done = tour.is_done(number);
        let state = if is_done { "done" } else { "not done yet" };
        let dot = dot(ui, number == tour.number(), is_done);
        dot.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
        if dot
            .on_hover_text(format!("Go to step {}, {}: {state}", number + 1, step.title))
            .clicked()
        {
            actions.push(TourAction::Enter(number));
        }
    }
}

fn dot(ui: &mut Ui, is_now: bool, is_done: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(CELL, CELL), Sense::click());
    let accent = style::accent(ui);
    let colour = if is_now || is_done { accent } else { ui.visuals().weak_text_color() };
    let fill = if is_done { colour } else { Color32::TRANSPARENT };
    ui.painter().circle(rect.center(), 3.5, fill, Stroke::new(1.2, colour));
    if is_now || response.has_focus() || response.hovered() {
        ring(ui, rect.center(), colour);
    }
    response
}

fn ring(ui: &Ui, centre: Pos2, colour: Color32) {
    ui.painter().circle_stroke(centre, 6.5, Stroke::new(1.2, colour));
}
