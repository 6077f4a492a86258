//! The choice of a file's skeletons and animations.

use egui::{Button, ScrollArea, Ui};

use super::first_button::first_button;
use crate::io::{FileAnimation, OpenOptions};
use crate::session::{Actions, FileAction, FileContents, ShellAction};

pub(super) fn choose(ui: &mut Ui, contents: &FileContents, actions: &mut Actions) {
    ui.set_width(380.0);
    let FileContents { path, options, skeletons, animations, animation } = contents;
    let mut open = |options| actions.push(FileAction::Open { path: path.clone(), options });
    if skeletons.len() > 1 {
        ui.strong(format!("{} skeletons", skeletons.len()));
        let first = skeletons.first();
        list(
            ui,
            "skeletons",
            skeletons
                .iter()
                .map(|name| (name.clone(), options.skeleton.as_ref().or(first) == Some(name))),
            |index| {
                open(OpenOptions { skeleton: Some(skeletons[index].clone()), ..options.clone() });
            },
        );
    }
    if animations.len() > 1 {
        ui.strong(format!("{} animations", animations.len()));
        let rows = animations.iter().enumerate();
        let rows = rows.map(|(index, it)| (describe(it), *animation == Some(index)));
        list(ui, "animations", rows, |index| {
            let name = animations[index].name.clone();
            open(OpenOptions { animation: Some(name), ..options.clone() });
        });
    }
    ui.add_space(4.0);
    if first_button(ui, "Keep what is open") {
        actions.push(ShellAction::CloseDialog);
    }
}

/// Shows a list of names, of which the open one is marked, and calls `choose` with the index of
/// another one that was pressed.
fn list(
    ui: &mut Ui,
    id: &str,
    rows: impl Iterator<Item = (String, bool)>,
    mut choose: impl FnMut(usize),
) {
    ScrollArea::vertical().id_salt(id).max_height(240.0).show(ui, |ui| {
        for (index, (name, is_open)) in rows.enumerate() {
            let button = Button::selectable(is_open, &name).truncate();
            if ui.add(button).clicked() && !is_open {
                choose(index);
            }
        }
    });
    ui.add_space(6.0);
}

fn describe(animation: &FileAnimation) -> String {
    let FileAnimation { name, start, end, moving_joints } = animation;
    match moving_joints {
        0 => format!("{name} · moves no joint"),
        1 => format!("{name} · {:.2} s · 1 joint", end - start),
        joints => format!("{name} · {:.2} s · {joints} joints", end - start),
    }
}
