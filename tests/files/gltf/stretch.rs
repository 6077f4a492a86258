//! Scales of joints that change or are uneven reach the skin at every time, and return from exported
//! files.

use glam::{DAffine3, DMat4, DVec3, Mat4, Quat, Vec3};
use ik_arm::document::{Channel, Document, Timeline};
use ik_arm::io::{self, OpenOptions, Progress};
use ik_arm::kinematics::skeleton::{JointId, JointLimits, SkinStretch};
use ik_arm::kinematics::spline::{Interpolation, Knot};
use pollster::block_on;
use serde_json::json;

use crate::common::Random;
use crate::common::documents::example;
use crate::gltf::documents::glb;
use crate::gltf::interpolation::{Curve, File};
use crate::gltf::skin::{Strip, corners, documents_again, warnings};
use crate::gltf::text::Text;

/// A chain of joints whose scales change, with a mesh that follows them.
struct Stretched {
    file: File,
    strip: Strip,
    /// For each joint the inverse bind matrix.
    binds: Vec<Mat4>,
}

impl Stretched {
    /// Nodes `scaling` have scales of their own, with keys.
    fn random(random: &mut Random, kinds: [&'static str; 3], scaling: &[usize]) -> Self {
        let [turns, moves, scales] = kinds;
        let mut file = File::random(random, [turns, moves]);
        for node in scaling {
            let mut curve = Curve::random(random, *node, "scale", scales);
            let each = if scales == "CUBICSPLINE" { 3 } else { 1 };
            for (row, numbers) in curve.rows.iter_mut().enumerate() {
                let size = if row % each == each / 2 { 0.3..2.5 } else { -1.0..1.0 };
                *numbers = [0.0; 4].map(|_| random.within(size.clone()));
            }
            file.curves.push(curve);
        }
        let bind = |random: &mut Random| {
            let turn = Quat::from_scaled_axis(random.vector(2.0)).normalize();
            Mat4::from_scale_rotation_translation(
                Vec3::splat(random.within(0.5..2.0)),
                turn,
                random.vector(1.0),
            )
        };
        Self { file, strip: Strip::new(), binds: (0..3).map(|_| bind(random)).collect() }
    }

    fn text(&self) -> Text {
        let mut text = self.file.text();
        self.strip.add_to(&mut text);
        let numbers: Vec<f32> = self.binds.iter().flat_map(Mat4::to_cols_array).collect();
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let binds = text.accessor(&bytes, 5126, self.binds.len(), "MAT4");
        text.json["skins"][0]["inverseBindMatrices"] = json!(binds);
        text
    }

    fn document(&self) -> Document {
        let opened = io::parse("x.gltf", &self.text().embedded(), &OpenOptions::default());
        let opened = opened.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(warnings(&opened), [""; 0]);
        opened.document
    }

    /// The corners of all triangles, as the specification has them.
    fn corners(&self, time: f64) -> Vec<DVec3> {
        let worlds = &self.file.worlds(time)[1..];
        let motion = |(world, bind): (&DAffine3, &Mat4)| DMat4::from(*world) * bind.as_dmat4();
        let motions: Vec<DMat4> = worlds.iter().zip(&self.binds).map(motion).collect();
        let place = |vertex: usize| {
            let weighted = |place: usize| {
                let weight = f64::from(self.strip.weights[vertex][place]) / 255.0;
                motions[usize::from(self.strip.joints[vertex][place])] * weight
            };
            (weighted(0) + weighted(1)).transform_point3(self.strip.positions[vertex].as_dvec3())
        };
        self.strip.corners().into_iter().map(|corner| place(corner as usize)).collect()
    }

    #[track_caller]
    fn assert_shown(&self, document: &Document, times: &[f64], shift: f64, what: &str) {
        for time in times {
            let (found, expected) = (corners(document, time - shift), self.corners(*time));
            let size = expected.iter().map(|it| it.length()).fold(1.0, f64::max);
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(expected) {
                let gap = found.as_dvec3().distance(expected) / size;
                assert!(gap < 1e-4, "{what} at {time}: {found}, not {expected}: {gap:e}");
            }
        }
    }

    /// All frames of a document of the file, and the file's keys.
    fn frames(&self, document: &Document) -> Vec<f64> {
        let frames = (0..document.timeline.frames()).map(|it| document.timeline.time(it));
        frames.chain(self.file.key_times()).collect()
    }
}

const KINDS: [&str; 3] = ["LINEAR", "STEP", "CUBICSPLINE"];

#[test]
fn the_scale_of_a_last_joint_has_the_keys_of_the_file_at_every_time() {
    let mut random = Random(401);
    for case in 0..54 {
        let kinds = [KINDS[case % 3], KINDS[case / 3 % 3], KINDS[case / 9 % 3]];
        let stretched = Stretched::random(&mut random, kinds, &[3]);
        let document = stretched.document();
        let times = stretched.file.times(&mut random);
        stretched.assert_shown(&document, &times, 0.0, &format!("case {case}, {kinds:?}"));
        let joint = document.skeleton().find("n3").expect("a joint");
        let curve = stretched.file.curves.last().expect("a scale");
        let knots = document.keys.track(Channel::SkinScale(joint)).expect("keys").knots();
        assert_eq!(knots.iter().map(|it| it.time as f32).collect::<Vec<_>>(), curve.times);
    }
}

#[test]
fn scales_anywhere_in_the_hierarchy_reach_the_skin_in_every_frame() {
    let mut random = Random(402);
    for case in 0..60 {
        let scaling: Vec<usize> = (0..4).filter(|_| random.coin()).collect();
        let kinds = ["LINEAR", "LINEAR", KINDS[case % 3]];
        let stretched = Stretched::random(&mut random, kinds, &scaling);
        let document = stretched.document();
        // Steps jump at their keys, where single precision does not tell the sides apart.
        let mut times = stretched.frames(&document);
        if kinds[2] == "STEP" {
            let near =
                |time: &f64| stretched.file.key_times().iter().all(|it| (it - time).abs() > 1e-3);
            times.retain(near);
        }
        stretched.assert_shown(&document, &times, 0.0, &format!("case {case}, {scaling:?}"));
        let again = documents_again(&document);
        stretched.assert_shown(&again, &times, 0.0, &format!("case {case}, saved"));
    }
}

#[test]
fn scales_that_begin_at_0_or_change_their_sign_reach_the_skin() {
    let mut random = Random(403);
    for case in 0..40 {
        let mut stretched = Stretched::random(&mut random, ["LINEAR"; 3], &[3]);
        let curve = stretched.file.curves.last_mut().expect("a scale");
        curve.rows[0] = if case % 2 == 0 { [0.0; 4] } else { [0.0, 1.0, 1.0, 0.0] };
        *curve.rows.last_mut().expect("a key") = [-0.5, 0.7, 1.5, 0.0];
        let document = stretched.document();
        let times = stretched.file.times(&mut random);
        stretched.assert_shown(&document, &times, 0.0, &format!("case {case}"));
    }
}

#[test]
fn uneven_scales_that_stay_shear_the_skin_below_joints_that_turn() {
    let mut random = Random(404);
    for case in 0..30 {
        let mut stretched = Stretched::random(&mut random, ["LINEAR"; 3], &[1]);
        let curve = stretched.file.curves.last_mut().expect("a scale");
        let scale = random.vector(0.6) + Vec3::ONE;
        curve.rows.fill(scale.extend(0.0).to_array());
        let document = stretched.document();
        stretched.assert_shown(
            &document,
            &stretched.frames(&document),
            0.0,
            &format!("case {case}"),
        );
        assert!(document.keys.tracks().any(|(it, _)| matches!(it, Channel::SkinShear(_))));
    }
}

fn reopened(document: &Document) -> Document {
    let opened = io::read("x.glb", &glb(document)[..], &OpenOptions::default()).expect("it opens");
    assert_eq!(warnings(&opened), [""; 0]);
    opened.document
}

/// Asserts that a document and its reopened export show the same.
#[track_caller]
fn assert_same(document: &Document, again: &Document, times: &[f64], what: &str) {
    let start = document.timeline.start;
    for time in times {
        let metres = document.metres_per_unit();
        let expected: Vec<Vec3> =
            corners(document, *time).into_iter().map(|it| it * metres).collect();
        let found = corners(again, time - start.min(0.0));
        let size = expected.iter().map(|it| it.length()).fold(0.0, f32::max);
        assert_eq!(found.len(), expected.len());
        let gaps = found.iter().zip(&expected).map(|(found, it)| found.distance(*it));
        let gap = gaps.fold(0.0, f32::max) / size;
        assert!(gap < 1e-4, "{what} at {time}: {gap:e}");
    }
}

#[test]
fn keys_of_the_skins_scale_return_from_an_exported_file_as_they_are() {
    let kinds =
        [Interpolation::Linear, Interpolation::Step, Interpolation::Auto, Interpolation::Smooth];
    let mut random = Random(405);
    for case in 0..12 {
        let mut document = example("human");
        document.rig.targets.clear();
        document.timeline = Timeline { start: 0.0, end: 2.0, frame_rate: 30.0 };
        let kind = kinds[case % 4];
        let all: Vec<JointId> = document.skeleton().ids().collect();
        for joint in all {
            let unlimited =
                document.skeleton_mut().change(joint, |it| it.limits = JointLimits::NONE);
            unlimited.expect("no limits");
        }
        let joints: Vec<JointId> =
            document.skeleton().ids().filter(|_| random.chance(0.3)).collect();
        for joint in &joints {
            for time in [0.0, 0.5, 1.2, 2.0] {
                let value = Vec3::ONE + random.vector(0.6);
                let knot = Knot { interpolation: kind, ..Knot::new(time, value) };
                document.keys.insert_key(Channel::SkinScale(*joint), knot);
                let turn = Knot {
                    interpolation: Interpolation::Slerp,
                    ..Knot::new(time, random.vector(0.5))
                };
                document.keys.insert_key(Channel::Rotation(*joint), turn);
            }
        }
        let again = reopened(&document);
        for joint in &joints {
            let joint_again =
                again.skeleton().find(&document.skeleton()[*joint].name).expect("a joint");
            let before = document.keys.track(Channel::SkinScale(*joint)).expect("keys");
            let after = again.keys.track(Channel::SkinScale(joint_again)).expect("keys");
            for (before, after) in before.knots().iter().zip(after.knots()) {
                assert_eq!((before.time, before.interpolation), (after.time, after.interpolation));
                assert!(before.value.distance(after.value) < 1e-6);
            }
            assert_eq!(before.knots().len(), after.knots().len());
        }
        let times: Vec<f64> = (0..40).map(|_| f64::from(random.within(0.0..2.0))).collect();
        assert_same(&document, &again, &times, &format!("case {case}"));
    }
}

/// The Human with joints that scale and shear the skin, some over time.
pub fn sheared(random: &mut Random) -> Document {
    let mut document = example("human");
    document.rig.targets.clear();
    document.timeline = Timeline { start: -0.5, end: 1.0, frame_rate: 24.0 };
    for joint in document.skeleton().ids().collect::<Vec<_>>() {
        let still =
            SkinStretch { scale: Vec3::ONE + random.vector(0.5), shear: random.vector(0.4) };
        match random.below(4) {
            0 => document.skeleton_mut().change(joint, |it| it.skin = still).expect("finite"),
            1 => {
                for time in [-0.5, 0.25, 1.0] {
                    let (scale, shear) = (Vec3::ONE + random.vector(0.5), random.vector(0.4));
                    document.keys.insert(Channel::SkinScale(joint), time, scale);
                    document.keys.insert(Channel::SkinShear(joint), time, shear);
                    document.keys.insert(Channel::Rotation(joint), time, random.vector(0.4));
                }
            }
            _ => {}
        }
    }
    document
}

#[test]
fn shears_of_the_skin_return_from_an_exported_file_in_every_frame() {
    let mut random = Random(406);
    for case in 0..8 {
        let document = sheared(&mut random);
        let again = reopened(&document);
        assert_eq!(again.skeleton().joints().len(), document.skeleton().joints().len());
        let frames = (0..document.timeline.frames()).map(|it| document.timeline.time(it));
        assert_same(&document, &again, &frames.collect::<Vec<_>>(), &format!("case {case}"));
    }
}

#[test]
fn imported_stretches_return_from_an_exported_file() {
    let mut random = Random(407);
    for case in 0..20 {
        let stretched = Stretched::random(&mut random, ["LINEAR"; 3], &[0, 2]);
        let document = stretched.document();
        let again = reopened(&document);
        let times: Vec<f64> =
            (0..document.timeline.frames()).map(|it| document.timeline.time(it)).collect();
        stretched.assert_shown(&again, &times, 0.0, &format!("case {case}"));
    }
}

#[test]
fn bvh_tells_that_it_has_no_scales_of_the_skin() {
    let mut document = example("human");
    let joint = document.skeleton().find("head").unwrap_or(JointId::new(3));
    let notes = |document: &Document| {
        let unit = io::BvhUnit::default();
        block_on(io::to_bvh(document, None, unit, &Progress::default())).expect("written").notes
    };
    assert_eq!(notes(&document), [""; 0]);
    document.keys.insert(Channel::SkinScale(joint), 0.0, Vec3::splat(2.0));
    let notes = notes(&document);
    assert!(notes[0].contains("BVH has neither skins nor scales"), "{notes:?}");
}
