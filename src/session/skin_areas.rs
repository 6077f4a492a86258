use crate::document::{Overlay, Posed, Track};
use crate::kinematics::skeleton::{JointId, Skeleton};
use crate::kinematics::skin::{MeshSection, SkinPose, SkinnedMesh, Skinning};

/// Area of the cross-section of a skin at the base of a joint over the timeline, once for each way of
/// blending joints.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinAreas {
    /// The joint.
    pub joint: JointId,
    /// Times in seconds.
    pub times: Vec<f64>,
    /// For each way of blending, in the order of [`Skinning::ALL`], the areas at these times as fractions
    /// of that in the pose in which the skin was attached.
    pub areas: [Vec<f32>; Skinning::ALL.len()],
}

impl SkinAreas {
    /// The areas of the skin of a document; `None` if the display does not compare ways of blending, or
    /// there is no closed section. Without a joint, the section is at the one with the greatest roll in the
    /// timeline.
    pub(super) fn new(track: &Track, joint: Option<JointId>) -> Option<Self> {
        const MOST_TIMES: usize = 121;
        let document = track.document();
        let skin = document.skeleton_rig.skin.as_ref();
        let skin = skin.filter(|_| document.display.shows(Overlay::CompareSkinning))?;
        let mesh = &skin.mesh().ok()?.mesh;
        let timeline = document.timeline;
        let count = if document.is_animated() { timeline.frames().clamp(2, MOST_TIMES) } else { 2 };
        let time =
            |index: usize| timeline.start + timeline.duration() * index as f64 / (count - 1) as f64;
        let pose = |posed: &Posed| (posed.time(), mesh.pose(posed.skeleton()));
        let (times, poses): (Vec<f64>, Vec<SkinPose>) =
            track.sample(count, time, pose).into_iter().unzip();
        let joint = joint.or_else(|| most_rolled(&poses))?;
        let section = section(mesh, document.skeleton(), joint)?;
        let plain = section.area(|vertex| mesh.mesh().positions[vertex as usize]);
        // The skeleton's transform scales areas too.
        let scale = document.skeleton().transform().matrix3.determinant().abs().powf(2.0 / 3.0);
        let areas = Skinning::ALL.map(|skinning| {
            let area = |pose: &SkinPose| {
                section.area(|vertex| mesh.posed_vertex(pose, skinning, vertex)) / (plain * scale)
            };
            poses.iter().map(area).collect()
        });
        Some(Self { joint, times, areas })
    }

    /// The areas at a time in seconds, by linear interpolation, in the order of [`Skinning::ALL`].
    pub fn at(&self, time: f64) -> [f32; Skinning::ALL.len()] {
        let after = self.times.partition_point(|sample| *sample <= time);
        let (from, to) = (after.saturating_sub(1), after.min(self.times.len() - 1));
        let step = self.times[to] - self.times[from];
        let share = if step > 0.0 { ((time - self.times[from]) / step) as f32 } else { 0.0 };
        let share = share.clamp(0.0, 1.0);
        std::array::from_fn(|way| {
            let areas = &self.areas[way];
            areas[from] + (areas[to] - areas[from]) * share
        })
    }
}

fn most_rolled(poses: &[SkinPose]) -> Option<JointId> {
    let rolls = poses.iter().flat_map(|pose| pose.joints().iter().enumerate());
    let greatest = rolls.max_by(|(_, one), (_, other)| one.roll.abs().total_cmp(&other.roll.abs()));
    greatest.map(|(joint, _)| JointId::new(joint))
}

/// The section across a joint's bone at its base.
fn section(mesh: &SkinnedMesh, skeleton: &Skeleton, joint: JointId) -> Option<MeshSection> {
    let bind = mesh.inverse_binds().get(joint.index())?.inverse();
    let normal = bind.transform_vector3(skeleton.joint(joint)?.axis);
    MeshSection::new(mesh.mesh(), bind.translation.into(), normal.try_normalize()?)
}
