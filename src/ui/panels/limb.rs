//! Settings of a figure that is one limb: hand, Socket twist, Root, lengths, FK and IK, soft limits,
//! hand orientation.

use core::f32::consts::TAU;

use egui::{Color32, ComboBox, RichText, TextStyle, Ui, vec2};
use glam::Vec3;

use crate::document::{Channel, Document, SkeletonRig, Target, TwistReferenceKind};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{Joint, JointId, RotationAxis};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{LimbSettings, TargetKind};
use crate::session::{
    Actions, JointEdit, PoseMode, Session, ShownLimb, TargetEdit, TransactionAction,
};
use crate::ui::widgets::{
    self, AXES, KeyButton, PointSliders, Slider, angle_slider, euler_sliders, soft_reach_sliders,
    with_axis,
};
use crate::ui::{glossary, labels, style};

/// Maximum of the sliders of a world coordinate, in units of [`Editing::unit`].
///
/// [`Editing::unit`]: crate::session::Editing::unit
const ROOT_RANGE: f32 = 500.0;
/// Range of the length sliders, in units of [`Editing::unit`](crate::session::Editing::unit).
const LENGTH_RANGE: (f32, f32) = (10.0, 1000.0);
const PINNED: &str = "Pinned to world";

/// The limb of a figure that is nothing else, with its target.
#[derive(Clone, Copy)]
pub(in crate::ui) struct SoleLimb<'a> {
    session: &'a Session,
    target: &'a Target,
    settings: LimbSettings,
    shown: &'a ShownLimb,
    joints: Limb,
}

impl<'a> SoleLimb<'a> {
    /// `None` for any other figure.
    pub fn new(session: &'a Session) -> Option<Self> {
        let target = session.rig().sole_limb()?;
        let joints = Limb::ending_at(session.skeleton(), target.joint).ok()?;
        let (settings, shown) = (*target.limb()?, session.limb()?);
        Some(Self { session, target, settings, shown, joints })
    }

    /// The same target of the arm in the default pose, for defaults.
    fn default() -> Target {
        Document::default().rig.targets[0]
    }

    fn uses_ik(&self) -> bool {
        self.target.is_posing()
    }

    fn why_not_ik(&self) -> Option<&'static str> {
        (!self.uses_ik()).then_some(ANGLES_LEAD)
    }

    fn with(&self, settings: LimbSettings) -> TargetEdit {
        TargetEdit::SetTarget(Target { kind: TargetKind::Limb(settings), ..*self.target })
    }

    /// The root of the figure.
    fn root(&self) -> (JointId, &'a Joint) {
        let skeleton = self.session.skeleton();
        let root = skeleton.ancestors(self.joints.upper).last().unwrap_or(self.joints.upper);
        (root, &skeleton[root])
    }
}

/// Shows what poses the limb by IK: the hand and the Socket twist.
pub(in crate::ui) fn ui(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let mut aside = Actions::new();
    let pinned = |ui: &mut Ui| pin(ui, limb, &mut aside);
    widgets::section_with(ui, "Hand", pinned, |ui| hand(ui, limb, actions));
    let reference = |ui: &mut Ui| reference(ui, limb, &mut aside);
    widgets::section_with(ui, "Socket twist", reference, |ui| socket_twist(ui, limb, actions));
    actions.extend(aside);
}

/// Shows all other settings of the limb, folded at first.
pub(in crate::ui) fn more(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    widgets::folded_section(ui, "Root", |ui| root(ui, limb, actions));
    widgets::folded_section(ui, "Lengths", |ui| lengths(ui, limb, actions));
    widgets::folded_section(ui, "FK and IK", |ui| fk_ik(ui, limb, actions));
    widgets::folded_section(ui, "Soft limits", |ui| soft_limits(ui, limb, actions));
    widgets::folded_section(ui, "Hand orientation", |ui| hand_orientation(ui, limb, actions));
}

fn hand(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let (session, target) = (limb.session, limb.target);
    let (outer, unit) = (limb.shown.frames.limits.outer, session.history().unit());
    let default = SoleLimb::default().home;
    let hand = PointSliders {
        name: "Hand",
        labels: AXES,
        value: target.present_home(),
        default,
        range: outer,
        step: unit,
        tooltip: "Move the Cursor, the hand's target, relative to the Root",
        disabled: limb.why_not_ik(),
        channel: None,
    };
    let hand = if target.is_pinned {
        PointSliders {
            default: limb.root().1.offset + default,
            range: outer.max(ROOT_RANGE * unit),
            tooltip: "Move the Cursor, the hand's target, in world space",
            ..hand
        }
    } else {
        hand
    };
    hand.show(ui, session, actions, |home| TargetEdit::SetTarget(target.with_home(home)));
}

/// Shows the switch of the pin and its diamond, which also keys the point that the target has.
fn pin(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    widgets::at_right(ui, |ui| {
        let joint = limb.target.joint;
        let mut is_pinned = limb.target.is_pinned;
        let check = ui
            .checkbox(&mut is_pinned, PINNED)
            .on_hover_text("Keep the hand in place when the Root moves");
        if check.changed() {
            actions.push(TargetEdit::Pin { joint, is_pinned });
        }
        let others = vec![Channel::of_point(limb.target)];
        let key = KeyButton { channel: Channel::Pinned(joint), others };
        key.show(ui, limb.session, PINNED, actions);
    });
}

fn root(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let unit = limb.session.history().unit();
    let (joint, root) = limb.root();
    let sliders = PointSliders {
        name: "Root",
        labels: AXES,
        value: root.offset,
        default: Vec3::ZERO,
        range: ROOT_RANGE * unit,
        step: unit,
        tooltip: "Move the Root, the shoulder, in world space",
        disabled: None,
        channel: None,
    };
    sliders.show(ui, limb.session, actions, |offset| JointEdit::SetOffset { joint, offset });
}

fn lengths(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let palette = style::palette(ui);
    let (default, unit) = (TwoBone::default(), limb.session.history().unit());
    let skeleton = limb.session.skeleton();
    let bones = [
        (
            limb.joints.upper,
            ("Upper length", "Upper d_1", "Set the length from shoulder to elbow"),
            palette.upper,
            default.upper(),
        ),
        (
            limb.joints.lower,
            ("Lower length", "Lower d_2", "Set the length from elbow to hand"),
            palette.lower,
            default.lower(),
        ),
    ];
    for (joint, (name, label, tooltip), colour, default) in bones {
        let slider = Slider {
            name,
            label,
            colour: Some(style::colour(colour)),
            tooltip,
            value: skeleton[joint].axis.length(),
            range: (LENGTH_RANGE.0 * unit, LENGTH_RANGE.1 * unit),
            default,
            step: unit,
            ..Slider::default()
        };
        slider.show(ui, limb.session, actions, |length| JointEdit::SetLength { joint, length });
    }
}

/// Reason shown on controls that act only in IK.
pub(in crate::ui) const ANGLES_LEAD: &str = "Switch to IK to set this";

/// Width in points of each of the two buttons.
const WIDTH: f32 = 33.0;

/// Shows the switch between IK and FK and, if FK has a part in the pose, the joint angles.
fn fk_ik(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    switch(ui, limb, actions);
    if limb.target.influence < 1.0 {
        angles(ui, limb, actions);
    }
}

/// Shows buttons for IK and FK, and the slider that blends between them.
fn switch(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let Target { influence, joint, .. } = *limb.target;
    let modes = [
        (PoseMode::Hand, "IK", 1.0, "Pose by IK (hand → joint angles)"),
        (PoseMode::Angles, "FK", 0.0, "Pose by FK (joint angles → hand)"),
    ];
    let blend = Slider {
        name: "IK influence",
        label: "IK influence",
        tooltip: "Blend from FK at 0 to IK at 1",
        value: influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        ..Slider::default()
    };
    let set = |influence| TargetEdit::SetTarget(Target { influence, ..*limb.target });
    blend.show_after(ui, limb.session, actions, set, |ui, actions| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (mode, name, whole, tooltip) in modes {
            let chosen = influence == whole;
            let button = egui::Button::selectable(chosen, name).frame_when_inactive(true);
            let button = button.min_size(vec2(WIDTH, 0.0));
            if ui.add(button).on_hover_text(tooltip).clicked() && !chosen {
                actions.push(TargetEdit::SwitchPoseMode { joint, mode });
            }
        }
        ui.spacing_mut().item_spacing.x = 8.0;
    });
}

/// A slider of an angle of a joint.
struct AngleRow {
    axis: usize,
    /// 1, or −1 for an angle that is shown with the other sign.
    sign: f32,
    name: String,
    label: String,
    tooltip: &'static str,
    /// Index of the colour of its axis; `None` for a bend.
    colour: Option<usize>,
    range: (f32, f32),
}

/// Rows for the angles of a joint that no limits fix. With the frame of the arm's ball joints they
/// are a yaw about y, a pitch about z and a roll about x.
fn angle_rows(joint: &Joint, part: &str) -> Vec<AngleRow> {
    const WHOLE: (f32, f32) = (-180.0, 180.0);
    let free: Vec<usize> = RotationAxis::ALL
        .into_iter()
        .filter(|axis| !joint.limits.is_fixed(*axis))
        .map(RotationAxis::index)
        .collect();
    if let [axis] = free[..] {
        return vec![AngleRow {
            axis,
            sign: 1.0,
            name: format!("{part} bend"),
            label: "Bend β".to_owned(),
            tooltip: "Bend the elbow: 0° straight, 180° folded",
            colour: None,
            range: (0.0, 180.0),
        }];
    }
    let turns = [
        (2, 1.0, "yaw", "Yaw y", "Turn the Upper limb about the vertical, first", 1),
        (1, -1.0, "pitch", "Pitch z", "Raise the Upper limb, second", 2),
        (0, 1.0, "roll", "Roll x", "Turn the Upper limb about itself, third", 0),
    ];
    if joint.frame == SkeletonRig::BALL_FRAME {
        let rows = turns.into_iter().filter(|turn| free.contains(&turn.0));
        return rows
            .map(|(axis, sign, name, label, tooltip, colour)| AngleRow {
                axis,
                sign,
                name: format!("{part} {name}"),
                label: label.to_owned(),
                tooltip,
                colour: Some(colour),
                range: WHOLE,
            })
            .collect();
    }
    let row = |axis: usize| AngleRow {
        axis,
        sign: 1.0,
        name: format!("{part} angle {}", AXES[axis]),
        label: format!("{part} {}", AXES[axis]),
        tooltip: "Turn the joint about this axis of its frame",
        colour: Some(axis),
        range: WHOLE,
    };
    free.into_iter().map(row).collect()
}

/// Shows sliders of the angles of the upper joint and of the elbow, and a button that sets all to
/// 0.
fn angles(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let skeleton = limb.session.skeleton();
    let colours = style::palette(ui).axes;
    let joints = [(limb.joints.upper, "Shoulder"), (limb.joints.lower, "Elbow")];
    for (joint, part) in joints {
        let own = &skeleton[joint];
        for row in angle_rows(own, part) {
            let slider = Slider {
                label: &row.label,
                colour: row.colour.map(|axis| style::colour(colours[axis])),
                range: row.range,
                ..angle_slider(&row.name, row.tooltip, row.sign * own.rotation[row.axis])
            };
            slider.show(ui, limb.session, actions, |degrees| JointEdit::SetRotation {
                joint,
                rotation: with_axis(own.rotation, row.axis, row.sign * degrees.to_radians()),
            });
        }
    }
    ui.add_space(2.0);
    if widgets::button(ui, "Straighten", "Set all these angles to 0", None) {
        actions.push(TransactionAction::Begin);
        for (joint, _) in joints {
            actions.push(JointEdit::SetRotation { joint, rotation: Vec3::ZERO });
        }
        actions.push(TransactionAction::Commit);
    }
}

/// Least width of the combo box's text, in points.
const COMBO: f32 = 36.0;

fn socket_twist(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let slider = Slider {
        name: "Socket twist",
        label: "Twist",
        tooltip: "Turn the elbow about the Pointer; the hand stays",
        term: Some("Socket twist"),
        value: limb.settings.twist.rem_euclid(TAU).to_degrees(),
        range: (0.0, TAU.to_degrees()),
        default: 0.0,
        unit: "°",
        step: 1.0,
        disabled: limb.why_not_ik(),
        ..Slider::default()
    };
    let set = |degrees: f32| {
        limb.with(LimbSettings { twist: degrees.to_radians().rem_euclid(TAU), ..limb.settings })
    };
    slider.show(ui, limb.session, actions, set);
    if limb.settings.reference == TwistReferenceKind::Pole {
        pole(ui, limb, actions);
    }
}

/// Shows the combo box of the twist references, for the title row of the section, with a label if
/// there is room for both.
fn reference(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    /// Width in points of the section's title with its triangle.
    const TITLE: f32 = 104.0;
    const LABEL: &str = "reference";
    let chosen = limb.settings.reference;
    let spacing = ui.spacing();
    let around = 2.0 * (spacing.button_padding.x + spacing.item_spacing.x);
    let icon = spacing.icon_spacing + spacing.icon_width;
    let needed = TITLE + width(ui, LABEL) + width(ui, chosen.name()).max(COMBO) + icon + around;
    let has_room = ui.available_width() > needed;
    widgets::at_right(ui, |ui| {
        if has_room {
            glossary::term_label(ui, LABEL, "Twist reference", actions);
        }
        choice(ui, limb, actions);
    });
}

/// Width of a text, in points.
fn width(ui: &Ui, text: &str) -> f32 {
    let font = TextStyle::Body.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

fn choice(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let (chosen, joint) = (limb.settings.reference, limb.target.joint);
    let combo = ComboBox::from_id_salt("twist reference").width(60.0).selected_text(chosen.name());
    let response = combo.show_ui(ui, |ui| {
        for reference in TwistReferenceKind::ALL {
            let item = ui.selectable_label(reference == chosen, reference.name());
            let item = item.on_hover_text(labels::twist_reference(reference));
            if item.clicked() && reference != chosen {
                actions.push(TargetEdit::SetReference { joint, reference });
            }
        }
    });
    let response = response.response;
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Twist reference"));
    response.on_hover_text(labels::twist_reference(chosen));
}

fn pole(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let Some((_, pole)) = limb.settings.pole() else { return };
    let default = SoleLimb::default().limb().and_then(|limb| limb.pole);
    let sliders = PointSliders {
        name: "Pole",
        labels: ["Pole x", "Pole y", "Pole z"],
        value: pole,
        default: default.unwrap_or(pole),
        range: limb.shown.frames.bones().outer_limit(),
        step: limb.session.history().unit(),
        tooltip: "Move the Pole, the point that the elbow turns towards",
        disabled: limb.why_not_ik(),
        channel: None,
    };
    sliders.show(ui, limb.session, actions, |pole| {
        limb.with(LimbSettings { pole: Some(pole), ..limb.settings })
    });
}

fn soft_limits(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    soft_reach_sliders(ui, limb.session, "", limb.settings.soft_reach, actions, |soft_reach| {
        limb.with(LimbSettings { soft_reach, ..limb.settings })
    });
}

fn hand_orientation(ui: &mut Ui, limb: SoleLimb<'_>, actions: &mut Actions) {
    let Some(hand) = limb.joints.hand else {
        ui.weak("The limb has no hand");
        return;
    };
    let joint = limb.target.joint;
    let kept = limb.settings.orientation;
    let choices = [
        (false, "Follow forearm", "Turn the hand with the Lower limb"),
        (true, "Keep in world", "Let the target keep the orientation of the hand"),
    ];
    ui.horizontal(|ui| {
        for (is_kept, name, tooltip) in choices {
            if ui.radio(kept.is_some() == is_kept, name).on_hover_text(tooltip).clicked() {
                actions.push(TargetEdit::KeepHand { joint, is_kept });
            }
        }
    });
    let rig: &SkeletonRig = limb.session.rig();
    let name = "Hand rotation";
    let order = AngleOrder::of(&rig.skeleton[hand]);
    match kept {
        Some(angles) => {
            let (tooltip, angles) =
                ("Rotate the hand in the space of its target", order.shown(angles));
            euler_sliders(ui, limb.session, name, tooltip, angles, actions, |angles| {
                let orientation = Some(order.kept(angles));
                limb.with(LimbSettings { orientation, ..limb.settings })
            });
        }
        None => {
            let tooltip = "Rotate the hand relative to the forearm";
            let angles = order.shown(rig.skeleton[hand].rotation);
            euler_sliders(ui, limb.session, name, tooltip, angles, actions, |angles| {
                JointEdit::SetRotation { joint: hand, rotation: order.kept(angles) }
            });
        }
    }
    let roll = rig.hand_roll(limb.session.posed().skeleton(), joint).unwrap_or_default();
    widgets::pair(ui, "Forearm roll τ", |ui| {
        ui.label(RichText::new(format!("{:.1}°", roll.to_degrees())).monospace())
            .on_hover_text("Hand rotation about the forearm, spread along its stripes");
    });
}

/// The order in which the angles of a hand are shown.
#[derive(Clone, Copy)]
enum AngleOrder {
    /// About x, y and z of the joint's frame.
    OfFrame,
    /// Of a hand with the frame of the arm's ball joints: about x, y and z of the forearm.
    OfForearm,
}

impl AngleOrder {
    fn of(hand: &Joint) -> Self {
        if hand.frame == SkeletonRig::BALL_FRAME { Self::OfForearm } else { Self::OfFrame }
    }

    fn shown(self, angles: Vec3) -> Vec3 {
        match self {
            Self::OfFrame => angles,
            Self::OfForearm => Vec3::new(angles.x, angles.z, -angles.y),
        }
    }

    fn kept(self, angles: Vec3) -> Vec3 {
        match self {
            Self::OfFrame => angles,
            Self::OfForearm => Vec3::new(angles.x, -angles.z, angles.y),
        }
    }
}
