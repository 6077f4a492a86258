//! The list of all terms.

use egui::{RichText, ScrollArea, Ui, vec2};

use super::entry::Entry;
use crate::session::{Actions, ShellAction};

pub(in crate::ui) fn dialog(ui: &mut Ui, actions: &mut Actions) {
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
