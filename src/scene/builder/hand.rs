use glam::{Affine3A, Quat, Vec3};

use crate::scene::{Ball, Colour, Scene};

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

/// Positions and radii of the thumb's joints from the wrist to the tip, in units of the hand's
/// length.
const THUMB: [(Vec3, f32); 4] = [
    (Vec3::new(0.12, -0.02, -0.07), 0.105),
    (Vec3::new(0.27, -0.06, -0.225), 0.092),
    (Vec3::new(0.4, -0.075, -0.325), 0.073),
    (Vec3::new(0.505, -0.07, -0.365), 0.062),
];

/// Length and radii (at base and tip) of the cuff around the wrist, in units of the hand's length.
const CUFF: (f32, [f32; 2]) = (0.1, [0.165, 0.185]);

/// Ratio of the spacing of the palm's bones at the wrist to their spacing at the knuckles.
const WRIST: f32 = 0.5;
/// Radius of the palm's bones at the wrist, in units of the hand's length.
const PALM_RADIUS: f32 = 0.085;
/// Ratio of the palm's radius at a knuckle to the finger's.
const KNUCKLE: f32 = 1.15;
/// Ratio of a fingertip's radius to the radius of its knuckle.
const TAPER: f32 = 0.84;

impl Scene {
    /// Adds a right hand of cones and balls, with a cuff in the lower limb's colour. `transform` is
    /// rigid and maps to the world from the space of the wrist: +x points towards the fingertips,
    /// +y out of the back of the hand (the palm faces −y) and +z to the little finger's side (the
    /// thumb is at −z). `size` is the distance from the wrist to the tip of the middle finger, in
    /// world units.
    pub fn add_hand(&mut self, transform: Affine3A, size: f32, colour: Colour) {
        let mut hand = Hand { scene: self, transform, size, colour };
        for finger in &FINGERS {
            hand.add_palm(finger);
            hand.add_finger(finger);
        }
        hand.add_balls(&THUMB);
        hand.add_cones(&THUMB);
        hand.add_cuff();
    }
}

struct Hand<'a> {
    scene: &'a mut Scene,
    transform: Affine3A,
    size: f32,
    colour: Colour,
}

impl Hand<'_> {
    /// Adds the palm's bone from the wrist to the knuckle of a finger.
    fn add_palm(&mut self, finger: &Finger) {
        let wrist = Vec3::new(0.06, 0.0, finger.knuckle.z * WRIST);
        let joints = [(wrist, PALM_RADIUS), (finger.knuckle, finger.radius * KNUCKLE)];
        self.add_balls(&joints);
        self.add_cones(&joints);
    }

    fn add_finger(&mut self, finger: &Finger) {
        let mut turn = Quat::from_rotation_y(-finger.spread);
        let mut joint = finger.knuckle;
        let mut joints = [(joint, finger.radius); 4];
        for (step, (bone, bend)) in finger.bones.iter().zip(finger.bends).enumerate() {
            turn *= Quat::from_rotation_z(-bend);
            joint += turn * Vec3::X * *bone;
            let radius = finger.radius * (1.0 - (1.0 - TAPER) * (step + 1) as f32 / 3.0);
            joints[step + 1] = (joint, radius);
        }
        // The palm's ball covers the knuckle.
        self.add_balls(&joints[1..]);
        self.add_cones(&joints);
    }

    fn add_cuff(&mut self) {
        let (length, [base, tip]) = CUFF;
        let at = |x: f32| self.transform.transform_point3(Vec3::X * x * self.size);
        let colour = self.scene.palette.lower;
        self.scene.add_solid(at(0.0), at(length), base * self.size, tip * self.size, colour);
    }

    fn add_balls(&mut self, joints: &[(Vec3, f32)]) {
        for (point, radius) in joints {
            let centre = self.transform.transform_point3(*point * self.size);
            let radius = radius * self.size;
            self.scene.balls.push(Ball { centre, radius, colour: self.colour });
        }
    }

    /// Adds cones between successive joints.
    fn add_cones(&mut self, joints: &[(Vec3, f32)]) {
        let at = |point| self.transform.transform_point3(point * self.size);
        for ends in joints.windows(2) {
            let [(base, base_radius), (tip, tip_radius)] = [ends[0], ends[1]];
            let (base_radius, tip_radius) = (base_radius * self.size, tip_radius * self.size);
            self.scene.add_solid(at(base), at(tip), base_radius, tip_radius, self.colour);
        }
    }
}
