//! The glossary: terms of the user interface, each with two sentences and often a step of the tour.

use std::sync::LazyLock;

use egui::{Label, Response, RichText, ScrollArea, Ui, pos2, vec2};
use serde::Deserialize;

use crate::session::{Actions, ShellAction, TourAction};

/// A term with its meaning.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    /// The term, as on screen.
    pub term: String,
    /// Its meaning, in two sentences.
    pub text: String,
    /// The step of the tour that shows it, counted from 1, if one does.
    step: Option<usize>,
}

static ENTRIES: LazyLock<Vec<Entry>> = LazyLock::new(|| {
    serde_json::from_str(include_str!("../../assets/glossary.json"))
        .unwrap_or_else(|error| unreachable!("a test reads the glossary: {error}"))
});

impl Entry {
    /// All entries, in alphabetical order.
    pub fn all() -> &'static [Self] {
        &ENTRIES
    }

    /// The entry of a term; `None` if the glossary lacks it.
    pub fn find(term: &str) -> Option<&'static Self> {
        Self::all().iter().find(|entry| entry.term == term)
    }

    /// The action that begins the step of the tour; `None` without such a step.
    pub fn show_me(&self) -> Option<TourAction> {
        self.step.map(|step| TourAction::Enter(step.saturating_sub(1)))
    }
}

/// Width of the explanation, in points.
const WIDTH: f32 = 260.0;

/// Shows the name of a term as a label.
pub(super) fn term_label(ui: &mut Ui, name: &str, of: &str, actions: &mut Actions) {
    let label = ui.add(Label::new(name).selectable(false));
    let width = label.rect.width();
    term(ui, label, width, of, actions);
}

/// Underlines a label, whose text is `width` points wide, and shows the meaning of the term `of`
/// while the mouse is over it. A term that the glossary lacks stays a plain label.
pub(super) fn term(ui: &Ui, label: Response, width: f32, of: &str, actions: &mut Actions) {
    let Some(entry) = Entry::find(of) else { return };
    underline(ui, &label, width);
    label.on_hover_ui(|ui| {
        ui.set_max_width(WIDTH);
        ui.label(RichText::new(&entry.term).strong());
        ui.label(&entry.text);
        if let Some(show_me) = entry.show_me()
            && ui.link("Show me").clicked()
        {
            actions.push(show_me);
        }
    });
}

/// Draws dots below the text. They are discs, since egui rounds lines and rectangles of one point
/// to no length.
fn underline(ui: &Ui, label: &Response, width: f32) {
    const RADIUS: f32 = 0.8;
    const SPACING: f32 = 4.0;
    let y = label.rect.center().y + 0.5 * ui.text_style_height(&egui::TextStyle::Body);
    let colour = ui.visuals().weak_text_color();
    for nth in 0..(width / SPACING).ceil() as u32 {
        let x = label.rect.left() + SPACING * nth as f32;
        // In the middle of a pixel, so that all dots look the same.
        ui.painter().circle_filled(pos2(x.round() + 0.5, y.round() - 0.5), RADIUS, colour);
    }
}

pub(super) fn dialog(ui: &mut Ui, actions: &mut Actions) {
    let room = ui.ctx().content_rect().size() - vec2(64.0, 120.0);
    let size = vec2(560.0, 520.0).min(room);
    ui.set_min_size(size);
    ui.set_max_width(size.x);
    ScrollArea::vertical().max_height(size.y).auto_shrink(false).show(ui, |ui| {
        for entry in Entry::all() {
            show(ui, entry, actions);
        }
    });
}

fn show(ui: &mut Ui, entry: &Entry, actions: &mut Actions) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(&entry.term).strong());
        let Some(show_me) = entry.show_me() else { return };
        let link = ui.link("Show me");
        link.widget_info(|| {
            let name = format!("Show me: {}", entry.term);
            egui::WidgetInfo::labeled(egui::Role::Link, true, name)
        });
        if link.on_hover_text("Begin the tour at the step that shows it").clicked() {
            actions.push(ShellAction::CloseDialog);
            actions.push(show_me);
        }
    });
    ui.label(&entry.text);
    ui.add_space(8.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::TourStep;

    #[test]
    fn the_glossary_is_in_alphabetical_order_and_names_steps_of_the_tour() {
        assert!(Entry::all().is_sorted_by(|one, next| one.term < next.term));
        for entry in Entry::all() {
            let is_step = |step| (1..=TourStep::all().len()).contains(&step);
            assert!(entry.step.is_none_or(is_step), "{}", entry.term);
        }
    }

    #[test]
    fn the_glossary_of_the_docs_has_the_same_entries() {
        let docs = include_str!("../../docs/glossary.md");
        let rows: Vec<_> = docs.lines().skip_while(|line| !line.starts_with("| ---")).collect();
        let expected = Entry::all().iter().map(|Entry { term, text, step }| {
            let step = step.map(|step| step.to_string()).unwrap_or_default();
            format!("| {term} | {text} | {step} |")
        });
        assert_eq!(rows[1..], expected.collect::<Vec<_>>());
    }

    /// Terms of the README's table of features.
    #[test]
    fn the_glossary_explains_the_terms_of_the_readme() {
        let readme = include_str!("../../README.md");
        for term in [
            "Auto-key",
            "Baking",
            "BVH",
            "CCD",
            "Damped least squares",
            "Dope sheet",
            "Dual quaternions",
            "FABRIK",
            "FK",
            "Graph editor",
            "IK",
            "Jacobian transpose",
            "Key",
            "Linear blend",
            "Motion trail",
            "Onion skins",
            "Skin",
            "Solver",
            "Spread twist",
            "Target",
            "Two-bone",
            "glTF",
        ] {
            assert!(Entry::find(term).is_some(), "{term}");
            let first = term.split(' ').next().unwrap_or(term).to_lowercase();
            assert!(readme.to_lowercase().contains(&first), "{term} is in the README");
        }
        assert!(readme.contains("(docs/glossary.md)"));
    }

    #[test]
    fn every_entry_has_two_sentences() {
        for entry in Entry::all() {
            assert!(entry.text.ends_with('.'), "{}", entry.term);
            assert_eq!(entry.text.matches(". ").count(), 1, "{}", entry.term);
        }
    }
}
