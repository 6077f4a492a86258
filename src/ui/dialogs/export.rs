//! The export dialog.

use std::path::{Path, PathBuf};

use egui::{DragValue, Grid, Id, Ui};

use super::path::{browse, folder, prompt, unless_there};
use crate::export::{ExportOptions, Format};
use crate::io::ExportFrames;
use crate::session::{Actions, EditAction, Export, FileAction, PathDialog, Session, ShellAction};
use crate::ui::widgets::{self, NumberField};

/// A file format with its name, file extension and tooltip.
struct FormatChoice {
    format: Format,
    name: &'static str,
    ending: &'static str,
    tooltip: &'static str,
}

const CHOICES: [FormatChoice; 7] = [
    FormatChoice {
        format: Format::Glb,
        name: "GLB",
        ending: ".glb",
        tooltip: "glTF: a skinned, animated model for Blender, Unity, Unreal, three.js",
    },
    FormatChoice {
        format: Format::Bvh,
        name: "BVH",
        ending: ".bvh",
        tooltip: "Joints and their motion, the motion capture format",
    },
    FormatChoice {
        format: Format::Csv,
        name: "CSV",
        ending: ".csv",
        tooltip: "A table of joint positions, one row a frame",
    },
    FormatChoice {
        format: Format::Obj,
        name: "OBJ",
        ending: ".obj",
        tooltip: "The posed mesh of the skin in the current frame",
    },
    FormatChoice {
        format: Format::Apng,
        name: "Animated PNG",
        ending: ".apng",
        tooltip: "One picture file that plays the motion",
    },
    FormatChoice {
        format: Format::PngSequence,
        name: "PNG sequence",
        ending: "_####.png",
        tooltip: "One picture a frame; #### becomes the frame number",
    },
    FormatChoice {
        format: Format::Png,
        name: "PNG",
        ending: ".png",
        tooltip: "One picture of the current frame",
    },
];

pub(in crate::ui) fn ui(
    ui: &mut Ui,
    session: &Session,
    export: &Export,
    is_new: bool,
    actions: &mut Actions,
) {
    ui.set_width(460.0);
    let path = export.path.to_string_lossy();
    let change = |export: Export| ShellAction::OpenDialog(PathDialog::Export(export).into());
    let ending = ending(ui, export, is_new);
    let chosen = Format::of(&with_ending(&export.path, ending)).ok();
    ui.horizontal_wrapped(|ui| {
        for FormatChoice { format, name, ending, tooltip } in CHOICES {
            let is_chosen = chosen == Some(format);
            let button = egui::Button::selectable(is_chosen, name).frame_when_inactive(true);
            if ui.add(button).on_hover_text(tooltip).clicked() && !is_chosen {
                let path = format!("{}{}", stem(&path), ending).into();
                actions.push(change(Export { path, ..export.clone() }));
            }
        }
    });
    let described = CHOICES.iter().find(|choice| chosen == Some(choice.format));
    ui.weak(described.map_or("The file extension chooses the format", |choice| choice.tooltip));
    ui.add_space(4.0);
    Grid::new("export").num_columns(2).show(ui, |ui| {
        let mut changed = export.clone();
        if chosen.is_some_and(Format::has_frames) {
            let name = ui.label("Frames per second");
            ui.add(widgets::frame_rate(&mut changed.frame_rate)).labelled_by(name.id);
            ui.end_row();
            length(ui, session, export.frame_rate, chosen);
        }
        if chosen.is_some_and(Format::is_picture) {
            let name = ui.label("Size in pixels");
            ui.horizontal(|ui| {
                ui.add(DragValue::new(&mut changed.size.0).range(16..=ExportOptions::MAX_SIDE))
                    .labelled_by(name.id);
                ui.label("×");
                ui.add(DragValue::new(&mut changed.size.1).range(16..=ExportOptions::MAX_SIDE))
                    .labelled_by(name.id);
            });
            ui.end_row();
        }
        if matches!(chosen, Some(Format::Glb | Format::Bvh)) {
            ui.label("Metres per unit");
            let tooltip = "Set the scale for other programs";
            let value = session.document().metres_per_unit();
            NumberField {
                name: "Metres per unit",
                value,
                unit: "",
                step: 0.001,
                digits: 4,
                tooltip,
            }
            .show(ui, session, actions, |metres| EditAction::SetMetres(Some(metres)));
            ui.end_row();
        }
        if changed != *export {
            actions.push(change(changed));
        }
    });
    ui.add_space(4.0);
    let (typed, entered) = prompt(ui, "File", &path, is_new);
    if typed != path {
        actions.push(change(Export { path: typed.clone().into(), ..export.clone() }));
    }
    let path = with_ending(Path::new(typed.trim()), ending);
    let export = Export { path, ..export.clone() };
    folder(ui, session, &PathDialog::Export(export.clone()));
    ui.add_space(4.0);
    buttons(ui, session, &export, entered, actions);
}

/// The ending of the format that was chosen last, which a name without an extension gets.
fn ending(ui: &Ui, export: &Export, is_new: bool) -> &'static str {
    let id = Id::unique("ending of the export");
    let format = Format::of(&export.path).ok();
    let ending = CHOICES.iter().find(|choice| Some(choice.format) == format).map(|it| it.ending);
    let before = if is_new { None } else { ui.data(|data| data.get_temp(id)) };
    let ending = ending.or(before).unwrap_or(CHOICES[0].ending);
    ui.data_mut(|data| data.insert_temp(id, ending));
    ending
}

/// The path with the ending if its name has no extension.
fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let has_extension = path.extension().is_some_and(|extension| !extension.is_empty());
    match path.file_name().filter(|_| !has_extension) {
        Some(name) => {
            let name = name.to_string_lossy();
            path.with_file_name(format!("{}{ending}", name.trim_end_matches('.')))
        }
        None => path.to_owned(),
    }
}

/// Shows the length of the motion, if there is any.
fn length(ui: &mut Ui, session: &Session, frame_rate: f64, format: Option<Format>) {
    ui.label("Length");
    let document = session.document();
    let timeline = document.timeline;
    let frames = match format {
        Some(format) if format.is_picture() => ExportFrames::of_picture(document, Some(frame_rate)),
        _ => ExportFrames::of_pose(document, Some(frame_rate)),
    };
    ui.label(if frames.is_ok_and(|frames| frames.count() > 1) {
        format!("{:.2} s, from {:.2} s", timeline.duration(), timeline.start)
    } else {
        "One frame, no motion".to_owned()
    });
    ui.end_row();
}

fn buttons(ui: &mut Ui, session: &Session, export: &Export, entered: bool, actions: &mut Actions) {
    let why_not = if session.export_job().is_some() {
        Some("Another export is running")
    } else if Format::of(&export.path).is_err() {
        Some("The file extension must name a format")
    } else {
        None
    };
    ui.horizontal(|ui| {
        let accept = widgets::primary_button(ui, "Export", why_not);
        if (accept.clicked() || entered) && why_not.is_none() {
            let back = PathDialog::Export(export.clone());
            let path = session.full_path(&back, &export.path);
            let action = FileAction::Export(Export { path: path.clone(), ..export.clone() });
            actions.push(unless_there(session, path, action, back));
        }
        browse(ui, actions);
        if ui.button("Cancel").clicked() {
            actions.push(ShellAction::CloseDialog);
        }
    });
}

/// The path without the extension of a format and without the placeholder of the frame number,
/// `_####`.
fn stem(path: &str) -> String {
    let path = Path::new(path);
    let has_format = Format::of(path).is_ok();
    let without = if has_format { path.with_extension("") } else { path.to_owned() };
    let without = without.to_string_lossy();
    without.trim_end_matches('#').trim_end_matches('_').to_owned()
}
