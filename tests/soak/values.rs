//! What actions are made of: mostly sensible, often on a limit, sometimes wild.

use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use ik_arm::document::{
    AxisView, Camera, Channel, Document, Layer, Motion, Path, Ray, RigKind, SkeletonRig, Slither,
    Target, Timeline,
};
use ik_arm::io::{Example, Progress};
use ik_arm::kinematics::reach::Softening;
use ik_arm::kinematics::skeleton::{Joint, Limit, Skeleton};
use ik_arm::kinematics::solve::{Method, Options, Root};
use ik_arm::session::{
    Constraint, Dialog, DragInput, Export, Grip, Handle, Job, Key, Motion as Turn, Session,
};

use crate::rigs::{self, Random};

/// Makes values for a session as that stands.
pub struct Values<'a> {
    pub random: &'a mut Random,
    pub session: &'a Session,
    /// What part of the values is wild.
    pub wild: f32,
    /// When the last picture was made, in seconds of the window.
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

    /// Of a size; often 0 or the whole of it.
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
        let arm = self.session.arm().bones;
        if self.chance(0.2) {
            return self.one_of(&[arm.upper(), arm.lower(), 200.0, 300.0, 1e-2, 0.0, -1.0]);
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

    /// How large what is shown is.
    pub fn size(&self) -> f32 {
        let size = match self.session.rig() {
            RigKind::Arm => self.session.arm().bones.outer_limit(),
            RigKind::Skeleton => self.session.skeleton().reach(),
        };
        if size.is_normal() { size } else { 1.0 }
    }

    pub fn point(&mut self, size: f32) -> Vec3 {
        Vec3::from_array([(); 3].map(|()| self.number(size)))
    }

    pub fn small_point(&mut self) -> Vec3 {
        let size = self.session.skeleton().reach();
        self.point(1.5 * if size.is_normal() { size } else { 1.0 })
    }

    /// A cursor: in reach, on a limit, at the shoulder, on an axis, on the pole's line, far away.
    pub fn cursor(&mut self) -> Vec3 {
        let arm = *self.session.arm();
        let (inner, outer) = (arm.bones.inner_limit(), arm.bones.outer_limit());
        let direction = match self.random.below(6) {
            0 => self.one_of(&[Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]),
            1 => arm.pole.normalize_or(Vec3::Y),
            _ => self.random.direction(),
        };
        match self.random.below(12) {
            0 => Vec3::ZERO,
            1 => direction * inner,
            2 => direction * outer,
            3 => direction * outer * self.random.within(1.0..4.0),
            4 => arm.cursor() + direction * outer * 0.01,
            5 => self.point(outer),
            _ => direction * self.random.within(inner..outer.max(inner)),
        }
    }

    // Joints

    fn joints(&self) -> usize {
        self.session.skeleton().skeleton.joints().len()
    }

    /// Mostly one that is there.
    pub fn joint(&mut self) -> usize {
        let joints = self.joints();
        if joints == 0 || self.chance(0.03) {
            return self.one_of(&[joints, joints + 1, 99, u32::MAX as usize, usize::MAX]);
        }
        match self.session.selected() {
            Some(joint) if self.chance(0.3) => joint,
            _ => self.random.below(joints),
        }
    }

    /// Mostly one with a target, if there is any.
    pub fn aimed(&mut self) -> usize {
        let targets = &self.session.skeleton().targets;
        if targets.is_empty() || self.chance(0.1) {
            return self.joint();
        }
        targets[self.random.below(targets.len())].joint
    }

    /// None, one or some, also twice.
    pub fn some_joints(&mut self) -> Vec<usize> {
        (0..self.random.below(4)).map(|_| self.joint()).collect()
    }

    /// An angle's place.
    pub fn axis(&mut self) -> usize {
        if self.is_wild() { self.one_of(&[3, 99, usize::MAX]) } else { self.random.below(3) }
    }

    pub fn limit(&mut self) -> Option<Limit> {
        let (a, b) = (self.angle(), self.angle());
        match self.random.below(5) {
            0 => None,
            1 => Some(Limit { min: a, max: a }),
            2 => Some(Limit { min: a, max: b }),
            _ => Some(Limit { min: a.min(b), max: a.max(b) }),
        }
    }

    pub fn name(&mut self) -> String {
        const NAMES: [&str; 12] = [
            "",
            " ",
            "a",
            "b",
            "root",
            "joint",
            "joint_2",
            " hand ",
            "é\u{301}\u{202e}😀",
            "\"\\\n\t\0",
            "{}[],:",
            "ROOT",
        ];
        match self.random.below(8) {
            0 => "ab c".repeat(self.random.below(600)),
            1 => self.joint_name().unwrap_or_default(),
            2..5 => format!("j{}", self.random.below(50)),
            _ => self.one_of(&NAMES).to_owned(),
        }
    }

    fn joint_name(&mut self) -> Option<String> {
        let joint = self.joint();
        Some(self.session.skeleton().skeleton.joint(joint)?.name.clone())
    }

    pub fn target(&mut self) -> Target {
        let joint = self.aimed();
        let size = self.session.skeleton().reach();
        let path = self.one_of(&[Path::Still, Path::Still, Path::Circle, Path::FigureEight]);
        let motion = Motion { path, radius: self.number(0.3 * size), period: self.above_0(6.0) };
        let home = self.small_point();
        Target { joint, home, weight: self.above_0(2.0), enabled: self.chance(0.9), motion }
    }

    pub fn slither(&mut self) -> Option<Slither> {
        self.chance(0.4).then(|| Slither {
            radius: self.number(3.0),
            amplitude: self.number(0.5),
            waves: self.one_of(&[0, 1, 3, 6, 40]),
            period: self.above_0(6.0),
        })
    }

    pub fn options(&mut self) -> Options {
        let iterations = self.one_of(&[0, 1, 3, 20, 100, 1000]);
        let tolerance = self.above_0(0.1);
        Options {
            method: self.one_of(&Method::ALL),
            iterations: self.chance(0.3).then_some(iterations),
            tolerance: self.chance(0.3).then_some(tolerance),
            damping: self.above_0(0.2),
            step: self.above_0(2.0),
            root: if self.chance(0.2) { Root::Free } else { Root::Fixed },
        }
    }

    pub fn iterations_per_frame(&mut self) -> u32 {
        match self.random.below(40) {
            0 => self.one_of(&[0, 1000, 100_000, u32::MAX]),
            _ => 1 + self.random.below(16) as u32,
        }
    }

    pub fn softening(&mut self) -> Softening {
        let softness = self.one_of(&[0.0, 0.0, 0.1, 0.25, 0.5, 0.99, 1.0_f32.next_down()]);
        let stretch = self.one_of(&[1.0, 1.0, 1.0, 1.2, 2.0, 100.0, f32::MAX]);
        let stretch = if stretch == f32::MAX && !self.is_wild() { 1.5 } else { stretch };
        let angle = self.one_of(&[0.0, 0.0, 0.3, 1.5, 3.0, PI.next_down()]);
        Softening::new(softness, stretch, angle).expect("a softening")
    }

    // Time and keys

    pub fn time(&mut self) -> f64 {
        if self.is_wild() {
            return self.one_of(&[
                f64::NAN,
                f64::INFINITY,
                f64::MAX,
                f64::MIN,
                1e300,
                -1e18,
                5e-324,
                -0.0,
                1e-9,
            ]);
        }
        let timeline = self.session.document().timeline;
        match self.random.below(8) {
            0 => self.one_of(&[timeline.start, timeline.end, 0.0, -1.0, 100.0]),
            1 => {
                let key = self.key();
                key.1
            }
            2 | 3 => timeline.time(self.random.below(timeline.frames().min(1000))),
            _ => f64::from(self.random.below(17) as u32) * 0.5,
        }
    }

    pub fn channel(&mut self) -> Channel {
        let shown = self.session.all_channels();
        if !shown.is_empty() && self.chance(0.6) {
            return self.one_of(&shown);
        }
        let joint = self.joint();
        match self.random.below(20) {
            0 => Channel::Rotation(joint),
            1 => Channel::Offset(joint),
            2 | 3 => Channel::Target(self.aimed()),
            4 => Channel::Enabled(self.aimed()),
            5 => Channel::Layer(self.layer()),
            6 => Channel::Translation,
            _ => self.one_of(&Channel::OF_ARM),
        }
    }

    /// None, one or some, also twice.
    pub fn channels(&mut self) -> Vec<Channel> {
        match self.random.below(6) {
            0 => self.session.channels_to_key(),
            count => (0..count).map(|_| self.channel()).collect(),
        }
    }

    /// Mostly one that is there, if any is.
    pub fn key(&mut self) -> Key {
        let keys = &self.session.document().keys;
        let count = keys.tracks().count();
        if count > 0 && self.chance(0.9) {
            let place = self.random.below(count);
            if let Some((channel, track)) = keys.tracks().nth(place) {
                return (channel, track.knots()[self.random.below(track.knots().len())].time);
            }
        }
        (self.channel(), f64::from(self.random.below(9) as u32))
    }

    pub fn keys(&mut self) -> Vec<Key> {
        match self.random.below(6) {
            0 => self.session.selected_keys().to_vec(),
            count => (0..count).map(|_| self.key()).collect(),
        }
    }

    /// How far keys go.
    pub fn shift(&mut self) -> f64 {
        let mut times = || self.time();
        let (from, to) = (times(), times());
        to - from
    }

    pub fn timeline(&mut self) -> Timeline {
        let (start, end) = (self.time(), self.time());
        let (start, end) =
            if self.chance(0.9) { (start.min(end), end.max(start)) } else { (end, start) };
        let frame_rate = self.one_of(&[24, 30, 60, 1, 1000, 0, 7, 1001, u32::MAX]);
        Timeline { start, end, frame_rate }
    }

    /// Of the window: it goes on, stands, jumps or goes back.
    pub fn seconds(&mut self) -> f64 {
        if self.is_wild() {
            return self.one_of(&[f64::NAN, f64::INFINITY, f64::MAX, -1.0, 1e17]);
        }
        *self.clock += match self.random.below(12) {
            0 => 0.0,
            1 => 7.5,
            2 => -0.5,
            _ => 1.0 / 60.0,
        };
        *self.clock
    }

    pub fn speed(&mut self) -> f64 {
        f64::from(self.number(4.0))
    }

    // The view

    pub fn place(&mut self) -> Vec2 {
        Vec2::new(self.number(1.0), self.number(1.0))
    }

    pub fn aspect(&mut self) -> f32 {
        if self.is_wild() { self.wild_number() } else { self.one_of(&[0.3, 1.0, 1.6, 3.0]) }
    }

    pub fn camera(&mut self) -> Camera {
        let camera = *self.session.camera();
        match self.random.below(5) {
            0 => self.session.framing_all(),
            1 => self.session.framing_selection(),
            2 => camera.along(self.one_of(&[
                AxisView::Front,
                AxisView::Back,
                AxisView::Right,
                AxisView::Left,
                AxisView::Top,
                AxisView::Bottom,
            ])),
            3 => {
                let (at, aspect) = (self.place(), self.aspect());
                camera.zoomed(self.above_0(3.0), at, aspect)
            }
            _ => {
                let size = self.size();
                Camera {
                    target: self.point(size),
                    yaw: self.number(7.0),
                    pitch: self.number(FRAC_PI_2),
                    distance: self.above_0(4.0 * size),
                    orthographic: self.coin(),
                }
            }
        }
    }

    pub fn turn(&mut self) -> Turn {
        self.one_of(&[Turn::Orbit, Turn::Pan, Turn::Zoom])
    }

    pub fn layer(&mut self) -> Layer {
        let all: Vec<Layer> = Layer::all().collect();
        self.one_of(&all)
    }

    // Drags

    pub fn grip(&mut self) -> Grip {
        let joint = self.joint();
        match self.random.below(8) {
            0 | 1 => Grip::Hand(self.handle()),
            2 => Grip::Pole(self.handle()),
            3 => Grip::Shoulder(self.axis()),
            4 => Grip::Bend,
            5 => Grip::Target(self.aimed(), self.handle()),
            6 => Grip::Tip(joint, self.handle()),
            _ => Grip::Ring(joint, self.axis()),
        }
    }

    fn handle(&mut self) -> Handle {
        match self.random.below(4) {
            0 => Handle::Axis(self.axis()),
            1 => Handle::Plane(self.axis()),
            _ => Handle::Free,
        }
    }

    pub fn constraint(&mut self) -> Option<Constraint> {
        match self.random.below(3) {
            0 => None,
            1 => Some(Constraint::Axis(self.axis())),
            _ => Some(Constraint::Plane(self.axis())),
        }
    }

    pub fn ray(&mut self) -> Ray {
        if self.is_wild() {
            let (origin, direction) = (self.point(100.0), self.point(1.0));
            return Ray { origin, direction };
        }
        let projection = self.session.camera().projection(1.6);
        if self.chance(0.3)
            && let Some(held) = self.session.point_drag().map(|drag| drag.moved())
            && let Some(at) = projection.project(held)
        {
            return projection.ray(at);
        }
        let at = Vec2::new(self.random.within(-1.0..1.0), self.random.within(-1.0..1.0));
        projection.ray(at)
    }

    pub fn forward(&mut self) -> Vec3 {
        if self.is_wild() { self.point(1.0) } else { self.session.camera().projection(1.0).forward }
    }

    pub fn drag_input(&mut self) -> DragInput {
        DragInput { ray: self.ray(), precise: self.chance(0.2), snap: self.chance(0.2) }
    }

    pub fn typed(&mut self) -> String {
        const TYPED: [&str; 16] = [
            "", "-", "1", "12.5", "-3,4", "1,2,3", ",,", "1,,2", "1e99", "1e38", "-1e38", "nan",
            "inf", "0,0,0,0", "é", "180",
        ];
        self.one_of(&TYPED).to_owned()
    }

    // Files

    pub fn path(&mut self) -> std::path::PathBuf {
        const PATHS: [&str; 7] = ["a.json", "/x/b.json", "", "é 😀.glb", "c.bvh", "..", "d.csv"];
        self.one_of(&PATHS).into()
    }

    pub fn file(&mut self) -> Option<std::path::PathBuf> {
        self.coin().then(|| self.path())
    }

    pub fn export(&mut self) -> Export {
        let side = self.one_of(&[0, 1, 100, u32::MAX]);
        Export { path: self.path(), frame_rate: self.one_of(&[0, 24, 5000]), size: (side, 100) }
    }

    pub fn job(&mut self) -> Job {
        Job { path: self.path(), progress: Arc::new(Progress::default()) }
    }

    pub fn example(&mut self) -> Example {
        self.one_of(&Example::ALL)
    }

    /// An example, or any forest, straight or in a mirror; of many joints once in a long while.
    pub fn document(&mut self) -> Document {
        match self.random.below(60) {
            0..30 => self.example().open().expect("it opens").document,
            30..34 => Document::default(),
            34 if self.chance(0.005) => skeleton(long_chain()),
            _ => {
                let joints = 1 + self.random.below(20);
                let mut forest = rigs::forest(self.random, joints);
                if self.coin() {
                    let transform = rigs::transform(self.random);
                    forest.set_transform(transform).expect("finite");
                }
                skeleton(forest)
            }
        }
    }

    pub fn dialog(&mut self) -> Dialog {
        let path = || "x.json".to_owned();
        match self.random.below(10) {
            0 => Dialog::About,
            1 => Dialog::Shortcuts,
            2 => Dialog::Recover { document: Box::new(self.document()), file: self.file() },
            3 => Dialog::Unsaved { then: Box::new(ik_arm::session::Action::Quit) },
            4 => Dialog::SavePicture { path: path() },
            5 => Dialog::Export(self.export()),
            6 => Dialog::Open { path: path() },
            7 => Dialog::SaveAs { path: path() },
            8 => {
                Dialog::ChooseSkeleton { path: self.path(), names: vec![self.name(), self.name()] }
            }
            _ => Dialog::Rename { joint: self.joint(), name: self.name() },
        }
    }
}

fn skeleton(skeleton: Skeleton) -> Document {
    let skeleton = SkeletonRig::new(skeleton);
    Document {
        rig: RigKind::Skeleton,
        camera: skeleton.first_view(),
        skeleton,
        ..Document::default()
    }
}

/// As many joints as there can be.
fn long_chain() -> Skeleton {
    let joint = |index: usize| {
        let parent = index.checked_sub(1);
        let offset = if parent.is_some() { Vec3::Y } else { Vec3::ZERO };
        Joint { offset, ..Joint::new(&format!("j{index}"), parent, Vec3::Y) }
    };
    let mut chain =
        Skeleton::from_joints((0..Skeleton::MOST_JOINTS).map(joint).collect()).expect("a skeleton");
    chain.set_transform(Affine3A::from_scale(Vec3::splat(0.01))).expect("finite");
    chain
}
