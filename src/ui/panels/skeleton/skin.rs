//! The skin of the skeleton: its display, blending and shape; and a plot of the area of its
//! cross-section at a joint over time, for each way of blending joints.

use std::time::Duration;

use egui::{Stroke, Ui};
use egui_plot::{AxisHints, Line, PlotBounds, PlotPoints, VLine};

use crate::document::{Channel, Overlay, Skin};
use crate::kinematics::skeleton::JointId;
use crate::kinematics::skin::{SkinShape, Skinning};
use crate::rig::{BoneSkin, MeshSkin, SkinMeshError, SkinSource};
use crate::session::{
    Actions, FileAction, PathDialog, Session, SkinAreas, SkinEdit, TransactionAction,
};
use crate::ui::style;
use crate::ui::widgets::{self, Choice, Slider, plot};

/// Shows the section of the skin, with a switch in its title row. It is folded at first, unless the
/// skin is a mesh, which may have to be located or bound.
pub(in crate::ui) fn section(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let skin = session.rig().skin.as_ref();
    let is_mesh = skin.is_some_and(|skin| matches!(skin.source, SkinSource::Mesh(_)));
    let id = if is_mesh { "mesh" } else { "Skin" };
    let mut aside = Actions::new();
    let switch = |ui: &mut Ui| widgets::at_right(ui, |ui| switch(ui, session, &mut aside));
    widgets::named_section_with(ui, id, "Skin", is_mesh, switch, |ui| {
        contents(ui, session, actions);
    });
    actions.extend(aside);
}

/// Shows the switch of the skin: it makes one from the bones if there is none.
fn switch(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let has_skin = session.rig().skin.is_some();
    let is_shown = has_skin && session.shown().display.shows(Overlay::Skin);
    let why_not = (!session.rig().has_bones()).then_some("Add a bone first");
    let tooltip = match has_skin {
        true => "Show the skin in place of the bones",
        false => "Give the skeleton a smooth skin around its bones",
    };
    let edit = |skin| match has_skin {
        true => SkinEdit::ShowSkin { skin, bones: !skin },
        false => SkinEdit::AddSkin,
    };
    let changed = widgets::check_box(ui, "Show skin", tooltip, is_shown, why_not);
    actions.extend(changed.map(edit));
}

fn contents(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(skin) = &session.rig().skin else {
        ui.weak("A smooth mesh around the bones, as thick as their joints.");
        return;
    };
    shown(ui, session, actions);
    details(ui, session, actions);
    if let SkinSource::Mesh(mesh) = &skin.source {
        morphs(ui, session, mesh, actions);
        binding(ui, session, mesh, actions);
        file(ui, mesh, actions);
    }
    widgets::named_folded_section(ui, "skin settings", "Shape and colour", |ui| {
        skinning(ui, skin, actions);
        if let SkinSource::Bones(bones) = &skin.source {
            shape(ui, session, skin, bones, actions);
        }
        colour(ui, session, skin, actions);
        summary(ui, session, skin);
        if widgets::button(ui, "Remove skin", "Show the bones alone again", None) {
            actions.push(SkinEdit::SetSkin(None));
        }
    });
}

/// Shows the choice between skin, bones and both.
fn shown(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let display = session.shown().display;
    let now = (display.shows(Overlay::Skin), display.shows(Overlay::Bones));
    let choices = [
        ((true, false), "Skin", "Show the skin alone"),
        ((false, now.1), "Bones", "Show the bones alone"),
        ((true, true), "Both", "Show the bones through the skin"),
    ];
    let chosen = widgets::segments(ui, now, &choices);
    actions.extend(chosen.map(|(skin, bones)| SkinEdit::ShowSkin { skin, bones }));
}

/// Shows what else is drawn of the skin.
fn details(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let all = [Overlay::Wireframe, Overlay::SkinWeights, Overlay::CompareSkinning];
    let is_shown = session.shown().display.shows(Overlay::Skin);
    let why_not = (!is_shown).then_some("Show the skin first");
    widgets::check_boxes(ui, session, 2, &all, why_not, actions);
    if is_shown && session.shown().display.shows(Overlay::SkinWeights) {
        match session.selection().active().and_then(|joint| session.rig().skeleton.joint(joint)) {
            Some(joint) => legend(ui, &joint.name),
            None => {
                ui.weak("Select a joint to see its weights.");
            }
        }
    }
}

/// Shows the colour bar of a joint's weights.
fn legend(ui: &mut Ui, joint: &str) {
    let summary = format!("Weight of {joint}, from 0 to 1");
    let palette = style::palette(ui);
    let colour = |weight| style::colour(palette.weight(weight));
    widgets::colour_bar(ui, &summary, colour, &[(0.0, "0"), (0.5, "0.5"), (1.0, "1")]);
}

fn skinning(ui: &mut Ui, skin: &Skin, actions: &mut Actions) {
    let choices = [
        (Skinning::Linear, "Add the joints' transforms; loses volume where bones twist"),
        (Skinning::DualQuaternion, "Blend rigid motions; keeps the volume, bulges at bends"),
        (Skinning::SpreadTwist, "Spread each bone's roll along it, then blend linearly"),
    ]
    .map(|(skinning, tooltip)| (skinning, skinning.title(), tooltip));
    let tooltip = "Choose how a vertex between joints follows them";
    let choice = Choice { label: "Blend", name: "Blend", tooltip, shown: "" };
    let chosen = choice.pick(ui, &choices, |skinning| *skinning == skin.skinning);
    let set = |skinning| SkinEdit::SetSkin(Some(Skin { skinning, ..skin.clone() }));
    actions.extend(chosen.map(set));
}

fn shape(ui: &mut Ui, session: &Session, skin: &Skin, bones: &BoneSkin, actions: &mut Actions) {
    let shape = bones.shape();
    let with = |shape: SkinShape| {
        let source = SkinSource::Bones(bones.with_shape(shape));
        SkinEdit::SetSkin(Some(Skin { source, ..skin.clone() }))
    };
    let kinds = [
        (false, "One surface", "Make one surface that bends at the joints"),
        (true, "A body for each joint", "Give each joint a body of its own, as a mannequin has"),
    ];
    let tooltip = "Choose whether the skin bends or has joints";
    let choice = Choice { label: "Kind", name: "Skin kind", tooltip, shown: "" };
    let chosen = choice.pick(ui, &kinds, |is_jointed| *is_jointed == shape.is_jointed);
    actions.extend(chosen.map(|is_jointed| with(SkinShape { is_jointed, ..shape.clone() })));
    let default = SkinShape::default();
    let detail = Slider {
        name: "Skin detail",
        label: "Detail",
        tooltip: "Set the number of grid cells on the smallest radius",
        value: shape.detail,
        range: (SkinShape::LEAST_DETAIL, 4.0),
        default: default.detail,
        step: 0.1,
        ..Slider::default()
    };
    detail.show(ui, session, actions, |detail| {
        let detail = detail.clamp(SkinShape::LEAST_DETAIL, SkinShape::MOST_DETAIL);
        with(SkinShape { detail, ..shape.clone() })
    });
    let thickness = Slider {
        name: "Skin thickness",
        label: "Thickness",
        tooltip: "Set the factor of all radii",
        value: shape.thickness,
        range: (0.25, 3.0),
        default: default.thickness,
        step: 0.05,
        ..Slider::default()
    };
    thickness.show(ui, session, actions, |thickness| {
        with(SkinShape { thickness: thickness.max(1e-3), ..shape.clone() })
    });
}

/// Shows the weights of the morph targets.
fn morphs(ui: &mut Ui, session: &Session, mesh: &MeshSkin, actions: &mut Actions) {
    let Some(in_file) = mesh.in_file() else { return };
    let morphs = in_file.mesh.morphs();
    if morphs.is_empty() {
        return;
    }
    let title = format!("Morph targets ({})", morphs.len());
    widgets::named_folded_section(ui, "morph targets", &title, |ui| {
        for (morph, target) in (0..).zip(morphs) {
            let weight = Slider {
                name: &target.name,
                label: &target.name,
                tooltip: "Blend the mesh into the shape of this morph target",
                value: mesh.morph_weight(morph.into()).unwrap_or_default(),
                range: (0.0, 1.0),
                default: 0.0,
                step: 0.05,
                channel: Some(Channel::Morph(morph)),
                ..Slider::default()
            };
            weight.show(ui, session, actions, |weight| SkinEdit::SetMorph { morph, weight });
        }
    });
}

/// Tooltip of the button that binds a mesh.
pub(in crate::ui) const BIND: &str =
    "Let the mesh follow the bones, by their distances inside it; replaces its weights";

/// Shows the buttons that let the mesh follow the bones, or its first joint alone.
fn binding(ui: &mut Ui, session: &Session, mesh: &MeshSkin, actions: &mut Actions) {
    if mesh.in_file().is_none() {
        return;
    }
    ui.horizontal(|ui| {
        let why_not = (!session.rig().has_bones()).then_some("Add a bone first");
        if widgets::button(ui, "Bind", BIND, why_not) {
            actions.push(SkinEdit::Bind);
        }
        let is_loose = mesh.sole_joint() == Some(JointId::new(0));
        let why_not = is_loose.then_some("The mesh follows the first joint alone");
        let tooltip = "Let the mesh follow the first joint alone, so that others can be placed";
        if widgets::button(ui, "Unbind", tooltip, why_not) {
            actions.push(SkinEdit::Unbind);
        }
    });
}

/// Shows where the mesh comes from.
fn file(ui: &mut Ui, mesh: &MeshSkin, actions: &mut Actions) {
    let Some(file) = mesh.file() else {
        widgets::pair(ui, "Mesh", |ui| {
            ui.label("in this document").on_hover_text("Save writes the mesh with the document");
        });
        return;
    };
    let name = file.path.file_name().unwrap_or(file.path.as_os_str()).to_string_lossy();
    widgets::pair(ui, "Mesh", |ui| {
        let path = file.path.display().to_string();
        ui.add(egui::Label::new(&*name).truncate()).on_hover_text(path);
    });
    let problem = mesh.mesh().err();
    if let Some(problem) = &problem {
        widgets::error_label(ui, &problem.to_string());
    }
    let path = file.path.display().to_string();
    ui.horizontal_wrapped(|ui| {
        if widgets::button(ui, "Locate…", "Take the mesh from another file", None) {
            actions.push(FileAction::AskPath(PathDialog::LocateSkin { path, problem: None }));
        }
        let why_not = problem.map(|_| "Locate the mesh first");
        let tooltip = "Keep the mesh in the document, so that it needs no other file";
        if widgets::button(ui, "Pack skin into file", tooltip, why_not) {
            actions.push(SkinEdit::PackSkin);
        }
    });
}

fn colour(ui: &mut Ui, session: &Session, skin: &Skin, actions: &mut Actions) {
    widgets::pair(ui, "Colour", |ui| {
        let mut colour = skin.colour.map(|channel| (channel * 255.0).round() as u8);
        let response = ui.color_edit_button_srgb(&mut colour);
        widgets::name(ui, &response, "Skin colour");
        if response.changed() {
            // The picker is dragged: one undo step from the first change to the release.
            if !session.history().is_editing() {
                actions.push(TransactionAction::Begin);
            }
            let colour = colour.map(|channel| f32::from(channel) / 255.0);
            actions.push(SkinEdit::SetSkin(Some(Skin { colour, ..skin.clone() })));
        } else if is_change_open(session) && !ui.input(|input| input.pointer.any_down()) {
            actions.push(TransactionAction::Commit);
        }
        response.on_hover_text("Set the colour of the skin");
    });
}

/// True if the open transaction, if any, changes the skin.
fn is_change_open(session: &Session) -> bool {
    let label = SkinEdit::SetSkin(session.rig().skin.clone()).label();
    session.history().is_editing() && session.history().undo_label() == Some(label)
}

fn summary(ui: &mut Ui, session: &Session, skin: &Skin) {
    const SOON: Duration = Duration::from_millis(50);
    // The viewport makes the mesh; the panel does not wait for it.
    match skin.made_mesh() {
        Some(Ok(mesh)) => {
            let mesh = mesh.mesh.mesh();
            let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
            ui.weak(format!("{vertices} vertices, {triangles} triangles"));
        }
        Some(Err(SkinMeshError::Shape(error))) => widgets::error_label(ui, &error.to_string()),
        Some(Err(SkinMeshError::File(_))) => {}
        None => {
            ui.weak("The mesh is made when the skin is shown");
            if session.shown().display.shows(Overlay::Skin) {
                ui.ctx().request_repaint_after(SOON);
            }
        }
    }
}

/// Height of the plot, in points.
const HEIGHT: f32 = 150.0;

/// Shows the plot of the cross-section.
pub(in crate::ui) fn areas(ui: &mut Ui, session: &Session) {
    let Some(areas) = session.skin_areas() else {
        ui.weak("Select a joint inside the skin to see its cross-section.");
        return;
    };
    let name = session.rig().skeleton.joint(areas.joint).map_or("–", |it| &it.name);
    ui.weak(format!(
        "Up: cross-section of the skin at the base of {name}, against the bind pose · across: time"
    ));
    area_curves(ui, session, areas);
    area_values(ui, session, areas);
}

fn area_curves(ui: &mut Ui, session: &Session, areas: &SkinAreas) {
    let palette = style::palette(ui);
    let weak = ui.visuals().weak_text_color();
    let highest = areas.areas.iter().flatten().copied().fold(1.0, f32::max);
    let (start, end) = (areas.times[0], areas.times[areas.times.len() - 1]);
    let bounds = PlotBounds::from_min_max([start, 0.0], [end, f64::from(highest) * 1.08]);
    let response = plot::still("skin areas", HEIGHT)
        .custom_x_axes(vec![plot::axis(ui, AxisHints::new_x(), |time| format!("{time} s"))])
        .custom_y_axes(vec![plot::axis(ui, AxisHints::new_y().min_thickness(36.0), |area| {
            format!("{:.0} %", 100.0 * area)
        })])
        .y_grid_spacer(|_| plot::marks(&[0.0, 0.5, 1.0]))
        .show(ui, |shown| {
            plot::show(shown, bounds);
            let playhead = VLine::new("playhead", session.playback().time());
            shown.vline(playhead.stroke(Stroke::new(1.5, weak)));
            for (skinning, areas_of) in Skinning::ALL.into_iter().zip(&areas.areas) {
                let points = areas.times.iter().zip(areas_of);
                let points: PlotPoints<'_> =
                    points.map(|(time, area)| [*time, f64::from(*area)]).collect();
                let colour = style::colour(palette.skinning(skinning));
                shown.line(Line::new(skinning.title(), points).color(colour).width(2.0));
            }
        })
        .response;
    let said = describe_areas(areas, session.playback().time());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &said));
}

/// Shows each way of blending with its colour and the area now.
fn area_values(ui: &mut Ui, session: &Session, areas: &SkinAreas) {
    let palette = style::palette(ui);
    for (skinning, area) in Skinning::ALL.into_iter().zip(areas.at(session.playback().time())) {
        let colour = style::colour(palette.skinning(skinning));
        widgets::pair(ui, skinning.title(), |ui| {
            ui.colored_label(colour, format!("{:.0} %", 100.0 * area));
        });
    }
}

fn describe_areas(areas: &SkinAreas, time: f64) -> String {
    let now = Skinning::ALL.into_iter().zip(areas.at(time));
    let said = now.map(|(skinning, area)| format!("{} {:.0} %", skinning.title(), 100.0 * area));
    format!("Area of the cross-section: {}", said.collect::<Vec<_>>().join(", "))
}
