use glam::{Affine3A, Vec3};

use super::drawn_skeleton::DrawnSkeleton;
use super::shadow::above_ground;
use crate::document::{Display, Overlay, Skin};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::Skinning;
use crate::rig::AttachedMesh;
use crate::scene::{Ball, Colour, Label, LabelSide, Scene, Shadow, SkinInstance};
use crate::session::Overlays;

/// Opacity of a skin over its bones.
const OVER_BONES: f32 = 0.5;
/// Opacity of the edges of triangles.
const WIRE: f32 = 0.3;
/// Distance between compared skins, as a multiple of their width.
const SPACING: f32 = 1.5;

/// A skin that is shown, with its mesh.
#[derive(Clone, Copy)]
pub(super) struct ShownSkin<'a> {
    skin: &'a Skin,
    mesh: &'a Shared<AttachedMesh>,
    has_bones: bool,
}

impl<'a> ShownSkin<'a> {
    /// The skin of a skeleton as the display shows it; `None` if it is hidden or cannot be made.
    pub fn new(skin: Option<&'a Skin>, display: Display) -> Option<Self> {
        let skin = skin.filter(|_| display.shows(Overlay::Skin))?;
        let mesh = skin.mesh().ok()?;
        Some(Self { skin, mesh, has_bones: display.shows(Overlay::Bones) })
    }

    /// Whether the bones are drawn too.
    pub fn has_bones(&self) -> bool {
        self.has_bones
    }

    /// Adds the skin of a posed skeleton; to compare ways of blending, once for each, side by side.
    pub fn add(&self, scene: &mut Scene, posed: &Skeleton, overlays: &Overlays, display: Display) {
        let pose = self.mesh.mesh.pose(posed);
        let guide = scene.palette.guide;
        let is_coloured = display.shows(Overlay::SkinWeights);
        let instance = SkinInstance {
            mesh: self.mesh.clone(),
            skinning: self.skin.skinning,
            offset: Vec3::ZERO,
            colour: self.colour(),
            wireframe: display.shows(Overlay::Wireframe).then(|| guide.with_opacity(WIRE)),
            weights_of: overlays.selection.last().copied().filter(|_| is_coloured),
            pose,
        };
        if !display.shows(Overlay::CompareSkinning) {
            scene.skins.push(instance);
            return;
        }
        let (left, low) = self.corner(posed.transform());
        for (index, skinning) in Skinning::ALL.into_iter().enumerate() {
            let offset = Vec3::X * (index as f32 - 1.0) * SPACING * left;
            scene.skins.push(SkinInstance { skinning, offset, ..instance.clone() });
            let label = Label::new(low + offset, 0.0, LabelSide::Below, scene.palette.text);
            scene.add_label(label, format_args!("{}", skinning.title()));
        }
    }

    fn colour(&self) -> Colour {
        let [r, g, b] = self.skin.colour.map(|channel| (channel * 255.0).round() as u8);
        let opacity = if self.has_bones { OVER_BONES } else { 1.0 };
        Colour([r, g, b, 255]).with_opacity(opacity)
    }

    /// Width of the mesh along x, and the middle of its lower side, in the world and as it was attached.
    fn corner(&self, to_world: Affine3A) -> (f32, Vec3) {
        let positions = &self.mesh.mesh.mesh().positions;
        let in_world = || positions.iter().map(|at| to_world.transform_point3(*at));
        let low = in_world().reduce(Vec3::min).unwrap_or_default();
        let high = in_world().reduce(Vec3::max).unwrap_or_default();
        (high.x - low.x, low.midpoint(high).with_y(low.y))
    }

    /// Adds what a skin without bones shows of a joint: its shadow, and its bone if it is selected or
    /// under the mouse.
    pub fn add_joint(
        &self,
        scene: &mut Scene,
        drawn: &DrawnSkeleton<'_>,
        joint: JointId,
        overlays: &Overlays,
        display: Display,
    ) {
        let (base, tip) = (drawn.pose.base(joint), drawn.pose.tip(joint));
        let thickness = self.mesh.radii.get(joint.index()).map_or(0.0, |it| it * drawn.scale);
        if display.shows(Overlay::Shadow) && thickness > 0.0 {
            let (base_radius, tip_radius) = (thickness, thickness);
            scene.shadows.extend(above_ground(Shadow { base, base_radius, tip, tip_radius }));
        }
        if overlays.selection.contains(&joint) || overlays.hovered == Some(joint) {
            let colour = drawn.colour(scene, joint, overlays);
            let radius = drawn.radius(joint).min(0.4 * thickness.max(drawn.radius(joint)));
            if base != tip {
                scene.add_guide_solid(base, tip, radius, 0.5 * radius, colour);
            }
            scene.guide_balls.push(Ball { centre: base, radius: 1.1 * radius, colour });
        }
    }
}
