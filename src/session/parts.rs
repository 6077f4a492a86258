use std::collections::BTreeSet;

use glam::Vec3;

use crate::document::Channel;
use crate::kinematics::spline::Knot;

/// The way in which a limb is posed: by FK or by IK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseMode {
    /// IK (hand → joint angles): the target poses the limb.
    Hand,
    /// FK (joint angles → hand): the joint angles pose the limb.
    Angles,
}

/// A line of a limb's figures and formulas, which lights up in the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimbFigure {
    /// The axes of the Root.
    Root,
    /// The axes of the Limb.
    Limb,
    /// The axes of the Socket.
    Socket,
    /// The Upper limb, d_1 long.
    Upper,
    /// The Lower limb, d_2 long.
    Lower,
    /// The Cursor's x_c, y_c and z_c; without IK, those of the hand.
    Cursor,
    /// The yaw θ_z of the Pointer.
    Yaw,
    /// The horizontal distance h_c from the Root to the Cursor.
    Level,
    /// The pitch θ_y of the Pointer.
    Pitch,
    /// The distance D from shoulder to hand.
    Distance,
    /// The distance h_e of the elbow along the Pointer.
    Along,
    /// The distance o_e of the elbow from the Pointer.
    Out,
    /// The angle θ_e at the shoulder.
    ShoulderAngle,
    /// The angle φ at the elbow.
    ElbowAngle,
    /// The elbow's x_e, y_e and z_e.
    Elbow,
}

impl LimbFigure {
    /// All lines.
    pub const ALL: [Self; 15] = [
        Self::Root,
        Self::Limb,
        Self::Socket,
        Self::Upper,
        Self::Lower,
        Self::Cursor,
        Self::Yaw,
        Self::Level,
        Self::Pitch,
        Self::Distance,
        Self::Along,
        Self::Out,
        Self::ShoulderAngle,
        Self::ElbowAngle,
        Self::Elbow,
    ];
}

/// A key: its channel and its time, in seconds.
pub type Key = (Channel, f64);

/// Copied keys with their channels. Their times are those after the first key, in seconds.
pub(super) type Clipboard = Vec<(Channel, Knot<Vec3>)>;

/// The selected keys and channels before an edit of the joints, whose numbers they name.
#[derive(Clone, Debug)]
pub(super) struct SelectedKeys {
    pub keys: Vec<Key>,
    pub channels: BTreeSet<Channel>,
}
