use glam::{Quat, Vec3};

use crate::kinematics::skeleton::{Joint, JointId, Skeleton};
use crate::kinematics::skin::{Blob, BlobSphere, SkinShape, SkinnedMesh, TriangleMesh};

/// A finger, with lengths in units of the hand's length.
struct Finger {
    knuckle: Vec3,
    /// Lengths of the bones from the knuckle to the fingertip.
    bones: [f32; 3],
    /// Radius at the knuckle.
    radius: f32,
    /// Angle of the finger towards the little finger's side, in radians.
    spread: f32,
    /// Bend of each joint towards the palm, in radians.
    bends: [f32; 3],
}

/// The fingers from the index finger to the little finger.
const FINGERS: [Finger; 4] = [
    Finger {
        knuckle: Vec3::new(0.5, 0.01, -0.182),
        bones: [0.185, 0.115, 0.07],
        radius: 0.068,
        spread: -0.2,
        bends: [0.04, 0.16, 0.16],
    },
    Finger {
        knuckle: Vec3::new(0.525, 0.022, -0.06),
        bones: [0.205, 0.13, 0.078],
        radius: 0.071,
        spread: -0.04,
        bends: [0.06, 0.2, 0.18],
    },
    Finger {
        knuckle: Vec3::new(0.505, 0.014, 0.062),
        bones: [0.185, 0.12, 0.074],
        radius: 0.068,
        spread: 0.12,
        bends: [0.1, 0.24, 0.2],
    },
    Finger {
        knuckle: Vec3::new(0.455, -0.006, 0.174),
        bones: [0.14, 0.09, 0.06],
        radius: 0.059,
        spread: 0.32,
        bends: [0.14, 0.26, 0.22],
    },
];

const MIDDLE: &Finger = &FINGERS[1];

/// Positions and radii of the thumb's joints from the wrist to the tip, in units of the hand's
/// length.
const THUMB: [(Vec3, f32); 4] = [
    (Vec3::new(0.12, -0.02, -0.07), 0.105),
    (Vec3::new(0.27, -0.06, -0.225), 0.092),
    (Vec3::new(0.4, -0.075, -0.325), 0.073),
    (Vec3::new(0.505, -0.07, -0.365), 0.062),
];

/// Ratio of the spacing of the palm's bones at the wrist to their spacing at the knuckles.
const WRIST: f32 = 0.5;
/// Radius of the palm's bones at the wrist, in units of the hand's length.
const PALM_RADIUS: f32 = 0.085;
/// Ratio of the palm's radius at a knuckle to the finger's.
const KNUCKLE: f32 = 1.15;
/// Ratio of a fingertip's radius to the radius of its knuckle.
const TAPER: f32 = 0.8;
/// Bodies of the wrist and of the ball of the thumb: two ends with their radii.
const HEELS: [[(Vec3, f32); 2]; 3] = [
    [(Vec3::new(-0.02, 0.0, -0.055), 0.12), (Vec3::new(0.16, 0.0, -0.06), 0.09)],
    [(Vec3::new(-0.02, 0.0, 0.055), 0.12), (Vec3::new(0.18, 0.0, 0.07), 0.088)],
    [(Vec3::new(0.12, -0.03, -0.08), 0.1), (Vec3::new(0.27, -0.06, -0.2), 0.092)],
];
/// Cells of the grid on the smallest radius.
const DETAIL: f32 = 2.0;

/// The surface of a right hand in the space of the wrist: +x points towards the fingertips, +y out of
/// the back of the hand (the palm faces −y) and +z to the little finger's side (the thumb is at −z).
/// The distance from the wrist to the tip of the middle finger is 1.
pub fn hand_mesh() -> TriangleMesh {
    let mut joints =
        vec![Joint { radius: PALM_RADIUS, ..Joint::new("palm", None, MIDDLE.knuckle) }];
    for (nth, finger) in FINGERS.iter().enumerate() {
        add_chain(&mut joints, &format!("finger {nth}"), &finger.joints());
    }
    add_chain(&mut joints, "thumb", &THUMB);
    let shape = SkinShape { detail: DETAIL, blobs: palm().collect(), ..SkinShape::default() };
    let skin = Skeleton::from_joints(joints)
        .ok()
        .and_then(|skeleton| SkinnedMesh::from_bones(&skeleton, &shape).ok());
    skin.map(|skin| skin.mesh().clone()).unwrap_or_default()
}

/// Adds joints from each point to the next one, with their radii.
fn add_chain(joints: &mut Vec<Joint>, name: &str, points: &[(Vec3, f32)]) {
    let mut parent = JointId::new(0);
    let mut parent_base = Vec3::ZERO;
    for (nth, ends) in points.windows(2).enumerate() {
        let [(base, radius), (tip, _)] = [ends[0], ends[1]];
        let joint = Joint::new(&format!("{name}, bone {nth}"), Some(parent), tip - base);
        joints.push(Joint { offset: base - parent_base, radius, ..joint });
        (parent, parent_base) = (JointId::new(joints.len() - 1), base);
    }
}

/// The bodies of the palm: from the wrist to each knuckle and to the middle between two, so that they
/// make one surface, and the heels of the hand.
fn palm() -> impl Iterator<Item = Blob> {
    let sphere = |(centre, radius)| BlobSphere { centre, radius };
    let ends = move |ends: [(Vec3, f32); 2]| Blob {
        joint: JointId::new(0),
        spheres: ends.map(sphere).to_vec(),
    };
    let knuckles = FINGERS.iter().map(|finger| (finger.knuckle, finger.radius * KNUCKLE));
    let between = FINGERS.windows(2).map(|pair| {
        let radius = 0.5 * KNUCKLE * (pair[0].radius + pair[1].radius);
        (pair[0].knuckle.midpoint(pair[1].knuckle) - Vec3::X * 0.02, radius)
    });
    let ray = move |(knuckle, radius): (Vec3, f32)| {
        let wrist = Vec3::new(0.06, 0.0, knuckle.z * WRIST);
        ends([(wrist, PALM_RADIUS), (knuckle, radius)])
    };
    knuckles.chain(between).map(ray).chain(HEELS.into_iter().map(ends))
}

impl Finger {
    /// Positions and radii of the joints and of the fingertip.
    fn joints(&self) -> [(Vec3, f32); 4] {
        let mut turn = Quat::from_rotation_y(-self.spread);
        let mut joint = self.knuckle;
        let mut joints = [(joint, self.radius); 4];
        for (step, (bone, bend)) in self.bones.iter().zip(self.bends).enumerate() {
            turn *= Quat::from_rotation_z(-bend);
            joint += turn * Vec3::X * *bone;
            let radius = self.radius * (1.0 - (1.0 - TAPER) * (step + 1) as f32 / 3.0);
            joints[step + 1] = (joint, radius);
        }
        joints
    }
}
