//! Dialogs: about, shortcuts, and questions for a path, a name or a decision.

mod examples;
mod export;
mod files;
mod path;
mod shortcuts;
mod skeleton;

use std::mem::discriminant;

use egui::{
    Align2, Color32, Frame, Grid, Id, Modal, Pos2, Rect, Role, Shadow, Stroke, TextStyle, Ui,
    UiBuilder, WidgetInfo, Window, pos2, vec2,
};

use super::frame_times::Machine;
use super::glossary;
use super::panels::statistics;
use super::widgets::{Icon, IconButton};
use crate::session::{Actions, Dialog, PathDialog, Session, ShellAction};

pub(in crate::ui) fn ui(
    ui: &Ui,
    session: &Session,
    machine: &Machine,
    viewport: Rect,
    actions: &mut Actions,
) {
    let is_new = is_new(ui, session.shell().dialog());
    if !matches!(session.shell().dialog(), Some(Dialog::Examples(_))) {
        examples::forget_pictures(ui);
    }
    let Some(dialog) = session.shell().dialog() else { return };
    if is_new && dialog.is_modal() {
        // Otherwise the focused widget would receive the dialog's first key.
        ui.memory_mut(egui::Memory::stop_text_input);
    }
    let title = match dialog {
        Dialog::About => "About ik-arm",
        Dialog::Shortcuts => "Shortcuts",
        Dialog::Glossary => "Glossary",
        Dialog::Examples(_) => "Examples",
        Dialog::Statistics => "Statistics",
        Dialog::Recover { .. } => "Recover unsaved changes?",
        Dialog::Unsaved { .. } => "Save changes?",
        Dialog::FileChanged { .. } => "Overwrite the changed file?",
        Dialog::Exporting => "Quit while exporting?",
        Dialog::Replace { .. } => "Replace the file?",
        Dialog::Path(PathDialog::SavePicture { .. }) => "Save picture",
        Dialog::Path(PathDialog::Export(_)) => "Export",
        Dialog::Path(PathDialog::Open { .. }) => "Open",
        Dialog::Path(PathDialog::SaveAs { .. }) => "Save as",
        Dialog::Path(PathDialog::LocateSkin { .. }) => "Locate skin",
        Dialog::ChooseContents(_) => "Skeletons and animations",
        Dialog::Rename { .. } => "Rename",
        Dialog::Bake { job: None, .. } => "Bake to keys",
        Dialog::Bake { .. } => "Baking to keys",
        Dialog::DeleteJoints { .. } => "Delete joints",
    };
    if !dialog.is_modal() {
        return beside(ui, title, viewport, actions, |ui| statistics::ui(ui, machine));
    }
    let has_close = matches!(
        dialog,
        Dialog::About | Dialog::Shortcuts | Dialog::Glossary | Dialog::Examples(_)
    );
    let is_page = matches!(dialog, Dialog::Examples(_));
    let closes = modal(ui, title, (has_close, is_page), |ui| match dialog {
        Dialog::About => about(ui, machine),
        Dialog::Shortcuts => shortcuts::ui(ui, session),
        Dialog::Glossary => glossary::dialog(ui, actions),
        Dialog::Examples(group) => examples::ui(ui, *group, actions),
        Dialog::Recover { document, file } => {
            files::recover(ui, document, file.as_deref(), actions);
        }
        Dialog::Unsaved { then } => files::unsaved(ui, session, then, actions),
        Dialog::FileChanged { path } => files::file_changed(ui, path, actions),
        Dialog::Exporting => files::quit_during_export(ui, session, actions),
        Dialog::Replace { path, then, .. } => files::replace(ui, path, then, actions),
        Dialog::Path(PathDialog::SavePicture { path }) => {
            path::ask_path(ui, session, &path::SAVE_PICTURE, (path, None), is_new, actions);
        }
        Dialog::Path(PathDialog::Export(export)) => {
            export::ui(ui, session, export, is_new, actions);
        }
        Dialog::Path(PathDialog::Open { path, problem }) => {
            path::ask_path(ui, session, &path::OPEN, (path, problem.as_deref()), is_new, actions);
        }
        Dialog::Path(PathDialog::SaveAs { path, problem }) => {
            let typed = (path.as_str(), problem.as_deref());
            path::ask_path(ui, session, &path::SAVE_AS, typed, is_new, actions);
        }
        Dialog::Path(PathDialog::LocateSkin { path, problem }) => {
            let typed = (path.as_str(), problem.as_deref());
            path::ask_path(ui, session, &path::LOCATE_SKIN, typed, is_new, actions);
        }
        Dialog::ChooseContents(of_file) => files::choose(ui, of_file, actions),
        Dialog::Rename { joint, name } => {
            skeleton::rename(ui, session, *joint, name, is_new, actions);
        }
        Dialog::Bake { settings, job } => {
            skeleton::bake(ui, session, settings, job.as_ref(), actions);
        }
        Dialog::DeleteJoints { joints } => skeleton::delete_joints(ui, session, joints, actions),
        Dialog::Statistics => {}
    });
    if closes {
        actions.push(ShellAction::CloseDialog);
    }
}

/// True if the open dialog differs in kind from that of the previous frame: true in the first frame
/// of a dialog.
fn is_new(ui: &Ui, dialog: Option<&Dialog>) -> bool {
    let now = dialog.map(|dialog| match dialog {
        Dialog::Path(path) => (discriminant(dialog), Some(discriminant(path))),
        _ => (discriminant(dialog), None),
    });
    let id = Id::unique("open dialog");
    let before = ui.data_mut(|data| *data.get_temp_mut_or_default::<Option<_>>(id));
    ui.data_mut(|data| data.insert_temp(id, now));
    now != before
}

/// Shows `contents` in a modal window, with a cross that closes it if there is nothing to answer.
/// Returns whether the cross was pressed.
///
/// A page covers the whole window and has no edge, since words of the window that an edge cut off would be
/// read. Other dialogs dim the window, so that what they ask about is seen.
fn modal(
    ui: &Ui,
    title: &str,
    (has_close, is_page): (bool, bool),
    contents: impl FnOnce(&mut Ui),
) -> bool {
    let style = ui.global_style();
    let frame = Frame::window(&style).inner_margin(16.0);
    let (frame, backdrop) = if is_page {
        (frame.shadow(Shadow::NONE).stroke(Stroke::NONE), style.visuals.window_fill)
    } else {
        let dimness = if style.visuals.dark_mode { 150 } else { 100 };
        (frame, Color32::from_black_alpha(dimness))
    };
    let id = Id::unique(("dialog", title.to_owned()));
    let area = Modal::default_area(id).fade_in(false);
    let modal = Modal::new(id).area(area).frame(frame).backdrop_color(backdrop);
    let shown = modal.show(ui.ctx(), |ui| {
        if is_page && let Some(heading) = ui.style_mut().text_styles.get_mut(&TextStyle::Heading) {
            heading.size *= 1.5;
        }
        titled(ui, title, has_close, contents)
    });
    shown.inner
}

/// Shows a title above `contents`, with a cross at its right if `has_close`. Returns whether the cross
/// was pressed.
fn titled(ui: &mut Ui, title: &str, has_close: bool, contents: impl FnOnce(&mut Ui)) -> bool {
    ui.response().widget_info(|| WidgetInfo::labeled(Role::Dialog, true, title));
    let top = ui.cursor().min;
    ui.heading(title);
    ui.add_space(8.0);
    contents(ui);
    has_close && close(ui, pos2(ui.min_rect().right(), top.y))
}

/// Shows `contents` in a window that is not modal, so that everything else stays usable. The window
/// is placed at the upper right of the viewport at first; closing the window closes the dialog.
fn beside(
    ui: &Ui,
    title: &str,
    viewport: Rect,
    actions: &mut Actions,
    contents: impl FnOnce(&mut Ui),
) {
    let right = ui.ctx().content_rect().right();
    let window = Window::new(title)
        .title_bar(false)
        .resizable(false)
        .default_width(statistics::WIDTH)
        .pivot(Align2::RIGHT_TOP)
        .default_pos(pos2(right - 8.0, viewport.top() + 8.0));
    let shown = window.show(ui.ctx(), |ui| titled(ui, title, true, contents));
    if shown.and_then(|shown| shown.inner) == Some(true) {
        actions.push(ShellAction::CloseDialog);
    }
}

fn about(ui: &mut Ui, machine: &Machine) {
    ui.set_width(360.0);
    ui.heading(concat!("ik-arm ", env!("CARGO_PKG_VERSION")));
    ui.label("Inverse kinematics of a 3D arm and of skeletons, to pose and to study.");
    ui.add_space(8.0);
    Grid::new("about").num_columns(2).show(ui, |ui| {
        ui.weak("Graphics adapter");
        ui.label(&machine.adapter);
        ui.end_row();
        ui.weak("Licence");
        ui.label("MIT or Apache-2.0");
        ui.end_row();
    });
}

/// Shows a cross whose upper right corner is at a point, and returns whether it was pressed.
fn close(ui: &mut Ui, corner: Pos2) -> bool {
    let rect = Rect::from_min_size(corner - vec2(IconButton::SIZE.x, 0.0), IconButton::SIZE);
    let mut at = ui.new_child(UiBuilder::new().max_rect(rect));
    IconButton::new(Icon::Close, "Close", "Close (Esc)", None).show(&mut at)
}
