//! The skin of the skeleton: how it is shown, blended and made.

use egui::{Align2, FontId, Rect, Role, Sense, Ui, WidgetInfo, pos2, vec2};

use super::choice::Choice;
use crate::document::{Overlay, Skin};
use crate::kinematics::skin::{SkinShape, Skinning};
use crate::rig::{BoneSkin, SkinSource};
use crate::session::{Actions, EditAction, Session, TransactionAction};
use crate::ui::labels;
use crate::ui::style;
use crate::ui::widgets::{self, Slider};

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let Some(skin) = &session.skeleton_rig().skin else {
        let why_not = (!session.skeleton_rig().has_bones()).then_some("Add a bone first");
        let tooltip = "Give the skeleton a smooth skin around its bones";
        if widgets::button(ui, "Add skin", tooltip, why_not) {
            actions.push(EditAction::AddSkin);
        }
        return;
    };
    shown(ui, session, actions);
    overlays(ui, session, actions);
    skinning(ui, skin, actions);
    let SkinSource::Bones(bones) = &skin.source;
    shape(ui, session, skin, bones, actions);
    colour(ui, session, skin, actions);
    summary(ui, skin);
    if widgets::button(ui, "Remove skin", "Show the bones alone again", None) {
        actions.push(EditAction::SetSkin(None));
    }
}

/// Shows the choice between skin, bones and both.
fn shown(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let display = session.shown().display;
    let now = (display.shows(Overlay::Skin), display.shows(Overlay::Bones));
    let choices = [
        ("Skin", "Show the skin alone", (true, false)),
        ("Bones", "Show the bones alone", (false, now.1)),
        ("Both", "Show the bones through the skin", (true, true)),
    ];
    ui.columns(choices.len(), |columns| {
        for (column, (name, tooltip, (skin, bones))) in columns.iter_mut().zip(choices) {
            let is_now = now == (skin, bones);
            let layout = egui::Layout::top_down_justified(egui::Align::Center);
            column.with_layout(layout, |ui| {
                let button = egui::Button::selectable(is_now, name).frame_when_inactive(true);
                if ui.add(button).on_hover_text(tooltip).clicked() && !is_now {
                    actions.push(EditAction::ShowSkin { skin, bones });
                }
            });
        }
    });
}

fn overlays(ui: &mut Ui, session: &Session, actions: &mut Actions) {
    let all = [Overlay::Wireframe, Overlay::SkinWeights, Overlay::CompareSkinning];
    let is_shown = session.shown().display.shows(Overlay::Skin);
    ui.columns(all.len(), |columns| {
        for (column, overlay) in columns.iter_mut().zip(all) {
            let (name, tooltip) = labels::overlay(session.rig(), overlay);
            let mut on = session.shown().display.shows(overlay);
            let check_box = egui::Checkbox::new(&mut on, name);
            let check_box = column.add_enabled(is_shown, check_box).on_hover_text(tooltip);
            if check_box.on_disabled_hover_text("Show the skin first").changed() {
                actions.push(EditAction::ShowOverlay(overlay, on));
            }
        }
    });
    if is_shown && session.shown().display.shows(Overlay::SkinWeights) {
        match session.selected().and_then(|joint| session.skeleton_rig().skeleton.joint(joint)) {
            Some(joint) => legend(ui, &joint.name),
            None => {
                ui.weak("Select a joint to see its weights.");
            }
        }
    }
}

/// Shows the colour bar of a joint's weights.
fn legend(ui: &mut Ui, joint: &str) {
    const HEIGHT: f32 = 30.0;
    const STEPS: usize = 64;
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let summary = format!("Weight of {joint}, from 0 to 1");
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &summary));
    let (palette, painter) = (style::palette(ui), ui.painter());
    let bar = rect.shrink2(vec2(8.0, 0.0)).with_max_y(rect.top() + 10.0);
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| step as f32 / STEPS as f32);
        let colour = style::colour(palette.weight(0.5 * (from + to)));
        let [left, right] = [from, to].map(|part| bar.left() + part * bar.width());
        painter.rect_filled(Rect::from_x_y_ranges(left..=right, bar.y_range()), 0.0, colour);
    }
    let font = FontId::proportional(12.0);
    for (part, text) in [(0.0, "0"), (0.5, "0.5"), (1.0, "1")] {
        let at = pos2(bar.left() + bar.width() * part, bar.bottom() + 3.0);
        let colour = ui.visuals().weak_text_color();
        painter.text(at, Align2::CENTER_TOP, text, font.clone(), colour);
    }
    response.on_hover_text(summary);
}

fn skinning(ui: &mut Ui, skin: &Skin, actions: &mut Actions) {
    let choices = [
        (Skinning::Linear, "Add the joints' transforms; loses volume where bones twist"),
        (Skinning::DualQuaternion, "Blend rigid motions; keeps the volume, bulges at bends"),
        (Skinning::SpreadTwist, "Spread each bone's roll along it, then blend linearly"),
    ];
    let tooltip = "How a vertex between joints follows them";
    let shown = skin.skinning.title();
    Choice { label: "Blend", name: "Blend", tooltip, shown }.show(ui, |list| {
        for (skinning, tooltip) in choices {
            let is_now = skinning == skin.skinning;
            if list.item(is_now, skinning.title(), tooltip, None) {
                actions.push(EditAction::SetSkin(Some(Skin { skinning, ..skin.clone() })));
            }
        }
    });
}

fn shape(ui: &mut Ui, session: &Session, skin: &Skin, bones: &BoneSkin, actions: &mut Actions) {
    let shape = bones.shape();
    let with = |shape: SkinShape| {
        let source = SkinSource::Bones(bones.with_shape(shape));
        EditAction::SetSkin(Some(Skin { source, ..skin.clone() }))
    };
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

fn colour(ui: &mut Ui, session: &Session, skin: &Skin, actions: &mut Actions) {
    widgets::pair(ui, "Colour", |ui| {
        let mut colour = skin.colour.map(|channel| (channel * 255.0).round() as u8);
        let response = ui.color_edit_button_srgb(&mut colour);
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Skin colour"));
        if response.changed() {
            // The picker is dragged: one undo step from the first change to the release.
            if !session.is_editing() {
                actions.push(TransactionAction::Begin);
            }
            let colour = colour.map(|channel| f32::from(channel) / 255.0);
            actions.push(EditAction::SetSkin(Some(Skin { colour, ..skin.clone() })));
        } else if is_change_open(session) && !ui.input(|input| input.pointer.any_down()) {
            actions.push(TransactionAction::Commit);
        }
        response.on_hover_text("Set the colour of the skin");
    });
}

/// Whether the open transaction, if any, changes the skin.
fn is_change_open(session: &Session) -> bool {
    let label = EditAction::SetSkin(session.skeleton_rig().skin.clone()).label();
    session.is_editing() && session.undo_label() == Some(label)
}

fn summary(ui: &mut Ui, skin: &Skin) {
    // The viewport makes the mesh; the panel does not wait for it.
    match skin.made_mesh() {
        Some(Ok(mesh)) => {
            let mesh = mesh.mesh.mesh();
            let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
            ui.weak(format!("{vertices} vertices, {triangles} triangles"));
        }
        Some(Err(error)) => widgets::error_label(ui, &error.to_string()),
        None => {}
    }
}
