//! What the view shows of a part, as switches in the colours of the view.

use egui::{Color32, RichText, Sense, Ui, vec2};

use crate::kinematics::chain_ik::{Gradient, SubStepKind};
use crate::session::{Actions, InsideLayer, Session, ViewAction};
use crate::ui::style;

/// A thing in the view: its colours, its name and what it means.
struct Entry {
    layer: InsideLayer,
    colours: Vec<Color32>,
    name: &'static str,
    meaning: &'static str,
}

pub(super) fn ui(ui: &mut Ui, session: &Session, kind: &SubStepKind, actions: &mut Actions) {
    for entry in entries(ui, kind) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let mut shown = session.inside_layers().shows(entry.layer);
            let check = ui.checkbox(&mut shown, entry.name);
            for colour in &entry.colours {
                let (rect, _) = ui.allocate_exact_size(vec2(12.0, 3.0), Sense::hover());
                ui.painter().rect_filled(rect, 1.0, *colour);
            }
            if check.on_hover_text(format!("Show {}", entry.meaning)).changed() {
                actions.push(ViewAction::ShowInside(entry.layer, shown));
            }
        });
        ui.label(RichText::new(capitalized(entry.meaning)).weak().small());
    }
}

fn entries(ui: &Ui, kind: &SubStepKind) -> Vec<Entry> {
    let palette = style::palette(ui);
    let axes = palette.axes.map(style::colour).to_vec();
    let (accent, guide) = (style::colour(palette.accent), style::colour(palette.guide));
    let entry = |layer, colours, name, meaning| Entry { layer, colours, name, meaning };
    match kind {
        SubStepKind::Gradient(Gradient { damping, .. }) => {
            let columns = entry(
                InsideLayer::Columns,
                axes,
                "Columns of the Jacobian",
                "where the tip would go per radian of each angle, x, y and z; of the selected joint, or of all",
            );
            let ellipsoid = damping.map(|_| {
                entry(
                    InsideLayer::Ellipsoid,
                    vec![guide, accent],
                    "Ellipsoid of J·Jᵀ",
                    "how fast the tip can go in each direction, not to scale, and what the damping λ leaves of it",
                )
            });
            [columns].into_iter().chain(ellipsoid).collect()
        }
        SubStepKind::Step(_) => vec![entry(
            InsideLayer::Step,
            vec![accent, guide],
            "Step",
            "how the tip moved, dashed where the Jacobian sent it, and by how much each angle turned; in thin lines, the pose before",
        )],
        SubStepKind::Turn(_) => vec![entry(
            InsideLayer::Rays,
            vec![guide, accent],
            "Rays and arc",
            "the rays from the joint to the tip and to its target, and the turn between them; in thin lines, the pose before",
        )],
        SubStepKind::Backward(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent],
            "Backward pass",
            "the tip at its target and each joint pulled after it, at its distance; the root has left its place",
        )],
        SubStepKind::Forward(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent, guide],
            "Forward pass",
            "after the backward pass, the root back in its place and each joint pushed after it, at its distance",
        )],
        SubStepKind::Relaxed(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent],
            "Points of the joints",
            "each joint where the bones at its ends have moved it: the root in its place, the last bone at its target, and other bones stretched or shortened until the points settle",
        )],
        SubStepKind::LaidOut(_) => vec![entry(
            InsideLayer::Passes,
            vec![accent, guide],
            "Bones laid out",
            "from the root, each bone at its own length towards its point: the pose",
        )],
        SubStepKind::PlaceElbow(_) | SubStepKind::Aim(_) => vec![entry(
            InsideLayer::Triangle,
            vec![accent, guide],
            "Triangle and circle",
            "the triangle of shoulder, elbow and target, and the circle of all elbows; in thin lines, the pose before",
        )],
        _ => Vec::new(),
    }
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
