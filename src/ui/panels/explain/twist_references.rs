//! Comparison of the twist references: elbow rotation, gain, and holonomy.

use egui::{Align, Grid, Layout, RichText, Ui, vec2};

use crate::document::{Overlay, TwistReferenceKind};
use crate::scene::Palette;
use crate::session::{Actions, Session, ShownLimb, TransportPath, ViewAction};
use crate::ui::widgets::text::capitalized;
use crate::ui::{glossary, labels, style, widgets};
use crate::words::LimbWords;

pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session, limb: &ShownLimb, actions: &mut Actions) {
    let path = session.evaluated().transport_path().filter(|_| limb.frames.uses_ik());
    let Some(path) = path else {
        ui.weak("Not used in FK: switch to IK to compare references.");
        return;
    };
    table(ui, limb, path, actions);
    ui.add_space(4.0);
    transport_path(ui, path, limb.words, actions);
    let (ghosts, globe) = (Overlay::TwistReferences, Overlay::SingularityGlobe);
    let told = "Show the limb with the other twist references";
    let (_, globe_told) = labels::overlay(globe);
    ui.horizontal(|ui| {
        widgets::overlay_check_box(ui, session, ghosts, "Ghosts", told, None, actions);
        let name = "Singularity globe";
        widgets::overlay_check_box(ui, session, globe, name, globe_told, None, actions);
    });
}

/// Shows the colour bar of the singularity globe, on a logarithmic scale of the gain.
pub(in crate::ui) fn globe_legend(ui: &mut Ui, words: LimbWords) {
    ui.label(format!("{} speed by direction", capitalized(words.middle)));
    ui.weak(format!("1×: as fast as the {}", words.end));
    let summary = "Gain: elbow degrees per degree of the Pointer, 0 to 8 and more";
    let (palette, end) = (style::palette(ui), Palette::MAX_GAIN.ln_1p());
    // As clear as the globe, which is clearer in the middle than at its rim.
    const RIM: f32 = 1.6;
    let colour = |place: f32| {
        let colour = palette.gain((place * end).exp_m1());
        style::colour(colour.with_opacity((RIM * colour.channels()[3]).min(1.0)))
    };
    let gains = [(0.0, "0×"), (1.0, "1×"), (2.0, "2×"), (5.0, "5×"), (Palette::MAX_GAIN, "8×+")];
    let marks = gains.map(|(gain, text)| (f32::ln_1p(gain) / end, text));
    widgets::colour_bar(ui, summary, colour, &marks);
}

fn table(ui: &mut Ui, limb: &ShownLimb, path: &TransportPath, actions: &mut Actions) {
    let (frames, middle) = (&limb.frames, limb.words.middle);
    let own = frames.solution.pose;
    let palette = style::palette(ui);
    Grid::new("references").num_columns(3).spacing(vec2(10.0, 4.0)).show(ui, |ui| {
        glossary::term_label(ui, "Twist reference", "Twist reference", actions);
        let right = Layout::right_to_left(Align::Center);
        ui.with_layout(right, |ui| ui.label(RichText::new(capitalized(middle)).weak()));
        ui.with_layout(right, |ui| glossary::term_label(ui, "Gain", "Gain", actions));
        ui.end_row();
        for kind in TwistReferenceKind::ALL {
            let colour = if kind == frames.posed.kind {
                ui.visuals().strong_text_color()
            } else {
                style::colour(palette.twist_reference(kind))
            };
            let name = RichText::new(kind.name()).color(colour);
            ui.label(name).on_hover_text(labels::twist_reference(kind));
            let pose = frames.pose_with_reference(kind, Some(path.transported()));
            let Some((pose, reference)) = pose.zip(frames.reference_of(kind)) else {
                widgets::value(ui, "–").on_hover_text("There is no pole");
                widgets::value(ui, "–");
                ui.end_row();
                continue;
            };
            let turned = format!("Rotation from the current {middle} at the same twist");
            let gain = format!("Degrees of the {middle} per degree of the Pointer");
            widgets::value(ui, turn_in_words(own.elbow_turn_to(&pose))).on_hover_text(turned);
            widgets::value(ui, gain_in_words(reference.gain(own.pointer))).on_hover_text(gain);
            ui.end_row();
        }
    });
}

fn transport_path(ui: &mut Ui, path: &TransportPath, words: LimbWords, actions: &mut Actions) {
    widgets::term_pair(ui, "Holonomy", "Holonomy", actions, |ui, actions| {
        widgets::at_right(ui, |ui| {
            let LimbWords { base, middle, end } = words;
            let tooltip = format!(
                "Rotation of the {middle} after the {end}'s path so far: its solid angle about the {base}"
            );
            let turned = turn_in_words(path.holonomy());
            ui.label(RichText::new(turned).monospace()).on_hover_text(tooltip);
            if widgets::button(ui, "Reset", "Restart the loop from the current pose", None) {
                actions.push(ViewAction::ResetTransport);
            }
        });
    });
}

/// Formats a gain, such as "0.47"; "∞" from 1000.
fn gain_in_words(gain: f32) -> String {
    if gain < 1e3 { format!("{gain:.2}") } else { "∞".to_owned() }
}

/// Formats an angle in degrees, such as "-17.0°"; zero has no sign.
fn turn_in_words(radians: f32) -> String {
    let degrees = radians.to_degrees();
    if degrees.abs() < 0.05 { "0.0°".to_owned() } else { format!("{degrees:+.1}°") }
}
