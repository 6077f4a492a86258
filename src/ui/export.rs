//! The window that asks what to export, and how.

use std::path::Path;

use egui::{DragValue, Grid, Ui};

use super::dialogs::ask;
use super::row::Field;
use crate::session::{Action, Dialog, Export, Session};

/// A format: its name, the ending of its files, what it is for.
type Format = (&'static str, &'static str, &'static str);

const FORMATS: [Format; 6] = [
    (
        "GLB",
        ".glb",
        "glTF: a skinned, animated model, as Blender, Unity, Unreal and three.js read it",
    ),
    ("BVH", ".bvh", "Joints and their motion, as motion capture has it"),
    ("CSV", ".csv", "The joints' positions at every frame, as a table"),
    ("Animated PNG", ".apng", "The motion as a picture that moves"),
    ("PNG sequence", "_####.png", "A picture of every frame"),
    ("PNG", ".png", "A picture of this moment"),
];

pub(super) fn ui(ui: &mut Ui, session: &Session, export: &Export, actions: &mut Vec<Action>) {
    ui.set_width(460.0);
    let path = export.path.to_string_lossy();
    let change = |export: Export| {
        let Export { path, frame_rate, size } = export;
        let path = path.to_string_lossy().into_owned();
        Action::OpenDialog(Dialog::Export { path, frame_rate, size })
    };
    let chosen = format_of(&path);
    ui.horizontal_wrapped(|ui| {
        for format in FORMATS {
            let (name, ending, tooltip) = format;
            let is_chosen = chosen == Some(format);
            let button = egui::Button::selectable(is_chosen, name).frame_when_inactive(true);
            if ui.add(button).on_hover_text(tooltip).clicked() && !is_chosen {
                let path = format!("{}{ending}", stem(&path)).into();
                actions.push(change(Export { path, ..export.clone() }));
            }
        }
    });
    ui.weak(chosen.map_or("The ending of the path says the format", |(_, _, tooltip)| tooltip));
    ui.add_space(4.0);
    Grid::new("export").num_columns(2).show(ui, |ui| {
        let mut changed = export.clone();
        let name = ui.label("Frames a second");
        ui.add(DragValue::new(&mut changed.frame_rate).range(1..=240)).labelled_by(name.id);
        ui.end_row();
        if chosen.is_some_and(|(_, ending, _)| ending.ends_with("png")) {
            let name = ui.label("Size in pixels");
            ui.horizontal(|ui| {
                ui.add(DragValue::new(&mut changed.size.0).range(16..=8192)).labelled_by(name.id);
                ui.label("×");
                ui.add(DragValue::new(&mut changed.size.1).range(16..=8192)).labelled_by(name.id);
            });
            ui.end_row();
        }
        if chosen.is_some_and(|(_, ending, _)| [".glb", ".bvh"].contains(&ending)) {
            ui.label("Metres in a unit");
            let tooltip = "How long a unit of the scene is for other programs";
            let value = session.document().metres_per_unit();
            Field { name: "Metres in a unit", value, unit: "", step: 0.001, digits: 4, tooltip }
                .show(ui, session, actions, |metres| Action::SetMetres(Some(metres)));
            ui.end_row();
        }
        ui.label("Length");
        let timeline = session.document().timeline;
        let moves = session.document().is_posed_by_time();
        ui.label(match moves {
            true => format!("{:.2} s, from {:.2} s", timeline.duration(), timeline.start),
            false => "One frame: nothing moves".to_owned(),
        });
        ui.end_row();
        if changed != *export {
            actions.push(change(changed));
        }
    });
    ui.add_space(4.0);
    let (typed, entered) = ask(ui, "To", &path);
    if typed != path {
        actions.push(change(Export { path: typed.clone().into(), ..export.clone() }));
    }
    buttons(ui, session, &Export { path: typed.trim().into(), ..export.clone() }, entered, actions);
}

fn buttons(
    ui: &mut Ui,
    session: &Session,
    export: &Export,
    entered: bool,
    actions: &mut Vec<Action>,
) {
    let why_not = if session.job().is_some() {
        Some("Another export is under way")
    } else if format_of(&export.path.to_string_lossy()).is_none() {
        Some("The path's ending must be one of the formats'")
    } else {
        None
    };
    ui.horizontal(|ui| {
        let accept = ui.add_enabled(why_not.is_none(), egui::Button::new("Export"));
        let accept = accept.on_disabled_hover_text(why_not.unwrap_or_default());
        if (accept.clicked() || entered) && why_not.is_none() {
            actions.push(Action::Export(export.clone()));
        }
        if ui.button("Browse…").on_hover_text("The system's own dialog, where it has one").clicked()
        {
            actions.push(Action::ChoosePath);
        }
        if ui.button("Cancel").clicked() {
            actions.push(Action::CloseDialog);
        }
    });
}

/// The format that a path's ending says.
fn format_of(path: &str) -> Option<Format> {
    let lower = path.to_lowercase();
    let is_sequence = lower.ends_with(".png") && stem_name(&lower).contains('#');
    FORMATS.into_iter().find(|(_, ending, _)| match *ending {
        "_####.png" => is_sequence,
        ".png" => lower.ends_with(".png") && !is_sequence,
        ending => lower.ends_with(ending),
    })
}

fn stem_name(path: &str) -> String {
    Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// A path without its ending, and without the places for a frame's number.
fn stem(path: &str) -> String {
    let without = Path::new(path).with_extension("");
    let without = without.to_string_lossy();
    without.trim_end_matches('#').trim_end_matches('_').to_owned()
}
