//! Settings of the target of a limb: Socket twist, FK and IK, soft limits, hand orientation. Those of a
//! figure that is one limb are hand, Root and lengths, too.

use core::f32::consts::TAU;

use egui::{Color32, ComboBox, RichText, TextStyle, Ui, vec2};
use glam::Vec3;

use crate::document::{Channel, Document, SkeletonRig, Target, TwistReferenceKind};
use crate::kinematics::limb_ik::Limb;
use crate::kinematics::skeleton::{Joint, JointId, RotationAxis};
use crate::kinematics::two_bone::TwoBone;
use crate::rig::{LimbSettings, TargetKind};
use crate::session::{Actions, JointEdit, PoseMode, Session, TargetEdit, TransactionAction};
use crate::ui::panels::skeleton::space;
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

/// A target that poses a limb.
#[derive(Clone, Copy)]
pub(in crate::ui) struct LimbTarget<'a> {
    session: &'a Session,
    target: &'a Target,
    settings: LimbSettings,
    joints: Limb,
    /// True if the figure is this limb and nothing else. Its values then have no diamonds.
    is_alone: bool,
}

impl<'a> LimbTarget<'a> {
    /// `None` for the target of a whole body.
    pub fn new(session: &'a Session, target: &'a Target) -> Option<Self> {
        let joints = target.limb_in(session.skeleton())?;
        let is_alone = session.rig().sole_limb().is_some();
        Some(Self { session, target, settings: *target.limb()?, joints, is_alone })
    }

    /// The limb of a figure that is nothing else.
    pub fn sole(session: &'a Session) -> Option<Self> {
        Self::new(session, session.rig().sole_limb()?)
    }

    /// The same target of the arm in the default pose, for defaults.
    fn default() -> Target {
        Document::default().rig.targets[0]
    }

    fn why_not_ik(&self) -> Option<&'static str> {
        (!self.target.is_posing()).then_some(ANGLES_LEAD)
    }

    /// The channel of a value's diamond.
    fn keyed(&self, channel: Channel) -> Option<Channel> {
        (!self.is_alone).then_some(channel)
    }

    /// Step of the sliders of lengths and positions.
    fn step(&self) -> f32 {
        if self.is_alone {
            self.session.history().unit()
        } else {
            self.session.shown().grid_cell() * 0.1
        }
    }

    fn length(&self) -> f32 {
        let bones = [self.joints.upper, self.joints.lower];
        bones.map(|joint| self.session.skeleton()[joint].axis.length()).iter().sum()
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

/// Shows what poses the only limb of a figure by IK: the hand and the Socket twist.
pub(in crate::ui) fn ui(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    hand_section(ui, limb, actions);
    twist_section(ui, limb, actions);
}

/// Shows the position of the only limb's hand.
pub(in crate::ui) fn hand_section(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let mut aside = Actions::new();
    let pinned = |ui: &mut Ui| {
        widgets::at_right(ui, |ui| pin(ui, limb.session, limb.target, &mut aside));
    };
    widgets::section_with(ui, "Hand", pinned, |ui| hand(ui, limb, actions));
    actions.extend(aside);
}

/// Shows all other settings of the only limb of a figure, folded at first.
pub(in crate::ui) fn more(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    widgets::folded_section(ui, "Limb", |ui| {
        ui.visuals_mut().indent_has_left_vline = false;
        ui.indent("limb", |ui| {
            widgets::folded_section(ui, "Root", |ui| root(ui, limb, actions));
            widgets::folded_section(ui, "Lengths", |ui| lengths(ui, limb, actions));
            widgets::folded_section(ui, "FK and IK", |ui| fk_ik(ui, limb, actions));
            bounds_and_hand(ui, limb, actions);
        });
    });
}

/// Shows the settings that a limb has besides those of every target.
pub(in crate::ui) fn of_figure(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    twist_section(ui, limb, actions);
    bounds_and_hand(ui, limb, actions);
}

/// Shows the Socket twist of a limb.
pub(in crate::ui) fn twist_section(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let mut aside = Actions::new();
    let reference = |ui: &mut Ui| reference(ui, limb, &mut aside);
    widgets::section_with(ui, "Socket twist", reference, |ui| socket_twist(ui, limb, actions));
    actions.extend(aside);
}

fn bounds_and_hand(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    widgets::folded_section(ui, "Soft limits", |ui| soft_limits(ui, limb, actions));
    widgets::folded_section(ui, "Hand orientation", |ui| hand_orientation(ui, limb, actions));
}

fn hand(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let (session, target) = (limb.session, limb.target);
    let Some(outer) = session.limb().map(|limb| limb.frames.limits.outer) else { return };
    let unit = limb.step();
    let default = LimbTarget::default().home;
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

/// Shows the switch of a target's pin with its diamond, which also keys the point that the target
/// has. The pin of a figure that is one limb has a diamond while it is on or has keys.
pub(in crate::ui) fn pin(ui: &mut Ui, session: &Session, target: &Target, actions: &mut Actions) {
    let tooltip = "Keep the target in place when what it is on moves";
    let changed = widgets::check_box(ui, PINNED, tooltip, target.is_pinned, None);
    let joint = target.joint;
    actions.extend(changed.map(|is_pinned| TargetEdit::Pin { joint, is_pinned }));
    let has_key = session.document().keys.has(Channel::Pinned(joint));
    // The arm's other values have no diamonds.
    if session.rig().sole_limb().is_some() && !has_key && !target.is_pinned {
        return;
    }
    let others = vec![Channel::of_point(target)];
    KeyButton { channel: Channel::Pinned(joint), others }.show(ui, session, PINNED, actions);
}

fn root(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let unit = limb.step();
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

fn lengths(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let palette = style::palette(ui);
    let (default, unit) = (TwoBone::default(), limb.step());
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
fn fk_ik(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    influence(ui, limb.session, limb.target, actions);
    if limb.target.influence < 1.0 {
        angles(ui, limb, actions);
    }
}

/// Shows the slider that blends between FK and IK; for a limb, after buttons for the two.
pub(in crate::ui) fn influence(
    ui: &mut Ui,
    session: &Session,
    target: &Target,
    actions: &mut Actions,
) {
    let Target { influence, joint, .. } = *target;
    let modes = [
        (PoseMode::Hand, "IK", 1.0, "Pose by IK (target → joint angles)"),
        (PoseMode::Angles, "FK", 0.0, "Pose by FK (joint angles → target)"),
    ];
    let is_alone = session.rig().sole_limb().is_some();
    let blend = Slider {
        name: "IK influence",
        label: "Influence",
        term: Some("IK influence"),
        tooltip: "Blend from FK at 0 to IK at 1",
        value: influence,
        range: (0.0, 1.0),
        default: 1.0,
        step: 0.1,
        channel: (!is_alone).then_some(Channel::TargetInfluence(joint)),
        ..Slider::default()
    };
    let set = |influence| TargetEdit::SetTarget(Target { influence, ..*target });
    if target.limb().is_none() {
        blend.show(ui, session, actions, set);
        return;
    }
    blend.show_after(ui, session, actions, set, |ui, actions| {
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
fn angles(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
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

fn socket_twist(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let slider = Slider {
        name: "Socket twist",
        label: "Twist",
        tooltip: "Turn the elbow about the Pointer; the hand stays",
        term: Some("Socket twist"),
        value: signed_degrees(limb.settings.twist),
        range: (-180.0, 180.0),
        default: 0.0,
        unit: "°",
        step: 1.0,
        disabled: limb.why_not_ik(),
        channel: limb.keyed(Channel::TargetTwist(limb.target.joint)),
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

/// An angle in radians as degrees above −180 and at most 180.
fn signed_degrees(angle: f32) -> f32 {
    let degrees = angle.rem_euclid(TAU).to_degrees();
    if degrees > 180.0 { degrees - 360.0 } else { degrees }
}

/// Shows the combo box of the twist references, for the title row of the section, with a label if
/// there is room for both.
fn reference(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    /// Width in points of the section's title with its triangle.
    const TITLE: f32 = 104.0;
    const LABEL: &str = "Reference";
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

fn choice(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
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

fn pole(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let (session, joint) = (limb.session, limb.target.joint);
    let Some((space, pole)) = limb.settings.pole() else { return };
    let of_arm = || LimbTarget::default().limb()?.pole;
    let in_front = || {
        let rig = session.rig();
        rig.new_pole(session.posed().evaluated_skeleton(), rig.target(joint)?)
    };
    let default = if limb.is_alone { of_arm() } else { in_front() };
    let sliders = PointSliders {
        name: "Pole",
        labels: ["Pole x", "Pole y", "Pole z"],
        value: pole,
        default: default.unwrap_or(pole),
        range: limb.length(),
        step: limb.step(),
        tooltip: "Move the Pole, the point that the elbow turns towards",
        disabled: limb.why_not_ik(),
        channel: limb.keyed(Channel::TargetPole(joint)),
    };
    sliders.show(ui, session, actions, |pole| {
        limb.with(LimbSettings { pole: Some(pole), ..limb.settings })
    });
    space::of_pole(ui, session, limb.target, space, actions);
}

fn soft_limits(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    soft_reach_sliders(ui, limb.session, limb.settings.soft_reach, actions, |soft_reach| {
        limb.with(LimbSettings { soft_reach, ..limb.settings })
    });
}

fn hand_orientation(ui: &mut Ui, limb: LimbTarget<'_>, actions: &mut Actions) {
    let Some(hand) = limb.joints.hand else {
        ui.weak("There is no hand or foot: no single joint is at the tip");
        return;
    };
    let joint = limb.target.joint;
    let kept = limb.target.orientation;
    let choices = [
        (false, "Follow bone", "Turn the hand or foot with the bone above it"),
        (
            true,
            "Keep orientation",
            "Keep the orientation of the hand or foot in the target's space",
        ),
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
                ("Rotate the hand or foot in the target's space", order.shown(angles));
            let channel = limb.keyed(Channel::TargetOrientation(joint));
            euler_sliders(ui, limb.session, (name, tooltip, channel), angles, actions, |angles| {
                TargetEdit::SetTarget(Target {
                    orientation: Some(order.kept(angles)),
                    ..*limb.target
                })
            });
        }
        None => {
            let tooltip = "Rotate the hand or foot relative to the bone above it";
            let angles = order.shown(rig.skeleton[hand].rotation);
            let channel = limb.keyed(Channel::Rotation(hand));
            euler_sliders(ui, limb.session, (name, tooltip, channel), angles, actions, |angles| {
                JointEdit::SetRotation { joint: hand, rotation: order.kept(angles) }
            });
        }
    }
    let roll = rig.hand_roll(limb.session.posed().skeleton(), joint).unwrap_or_default();
    widgets::pair(ui, "Forearm roll τ", |ui| {
        ui.label(RichText::new(format!("{:.1}°", roll.to_degrees())).monospace())
            .on_hover_text("Hand rotation about the forearm, spread along the forearm");
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
