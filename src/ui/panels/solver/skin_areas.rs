//! A plot of the area of the skin's cross-section at a joint over time, for each way of blending
//! joints.

use egui::{Stroke, Ui};
use egui_plot::{AxisHints, Line, PlotBounds, PlotPoints, VLine};

use crate::kinematics::skin::Skinning;
use crate::session::{Session, SkinAreas};
use crate::ui::style;
use crate::ui::widgets::{self, plot};

const HEIGHT: f32 = 150.0;

/// Shows the plot.
pub(in crate::ui) fn ui(ui: &mut Ui, session: &Session) {
    let Some(areas) = session.skin_areas() else {
        ui.weak("Select a joint inside the skin to see its cross-section.");
        return;
    };
    let name = session.skeleton_rig().skeleton.joint(areas.joint).map_or("–", |it| &it.name);
    ui.weak(format!(
        "Up: cross-section of the skin at the base of {name}, against the bind pose · across: time"
    ));
    curves(ui, session, areas);
    values(ui, session, areas);
}

fn curves(ui: &mut Ui, session: &Session, areas: &SkinAreas) {
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
    let said = describe(areas, session.playback().time());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &said));
}

/// Shows each way of blending with its colour and the area now.
fn values(ui: &mut Ui, session: &Session, areas: &SkinAreas) {
    let palette = style::palette(ui);
    for (skinning, area) in Skinning::ALL.into_iter().zip(areas.at(session.playback().time())) {
        let colour = style::colour(palette.skinning(skinning));
        widgets::pair(ui, skinning.title(), |ui| {
            ui.colored_label(colour, format!("{:.0} %", 100.0 * area));
        });
    }
}

fn describe(areas: &SkinAreas, time: f64) -> String {
    let now = Skinning::ALL.into_iter().zip(areas.at(time));
    let now = now.map(|(skinning, area)| format!("{} {:.0} %", skinning.title(), 100.0 * area));
    format!("Area of the cross-section: {}", now.collect::<Vec<_>>().join(", "))
}
