//! Values of actions: mostly sensible, often on a limit, sometimes wild.

mod files;
mod joints;
mod times;
mod view;

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec3;
use ik_arm::kinematics::soft_reach::SoftReach;
use ik_arm::session::Session;

use crate::common::Random;

/// Makes values for a session in its current state.
pub struct Values<'a> {
    pub random: &'a mut Random,
    pub session: &'a Session,
    /// Fraction of wild values.
    pub wild: f32,
    /// Time of the last frame, in seconds of the window.
    pub clock: &'a mut f64,
}

impl Values<'_> {
    pub fn chance(&mut self, share: f32) -> bool {
        self.random.chance(share)
    }

    pub fn coin(&mut self) -> bool {
        self.chance(0.5)
    }

    pub fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.random.below(all.len())]
    }

    fn is_wild(&mut self) -> bool {
        let share = self.wild;
        self.chance(share)
    }

    // Numbers

    fn wild_number(&mut self) -> f32 {
        const WILD: [f32; 14] = [
            0.0,
            -0.0,
            1e-45,
            -1e-40,
            f32::MIN_POSITIVE,
            1e-20,
            1e10,
            -1e19,
            1e30,
            f32::MAX,
            f32::MIN,
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
        ];
        self.one_of(&WILD)
    }

    /// Within ±`size`; often 0 or ±`size`.
    pub fn number(&mut self, size: f32) -> f32 {
        if self.is_wild() {
            return self.wild_number();
        }
        match self.random.below(8) {
            0 => self.one_of(&[0.0, -0.0, size, -size]),
            _ => self.random.within(-size..size),
        }
    }

    pub fn angle(&mut self) -> f32 {
        if self.chance(0.15) {
            return self.one_of(&[0.0, PI, -PI, FRAC_PI_2, -FRAC_PI_2, TAU, 7.0 * TAU, 1e4]);
        }
        self.number(PI)
    }

    pub fn angles(&mut self) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.angle()))
    }

    pub fn part(&mut self) -> f32 {
        if self.chance(0.3) {
            return self.one_of(&[0.0, 1.0, 1.0, 0.5, -0.1, 1.1]);
        }
        self.number(1.0).abs()
    }

    pub fn length(&mut self) -> f32 {
        if self.chance(0.2) {
            let joints = self.session.skeleton().joints();
            let lengths = joints.iter().map(|joint| joint.axis.length()).chain([1.0]);
            let lengths: Vec<f32> = lengths.collect();
            let own = self.one_of(&lengths);
            return self.one_of(&[own, own, 200.0, 300.0, 1e-2, 0.0, -1.0]);
        }
        self.number(400.0).abs()
    }

    pub fn above_0(&mut self, size: f32) -> f32 {
        if self.chance(0.05) {
            return self.one_of(&[0.0, -1.0, 1e-3, 1e3]);
        }
        self.number(size).abs()
    }

    // Points

    /// Size of the rig.
    pub fn size(&self) -> f32 {
        let size = self.session.rig().reach();
        if size.is_normal() { size } else { 1.0 }
    }

    pub fn point(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.number(size)))
    }

    pub fn small_point(&mut self) -> Vec3 {
        let size = self.session.rig().reach();
        self.point(1.5 * if size.is_normal() { size } else { 1.0 })
    }

    pub fn soft_reach(&mut self) -> SoftReach {
        let softness = self.one_of(&[0.0, 0.0, 0.1, 0.25, 0.5, 0.99, 1.0_f32.next_down()]);
        let stretch = self.one_of(&[1.0, 1.0, 1.0, 1.2, 2.0, 100.0, f32::MAX]);
        let stretch = if stretch == f32::MAX && !self.is_wild() { 1.5 } else { stretch };
        let angle = self.one_of(&[0.0, 0.0, 0.3, 1.5, 3.0, PI.next_down()]);
        SoftReach::new(softness, stretch, angle).expect("a softening")
    }
}
