//! Documents of version 2, which had two rigs, an arm and a skeleton, of which one is shown.
//! Conversion to a document of the shown rig: the arm becomes joints with the target of a limb.

mod arm;
mod arm_fields;

use glam::{Mat3A, Vec3};
use serde::Deserialize;

use super::keys::{ChannelFields, keys};
use crate::document::{Channel, Display, Document, Overlay, Quantity, SkeletonRig};
use crate::io::json::{AtField, FieldError, FieldWarnings, JsonObject, JsonPath};
use crate::kinematics::skeleton::nearest_angles;
use crate::kinematics::spline::Knot;
use crate::kinematics::twist::{Stereographic, TwistReferenceKind};
use arm::{Arm, ArmChannel};
pub(super) use arm_fields::ArmFields;

/// The rig that a document of version 2 shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RigName {
    Arm,
    Skeleton,
}

/// Fields of a document of version 2 that later versions do not have.
pub struct RigFields {
    pub shown: Option<RigName>,
    pub arm: Option<JsonObject<ArmFields>>,
}

impl RigFields {
    /// Converts a document that has the skeleton of the file to one of the shown rig.
    pub fn document(
        self,
        figure: Document,
        overlays: Option<Display>,
        channels: Vec<JsonObject<ChannelFields>>,
        is_of_version_2: bool,
        warnings: &mut FieldWarnings,
    ) -> Result<Document, FieldError> {
        let shows_arm =
            self.shown.ok_or("must have `rig`, \"arm\" or \"skeleton\"")? == RigName::Arm;
        let arm = self.arm.map(|JsonObject(fields)| fields.arm().at("arm")).transpose()?;
        let (of_arm, of_figure) = channels
            .into_iter()
            .enumerate()
            .partition::<Vec<_>, _>(|(_, JsonObject(fields))| ArmChannel::named(fields).is_some());
        let overlays = overlays.unwrap_or_else(shown_by_default);
        if !shows_arm {
            if !of_arm.is_empty() || arm.is_some_and(|arm| arm != Arm::default()) {
                warn_left_out(warnings, "arm", "skeleton");
            }
            let mut figure = figure;
            figure.display = of_a_figure(overlays);
            let channels = of_figure.into_iter().map(|(_, fields)| fields).collect();
            figure.keys = keys(channels, &figure).at("channels")?;
            if is_of_version_2 {
                convert_limbs(&mut figure);
                warn_of_track(&figure, warnings);
            }
            return Ok(figure);
        }
        if figure.rig != SkeletonRig::default() {
            warn_left_out(warnings, "skeleton", "arm");
        }
        let arm = arm.unwrap_or_default();
        let keyed = |names: &[ArmChannel]| {
            let is_named = |fields| ArmChannel::named(fields).is_some_and(|it| names.contains(&it));
            of_arm.iter().any(|(_, JsonObject(fields))| is_named(fields))
        };
        use ArmChannel::{Hand, Pin, Pinned, Root, Twist};
        let is_unkeyed = !keyed(&[Hand, Pin, Pinned, Root, Twist]);
        let mut document = Document {
            timeline: figure.timeline,
            camera: figure.camera,
            metres_per_unit: figure.metres_per_unit.or(Some(1e-3)),
            animation_name: figure.animation_name,
            display: overlays.with(Overlay::Cylinders, true),
            ..Document::new(arm.rig(is_unkeyed))
        };
        for (index, JsonObject(fields)) in of_arm {
            arm.add_keys(&fields, &mut document).at(index).at("channels")?;
        }
        for (index, JsonObject(fields)) in of_figure {
            if let Some(overlay) = fields.overlay {
                let keys = fields.knots(Quantity::Switch).at(index).at("channels")?;
                let channel = Channel::Overlay(overlay);
                keys.into_iter().for_each(|knot| document.keys.insert_key(channel, knot));
            }
        }
        Ok(document)
    }
}

fn warn_left_out(warnings: &mut FieldWarnings, rig: &str, shown: &str) {
    let remark = format!("is left out: a document has one rig now, and this one shows the {shown}");
    warnings.push(JsonPath::root().key(rig), &remark);
}

/// Warns of a figure whose poses now depend on those before them.
fn warn_of_track(figure: &Document, warnings: &mut FieldWarnings) {
    if figure.is_tracked() && figure.is_animated() {
        let remark = "is 2: a figure now moves from frame to frame, so that it may be posed \
                      otherwise than before; `track: false` of the solver poses each frame by \
                      itself";
        warnings.push(JsonPath::root().key("version"), remark);
    }
}

/// The overlays that a document of version 2 shows unless it lists them.
fn shown_by_default() -> Display {
    [Overlay::Pointer, Overlay::Hand]
        .into_iter()
        .fold(Display::default(), |display, overlay| display.with(overlay, true))
}

/// The overlays of a document that shows a figure: those of the arm were not drawn, and the Pointer
/// was the path of a head.
fn of_a_figure(overlays: Display) -> Display {
    const OF_ARM: [Overlay; 7] = [
        Overlay::Pointer,
        Overlay::InnerLimit,
        Overlay::OuterLimit,
        Overlay::Hand,
        Overlay::Frames,
        Overlay::SingularityGlobe,
        Overlay::TwistReferences,
    ];
    let display = overlays.with(Overlay::Paths, overlays.shows(Overlay::Pointer));
    OF_ARM.into_iter().fold(display, |display, overlay| display.with(overlay, false))
}

/// Measures the limbs of a figure as later versions do: stereographic maps in Root space instead of
/// that of the upper joint's parent, orientations of hands in the frames of their joints.
fn convert_limbs(figure: &mut Document) {
    for index in 0..figure.rig.targets.len() {
        let target = figure.rig.targets[index];
        let axes = figure.rig.limb_axes(target.joint);
        let frame = Mat3A::from_quat(target.orientation_frame(figure.skeleton()));
        let Some(limb) = figure.rig.targets[index].limb_mut() else { continue };
        if let Some(axes) = axes.filter(|_| limb.reference == TwistReferenceKind::Stereographic) {
            let in_root = |direction: Vec3| axes.transpose() * direction;
            let map = Stereographic::default();
            let map = Stereographic::from_saved(in_root(map.singular()), in_root(map.up()));
            limb.map = map.unwrap_or_default();
        }
        if frame == Mat3A::IDENTITY {
            continue;
        }
        let turned = |Vec3 { x, y, z }: Vec3, near| {
            let rotation = Mat3A::from_euler(glam::EulerRot::ZYX, z, y, x);
            nearest_angles(frame.transpose() * rotation * frame, near)
        };
        let orientation = target.orientation.map(|angles| turned(angles, angles));
        figure.rig.targets[index].orientation = orientation;
        let channel = Channel::TargetOrientation(target.joint);
        let mut last = None;
        let knots = figure.keys.track(channel).map_or(Vec::new(), |keys| keys.knots().to_vec());
        for knot in knots {
            let value = turned(knot.value, last.unwrap_or(knot.value));
            last = Some(value);
            figure.keys.insert_key(channel, Knot { value, slopes: None, ..knot });
        }
    }
}
