use glam::Vec3;

use crate::document::{Document, Posed, Track};
use crate::io::exported::{ExportFrames, Exported, MotionError, Progress};
use crate::kinematics::skeleton::{JointId, is_within_numbers};

/// Joint positions over time, as a table of comma-separated values.
///
/// Each row is a frame: the frame's number from 0, its time in seconds as in the document, and
/// world positions in units of the scene: those of all joints' bases, then those of all leaf bones'
/// tips.
///
/// # Errors
///
/// Fails if the export is cancelled, `fps` is invalid, a position overflows, or the rig or the
/// timeline is too large for a table.
pub async fn to_csv(
    document: &Document,
    fps: Option<f64>,
    progress: &Progress,
) -> Result<Exported, MotionError> {
    let frames = ExportFrames::of_pose(document, fps)?;
    let columns = Columns::new(document);
    MotionError::check_size(frames.count(), 2 + 3 * columns.names.len())?;
    let track = Track::new(document);
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(columns.header())?;
    for frame in 0..frames.count() {
        progress.step(frame, frames.count()).await?;
        let time = frames.time(frame);
        table.write_field(frame.to_string())?;
        table.write_field(time.to_string())?;
        for (name, point) in columns.names.iter().zip(columns.points(&track.at(time))) {
            if !is_within_numbers(point) {
                return Err(MotionError::TooFar { joint: name.clone() });
            }
            for number in point.to_array() {
                // Adding 0 turns −0 into 0.
                table.write_field((number + 0.0).to_string())?;
            }
        }
        table.write_record(None::<&[u8]>)?;
    }
    progress.step(frames.count(), frames.count()).await?;
    let bytes = table.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(Exported { bytes, notes: Vec::new() })
}

/// The points of a rig that fill the columns of the table.
struct Columns {
    names: Vec<String>,
    /// Indices of the leaf joints. The tips of their bones are in the table.
    leaves: Vec<usize>,
}

impl Columns {
    fn new(document: &Document) -> Self {
        let joints = document.skeleton().joints();
        let mut is_leaf: Vec<bool> = joints.iter().map(|joint| joint.axis != Vec3::ZERO).collect();
        for parent in joints.iter().filter_map(|joint| joint.parent) {
            is_leaf[parent.index()] = false;
        }
        let leaves: Vec<usize> = (0..joints.len()).filter(|joint| is_leaf[*joint]).collect();
        let tips = leaves.iter().map(|joint| format!("{}_tip", joints[*joint].name));
        let names = joints.iter().map(|joint| joint.name.clone()).chain(tips).collect();
        Self { names, leaves }
    }

    fn header(&self) -> impl Iterator<Item = String> + '_ {
        let points =
            self.names.iter().flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}.{axis}")));
        ["frame", "time"].map(str::to_owned).into_iter().chain(points)
    }

    fn points(&self, posed: &Posed) -> Vec<Vec3> {
        let pose = posed.skeleton().pose();
        let bases = pose.ids().map(|joint| pose.base(joint));
        bases.chain(self.leaves.iter().map(|joint| pose.tip(JointId::new(*joint)))).collect()
    }
}
