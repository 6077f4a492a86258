//! The four swivel references beside each other: how far apart their elbows are, how well each goes
//! here, and what carrying along has made of it.

use egui::{Align, Grid, Layout, RichText, Ui, vec2};

use super::{elbow, row, style};
use crate::document::{Arm, Layer, Swivel};
use crate::kinematics::swivel::Carried;
use crate::session::{Action, Session};

pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let arm = session.arm();
    table(ui, arm, session.journey().carried());
    ui.add_space(4.0);
    journey(ui, session, actions);
    let display = session.shown().display;
    let shown = [
        (Layer::References, "As ghosts", "The arm as the other references would have it"),
        (Layer::Globe, "Globe of gains", "Where the hand would be when the elbow flips: hot"),
    ];
    ui.horizontal(|ui| {
        for (layer, name, tooltip) in shown {
            let mut on = display.shows(layer);
            if ui.checkbox(&mut on, name).on_hover_text(tooltip).changed() {
                actions.push(Action::Show(layer, on));
            }
        }
    });
}

fn table(ui: &mut Ui, arm: &Arm, carried: Carried) {
    let own = arm.solve().pose;
    let palette = style::palette(ui);
    Grid::new("references").num_columns(3).spacing(vec2(10.0, 4.0)).show(ui, |ui| {
        ui.label(RichText::new("Measured from").weak());
        for heading in ["Elbow", "Gain"] {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(heading).weak());
            });
        }
        ui.end_row();
        for swivel in Swivel::ALL {
            let colour = match swivel == arm.swivel {
                true => ui.visuals().strong_text_color(),
                false => style::colour(palette.swivel(swivel)),
            };
            let name = RichText::new(swivel.name()).color(colour);
            ui.label(name).on_hover_text(elbow::describe(swivel));
            let pose = arm.pose_measured_from(swivel, Some(carried));
            let apart = format!("{:+.1}°", own.elbow_turn_to(&pose).to_degrees());
            let gain = arm.reference_of(swivel).gain(own.facing);
            for (value, tooltip) in [
                (apart, "How far its elbow is turned from the arm's, with the same spin"),
                (
                    elbow::gain_in_words(gain),
                    "How far the elbow turns for every degree of the Pointer",
                ),
            ] {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    ui.label(RichText::new(value).monospace()).on_hover_text(tooltip);
                });
            }
            ui.end_row();
        }
    });
}

fn journey(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    row::pair(ui, "Holonomy", |ui| {
        if row::button(ui, "Start here", "Carries along from here", None) {
            actions.push(Action::StartJourney);
        }
        let turned = format!("{:+.1}°", session.journey().holonomy().to_degrees());
        ui.label(RichText::new(turned).monospace()).on_hover_text(
            "What was carried along the hand's way is turned by so much against what goes straight: \
             the solid angle that the way goes around. A hand that comes back does not bring its \
             elbow back",
        );
    });
}
