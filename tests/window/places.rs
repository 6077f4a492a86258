use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use ik_arm::rig::LimbPart;
use ik_arm::session::{Actions, FileAction, Session};
use ik_arm::ui::{self, Machine};

use crate::screen::SIZE;

/// Margin of the test harness around the panels; the window has none.
pub const HARNESS_MARGIN: egui::Vec2 = egui::Vec2::splat(8.0);

/// Positions of widgets in the window, in points, from laying out the same panels without a window.
pub struct Places {
    pub thumb: egui::Pos2,
    pub rail_end: egui::Pos2,
    /// The number box beside the slider.
    pub number: egui::Pos2,
    pub hand: egui::Pos2,
    pub elbow: egui::Pos2,
    /// A point of the viewport with nothing under it.
    pub empty: egui::Pos2,
    /// The middle of the axes in the corner of the viewport.
    pub view_axes: egui::Pos2,
    /// The middle of the Human's head, while that is shown.
    pub head: egui::Pos2,
    /// The pelvis of the Human.
    pub pelvis: egui::Pos2,
    /// The wrists of the Human, where the targets of its arms are.
    pub wrists: [egui::Pos2; 2],
    /// The toes of the Human, whose feet keep their orientation.
    pub toes: [egui::Pos2; 2],
}

impl Places {
    pub fn new() -> Self {
        let session = Session::default();
        let harness = Harness::builder()
            .with_size(egui::vec2(SIZE.0 as f32, SIZE.1 as f32) + 2.0 * HARNESS_MARGIN)
            .with_context_setup(ui::style::install)
            .build_ui(|ui| {
                ui::show(ui, &Session::default(), &Machine::default(), &mut Actions::new());
            });
        let rail = harness.get_by_role_and_label(egui::accesskit::Role::Slider, "Hand x").rect();
        let rail = rail.translate(-HARNESS_MARGIN);
        let number =
            harness.get_by_role_and_label(egui::accesskit::Role::SpinButton, "Hand x value");
        let number = number.rect().center() - HARNESS_MARGIN;
        let viewport = harness
            .get_by(|node| {
                node.role() == egui::accesskit::Role::Image
                    && node.label().is_some_and(|label| label.starts_with("Viewport"))
            })
            .rect()
            .translate(-HARNESS_MARGIN);
        let place_in = |session: &Session, point| {
            let projection = session.camera().projection(viewport.aspect_ratio());
            let at = projection.project(point).expect("in the picture");
            viewport.center() + egui::vec2(at.x, -at.y) * viewport.size() / 2.0
        };
        let place = |point| place_in(&session, point);
        let mut human = Session::default();
        human.apply(FileAction::NewFigure);
        let pose = human.skeleton_pose();
        let joint = |name: &str| human.skeleton().find(name).expect("the Human has this joint");
        let head = joint("head");
        let head = place_in(&human, pose.base(head).midpoint(pose.tip(head)));
        let pelvis = place_in(&human, pose.base(joint("pelvis")));
        let wrists = ["left_forearm", "right_forearm"]
            .map(|forearm| place_in(&human, pose.tip(joint(forearm))));
        let toes = ["left_foot", "right_foot"].map(|foot| place_in(&human, pose.tip(joint(foot))));
        let limb = &session.limb().expect("a limb").frames;
        let track = rail.x_range().shrink(8.5);
        let part = (limb.posed.cursor.x / limb.bones().outer_limit() + 1.0) / 2.0;
        Self {
            thumb: egui::pos2(track.min + part * track.span(), rail.center().y),
            rail_end: egui::pos2(track.min + 0.2 * track.span(), rail.center().y),
            number,
            hand: place(limb.origin(LimbPart::Hand)),
            elbow: place(limb.origin(LimbPart::Elbow)),
            empty: viewport.left_top() + egui::vec2(40.0, 40.0),
            view_axes: viewport.right_bottom() - egui::vec2(63.0, 63.0),
            head,
            pelvis,
            wrists,
            toes,
        }
    }
}
