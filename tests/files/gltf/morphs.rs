//! Morph targets: read, animated, saved and written, against weights and offsets added in f64.

use glam::{DVec3, Vec3};
use ik_arm::document::{Channel, Document};
use ik_arm::io::{self, OpenOptions, Opened};
use ik_arm::kinematics::skin::Skinning;
use ik_arm::session::{FileAction, Session, SkinEdit, TransactionAction};
use serde_json::json;

use crate::common::Random;
use crate::gltf::documents::glb;
use crate::gltf::skin::{Strip, corners, documents_again, warnings};
use crate::gltf::text::Text;

const TARGETS: usize = 3;

/// A strip with random morph targets whose weights an animation changes.
struct Morphed {
    text: Text,
    /// For each target its offsets of the six vertices.
    offsets: Vec<Vec<Vec3>>,
    defaults: [f32; TARGETS],
    kind: &'static str,
    times: Vec<f32>,
    /// For each key its weights; for cubic splines three rows.
    rows: Vec<[f32; TARGETS]>,
}

impl Morphed {
    fn new(random: &mut Random, kind: Option<&'static str>) -> Self {
        let strip = Strip::new();
        let mut text = strip.text();
        let offset = |random: &mut Random| {
            if random.coin() { Vec3::ZERO } else { random.vector(0.5) }
        };
        let offsets: Vec<Vec<Vec3>> =
            (0..TARGETS).map(|_| (0..6).map(|_| offset(random)).collect()).collect();
        let mut targets = Vec::new();
        for target in &offsets {
            let numbers: Vec<f32> = target.iter().flat_map(Vec3::to_array).collect();
            targets.push(json!({ "POSITION": text.floats(3, &numbers) }));
        }
        let mesh = &mut text.json["meshes"][0];
        mesh["primitives"][0]["targets"] = json!(targets);
        mesh["extras"] = json!({ "targetNames": ["smile", "blink", "smile"] });
        let defaults = [(); TARGETS].map(|()| random.within(-0.5..1.5));
        mesh["weights"] = json!(defaults);
        let mut morphed = Self {
            text,
            offsets,
            defaults,
            kind: kind.unwrap_or_default(),
            times: vec![],
            rows: vec![],
        };
        if kind.is_some() {
            morphed.animate(random);
        }
        morphed
    }

    fn animate(&mut self, random: &mut Random) {
        let mut time = random.within(0.0..0.3);
        for _ in 0..2 + random.below(5) {
            self.times.push(time);
            time += random.within(0.05..0.7);
        }
        let each = if self.kind == "CUBICSPLINE" { 3 } else { 1 };
        let rows = each * self.times.len();
        self.rows = (0..rows).map(|_| [(); TARGETS].map(|()| random.within(-1.0..1.5))).collect();
        let numbers: Vec<f32> = self.rows.iter().flatten().copied().collect();
        let (times, values) = (self.text.floats(1, &self.times), self.text.floats(1, &numbers));
        let node = self.text.json["nodes"].as_array().expect("nodes").len() - 1;
        self.text.animate(node, "weights", self.kind, times, values);
    }

    fn opened(&self) -> Opened {
        io::parse("test.gltf", &self.text.embedded(), &OpenOptions::default())
            .unwrap_or_else(|error| panic!("{error}"))
    }

    /// The weight of a target, as the specification has it.
    fn weight(&self, target: usize, time: f64) -> f64 {
        if self.times.is_empty() {
            return self.defaults[target].into();
        }
        let each = self.rows.len() / self.times.len();
        let row = |row: usize| f64::from(self.rows[row][target]);
        let value = |key: usize| row(each * key + each / 2);
        let times: Vec<f64> = self.times.iter().map(|time| f64::from(*time)).collect();
        let last = times.len() - 1;
        if time <= times[0] {
            return value(0);
        }
        let Some(key) = (0..last).find(|key| time < times[key + 1]) else { return value(last) };
        let span = times[key + 1] - times[key];
        let t = (time - times[key]) / span;
        match self.kind {
            "STEP" => value(key),
            "LINEAR" => value(key) * (1.0 - t) + value(key + 1) * t,
            _ => {
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * value(key)
                    + span * (t3 - 2.0 * t2 + t) * row(each * key + 2)
                    + (-2.0 * t3 + 3.0 * t2) * value(key + 1)
                    + span * (t3 - t2) * row(each * (key + 1))
            }
        }
    }

    /// The corners of all triangles; the joints do not move, so that they are those of the mesh.
    fn corners(&self, time: f64) -> Vec<Vec3> {
        let strip = Strip::new();
        let place = |vertex: usize| {
            let changes = (0..TARGETS)
                .map(|target| self.weight(target, time) * self.offsets[target][vertex].as_dvec3());
            // Without inverse bind matrices, a joint brings the mesh to itself: here up by 1 each.
            let up = (0..2).map(|place| {
                let weight = f64::from(strip.weights[vertex][place]) / 255.0;
                weight * f64::from(strip.joints[vertex][place])
            });
            let moved = strip.positions[vertex].as_dvec3() + changes.sum::<DVec3>();
            (moved + DVec3::Y * up.sum::<f64>()).as_vec3()
        };
        strip.corners().into_iter().map(|corner| place(corner as usize)).collect()
    }

    /// Times at, between, before and after the keys.
    fn sampled(&self, random: &mut Random) -> Vec<f64> {
        let keys = self.times.iter().map(|time| f64::from(*time));
        let between = (0..20).map(|_| f64::from(random.within(-0.5..4.0)));
        keys.chain(between.collect::<Vec<_>>()).collect()
    }
}

#[track_caller]
fn assert_is(document: &Document, morphed: &Morphed, time: f64, shift: f64, what: &str) {
    let (found, expected) = (corners(document, time - shift), morphed.corners(time));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let gap = found.distance(expected);
        assert!(gap < 1e-4, "{what}, {time} s: {found}, not {expected}");
    }
}

#[test]
fn default_weights_change_the_mesh() {
    let mut random = Random(1);
    for case in 0..20 {
        let mut morphed = Morphed::new(&mut random, None);
        if random.coin() {
            let node = morphed.text.json["nodes"].as_array().expect("nodes").len() - 1;
            morphed.defaults = [(); TARGETS].map(|()| random.within(-1.0..1.0));
            morphed.text.json["nodes"][node]["weights"] = json!(morphed.defaults);
        }
        let opened = morphed.opened();
        assert_eq!(warnings(&opened), [""; 0]);
        assert_is(&opened.document, &morphed, 0.0, 0.0, &format!("case {case}"));
    }
}

#[test]
fn weights_follow_their_keys_and_are_saved_and_exported() {
    let mut random = Random(2);
    for case in 0..60 {
        let kind = random.one_of(&["LINEAR", "STEP", "CUBICSPLINE"]);
        let morphed = Morphed::new(&mut random, Some(kind));
        let document = morphed.opened().document;
        let again = documents_again(&document);
        assert_eq!(again.rig.skin, document.rig.skin, "case {case}, {kind}");
        assert_eq!(again.keys, document.keys, "case {case}, {kind}");
        let exported = io::read("x.glb", &glb(&document)[..], &OpenOptions::default());
        let exported = exported.expect("it opens").document;
        let names = |document: &Document| -> Vec<String> {
            let skin = document.rig.skin.as_ref().and_then(|skin| skin.mesh_skin());
            let mesh = &skin.and_then(|skin| skin.in_file()).expect("a mesh").mesh;
            mesh.morphs().iter().map(|morph| morph.name.clone()).collect()
        };
        assert_eq!(names(&document), ["smile", "blink", "smile_2"]);
        assert_eq!(names(&exported), names(&document));
        for time in morphed.sampled(&mut random) {
            for (document, what) in
                [(&document, "read"), (&again, "saved"), (&exported, "exported")]
            {
                // A step may be a rounding error away.
                let is_near = morphed.times.iter().any(|key| (f64::from(*key) - time).abs() < 1e-5);
                if !(kind == "STEP" && is_near) {
                    assert_is(
                        document,
                        &morphed,
                        time,
                        0.0,
                        &format!("case {case}, {kind}, {what}"),
                    );
                }
            }
        }
    }
}

#[test]
fn joints_move_the_changed_mesh_and_normals_turn_with_it() {
    let mut random = Random(3);
    for _ in 0..20 {
        let morphed = Morphed::new(&mut random, None);
        let mut document = morphed.opened().document;
        for joint in document.skeleton().ids() {
            let turn = random.vector(1.0);
            document.rig.skeleton_mut().set_rotation(joint, turn).expect("finite");
        }
        let skin = document.rig.skin.as_ref().expect("a skin");
        let mesh = &skin.mesh().expect("a mesh").mesh;
        let pose = mesh.pose(document.skeleton());
        let posed = mesh.posed(&pose, Skinning::Linear);
        let strip = Strip::new();
        for vertex in 0..6 {
            let changes = (0..TARGETS).map(|target| {
                f64::from(morphed.defaults[target]) * morphed.offsets[target][vertex].as_dvec3()
            });
            let at = strip.positions[vertex].as_dvec3() + changes.sum::<DVec3>();
            let expected: DVec3 = (0..2)
                .map(|place| {
                    let joint = usize::from(strip.joints[vertex][place]);
                    let weight = f64::from(strip.weights[vertex][place]) / 255.0;
                    let space = document.skeleton().full_transform(joint.into()).as_daffine3();
                    weight * space.transform_point3(at)
                })
                .sum();
            let gap = posed.positions[vertex].distance(expected.as_vec3());
            assert!(gap < 1e-4, "vertex {vertex}: {gap}");
            assert!((posed.normals[vertex].length() - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn a_file_that_only_morphs_is_animated() {
    let mut random = Random(4);
    let morphed = Morphed::new(&mut random, Some("LINEAR"));
    let opened = morphed.opened();
    assert_eq!(opened.animation, Some(0));
    let animation = &opened.animations[0];
    assert!(animation.has_morphs && animation.moves(), "{animation:?}");
    let document = &opened.document;
    assert!(document.keys.has(Channel::Morph(0)) && document.is_animated());
    let ends = [document.timeline.start, document.timeline.end];
    for (end, time) in
        ends.into_iter().zip([morphed.times[0], *morphed.times.last().expect("keys")])
    {
        assert!((end - f64::from(time)).abs() < 1e-4, "{end} is not {time}");
    }
}

#[test]
fn weights_are_edited_keyed_and_undone() {
    let morphed = Morphed::new(&mut Random(5), None);
    let mut session = Session::default();
    let document = Box::new(morphed.opened().document);
    session.apply(FileAction::Opened { document, file: None, contents: None });
    let weight = |session: &Session| session.rig().morph_weight(1).expect("a target");
    let before = weight(&session);
    session.apply(SkinEdit::SetMorph { morph: 1, weight: 0.75 });
    assert_eq!(weight(&session), 0.75);
    session.apply(SkinEdit::SetMorph { morph: 99, weight: 0.5 });
    session.apply(TransactionAction::Undo);
    assert_eq!(weight(&session), before);
}

#[test]
fn damaged_morph_targets_leave_the_skin_out_with_the_reason() {
    let reason = |change: &dyn Fn(&mut Text)| {
        let mut morphed = Morphed::new(&mut Random(6), None);
        change(&mut morphed.text);
        warnings(&morphed.opened()).join("\n")
    };
    let targets = |text: &mut Text, value: serde_json::Value| {
        text.json["meshes"][0]["primitives"][0]["targets"] = value;
    };
    let short = reason(&|text| {
        let short = text.floats(3, &[0.0; 9]);
        targets(text, json!([{ "POSITION": short }]));
    });
    assert!(
        short.contains("must have 6 rows like POSITION, got 3; the skin is left out"),
        "{short}"
    );
    let missing = reason(&|text| targets(text, json!([{ "POSITION": 9999 }])));
    assert!(missing.contains("the skin is left out"), "{missing}");
    let infinite = reason(&|text| {
        let infinite = text.floats(3, &[f32::NAN; 18]);
        targets(text, json!([{ "POSITION": infinite }]));
    });
    assert!(infinite.contains("morph target 0 must have a finite offset"), "{infinite}");
}
