use glam::{Affine3A, Vec3};

use super::drawn_skeleton::DrawnSkeleton;
use crate::document::{Display, Overlay, SkeletonRig, Skin};
use crate::kinematics::Shared;
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{SkinPose, Skinning};
use crate::rig::AttachedMesh;
use crate::scene::{Ball, Colour, Label, LabelSide, Scene, Shadow, SkinInstance, WeightColours};
use crate::session::Overlays;

/// Opacity of a skin over its bones.
const OVER_BONES: f32 = 0.5;
/// Opacity of the edges of triangles.
const WIRE: f32 = 0.3;
/// Distance between compared skins, as a multiple of their width.
const SPACING: f32 = 1.8;

/// A skin that is shown, with its mesh.
#[derive(Clone, Copy)]
pub(super) struct ShownSkin<'a> {
    skin: &'a Skin,
    mesh: &'a Shared<AttachedMesh>,
    has_bones: bool,
    compared: Option<ComparedSkins>,
}

/// Compared skins side by side.
#[derive(Clone, Copy)]
struct ComparedSkins {
    /// Middle of the lower side of the mesh in the world, as it was attached.
    low: Vec3,
    /// From one skin to the next, in the world.
    step: Vec3,
}

impl<'a> ShownSkin<'a> {
    /// The skin of a rig as the display shows it; `None` if it is hidden or cannot be made.
    pub fn new(rig: &'a SkeletonRig, display: Display) -> Option<Self> {
        let skin = rig.skin.as_ref().filter(|_| display.shows(Overlay::Skin))?;
        let mesh = skin.mesh().ok()?;
        let is_compared = display.shows(Overlay::CompareSkinning);
        let compared = is_compared.then(|| ComparedSkins::new(mesh, rig.skeleton.transform()));
        Some(Self { skin, mesh, has_bones: display.shows_bones_in_skin(), compared })
    }

    /// True if the bones are drawn too.
    pub fn has_bones(&self) -> bool {
        self.has_bones
    }

    /// Adds the skin of a posed skeleton; to compare ways of blending, once for each, side by side.
    pub fn add(&self, scene: &mut Scene, posed: &Skeleton, overlays: &Overlays, display: Display) {
        let mut pose: Shared<SkinPose> = scene.spare_skin_pose.take().unwrap_or_default();
        self.mesh.mesh.write_pose(posed, pose.make_mut());
        let guide = scene.palette.guide;
        let instance = SkinInstance {
            mesh: self.mesh.clone(),
            skinning: self.skin.skinning,
            offset: Vec3::ZERO,
            colour: self.colour(),
            wireframe: display.shows(Overlay::Wireframe).then(|| guide.with_opacity(WIRE)),
            weights_of: coloured_weights(scene, overlays, display),
            pose,
        };
        let Some(ComparedSkins { low, .. }) = self.compared else {
            scene.skins.push(instance);
            return;
        };
        for (skinning, offset) in Skinning::ALL.into_iter().zip(self.offsets()) {
            scene.skins.push(SkinInstance { skinning, offset, ..instance.clone() });
            let colour = scene.palette.skinning(skinning);
            let label = Label::new(low + offset, 0.0, LabelSide::Below, colour);
            scene.add_label(label, format_args!("{}", skinning.title()));
        }
    }

    /// Adds the skin in another pose, in one colour.
    pub fn add_in_pose(&self, scene: &mut Scene, pose: Shared<SkinPose>, colour: Colour) {
        scene.skins.push(SkinInstance {
            mesh: self.mesh.clone(),
            pose,
            skinning: self.skin.skinning,
            offset: Vec3::ZERO,
            colour,
            wireframe: None,
            weights_of: None,
        });
    }

    /// Offsets in the world of the skins that are drawn.
    fn offsets(&self) -> impl Iterator<Item = Vec3> + use<> {
        let step = self.compared.map_or(Vec3::ZERO, |compared| compared.step);
        let sides: &[f32] = if self.compared.is_some() { &[-1.0, 0.0, 1.0] } else { &[0.0] };
        sides.iter().map(move |side| step * side)
    }

    /// The colour of the skin, see-through over bones.
    pub fn colour(&self) -> Colour {
        let [r, g, b] = self.skin.colour.map(|channel| (channel * 255.0).round() as u8);
        let opacity = if self.has_bones { OVER_BONES } else { 1.0 };
        Colour([r, g, b, 255]).with_opacity(opacity)
    }

    /// Radius of the skin around a joint's bone, in units of the skeleton.
    pub fn thickness(&self, joint: JointId) -> f32 {
        self.mesh.radii.get(joint.index()).copied().unwrap_or_default()
    }

    /// Adds what a skin without bones shows of a joint: its shadow, and its bone if that is selected
    /// or under the mouse and no part of the skin lights up for it.
    pub fn add_joint(
        &self,
        scene: &mut Scene,
        drawn: &DrawnSkeleton<'_>,
        joint: JointId,
        overlays: &Overlays,
        display: Display,
    ) {
        let (base, tip) = (drawn.pose.base(joint), drawn.pose.tip(joint));
        let thickness = self.thickness(joint) * drawn.scale;
        if display.shows(Overlay::Shadow) && thickness > 0.0 {
            let radii = |joint| [self.thickness(joint) * drawn.scale; 2];
            let shadows = drawn.shadow(joint, radii);
            let moved = |limb: Shadow, offset: Vec3| Shadow {
                base: limb.base + offset,
                tip: limb.tip + offset,
                ..limb
            };
            scene
                .shadows
                .extend(self.offsets().flat_map(|offset| shadows.map(|limb| moved(limb, offset))));
        }
        let is_lit = overlays.selection.contains(&joint) || overlays.hovered == Some(joint);
        if is_lit && thickness == 0.0 {
            let colour = drawn.colour(scene, joint, overlays);
            let radius = drawn.radius(joint);
            if base != tip {
                scene.add_guide_solid(base, tip, radius, 0.5 * radius, colour);
            }
            scene.guide_balls.push(Ball { centre: base, radius: 1.1 * radius, colour });
        }
    }
}

/// The joint whose weights colour a skin: if the display shows weights, the selected one; else that
/// under the mouse or the selected one lights up.
fn coloured_weights(
    scene: &Scene,
    overlays: &Overlays,
    display: Display,
) -> Option<(JointId, WeightColours)> {
    /// Opacities of the tints of a joint under the mouse and of a selected one.
    const TINTS: [f32; 2] = [0.5, 0.9];
    let selected = overlays.selection.last().copied();
    if display.shows(Overlay::SkinWeights) {
        return selected.map(|joint| (joint, WeightColours::Ramp));
    }
    let hovered = overlays.hovered.filter(|joint| !overlays.selection.contains(joint));
    let (joint, opacity) = hovered.zip(Some(TINTS[0])).or(selected.zip(Some(TINTS[1])))?;
    Some((joint, WeightColours::Tint(scene.palette.accent.with_opacity(opacity))))
}

impl ComparedSkins {
    fn new(mesh: &AttachedMesh, to_world: Affine3A) -> Self {
        let in_world = mesh.mesh.mesh().positions.iter().map(|at| to_world.transform_point3(*at));
        let bounds = in_world.map(|at| (at, at)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = bounds.unwrap_or_default();
        let step = Vec3::X * SPACING * (high.x - low.x);
        Self { low: low.midpoint(high).with_y(low.y), step }
    }
}
