//! Keys and the curves between them, against a reader written for these tests.

use glam::{DAffine3, DQuat, DVec3, DVec4, Quat, Vec3};
use ik_arm::document::{Channel, Document};
use ik_arm::io;
use ik_arm::kinematics::spline::Interpolation;
use serde_json::{Value, json};

use crate::common::Random;
use crate::gltf::documents::glb;
use crate::gltf::glb::{Glb, index};
use crate::gltf::text::Text;

/// A sampler of the file, as the specification has it: rows of times and values.
struct Curve {
    node: usize,
    path: &'static str,
    kind: &'static str,
    times: Vec<f32>,
    /// For cubic splines three rows a key: in-tangent, value, out-tangent.
    rows: Vec<[f32; 4]>,
}

impl Curve {
    fn random(random: &mut Random, node: usize, path: &'static str, kind: &'static str) -> Self {
        let mut time = random.within(0.0..0.3);
        let mut times = Vec::new();
        for _ in 0..2 + random.below(6) {
            times.push(time);
            time += random.within(0.05..0.7);
        }
        let value = |random: &mut Random| match path {
            "rotation" => {
                let turn = random.vector(2.0);
                Quat::from_scaled_axis(turn).to_array()
            }
            _ => random.vector(1.0).extend(0.0).to_array(),
        };
        let tangent = |random: &mut Random| random.vector(2.0).extend(random.within(-2.0..2.0));
        let row = |random: &mut Random| match kind {
            "CUBICSPLINE" => {
                vec![tangent(random).to_array(), value(random), tangent(random).to_array()]
            }
            _ => vec![value(random)],
        };
        let rows = times.iter().flat_map(|_| row(random)).collect();
        Self { node, path, kind, times, rows }
    }

    fn write(&self, text: &mut Text) {
        let width = if self.path == "rotation" { 4 } else { 3 };
        let numbers: Vec<f32> =
            self.rows.iter().flat_map(|row| row.iter().take(width).copied()).collect();
        let (times, values) = (text.floats(1, &self.times), text.floats(width, &numbers));
        text.animate(self.node, self.path, self.kind, times, values);
    }

    fn at(&self, time: f64) -> DVec4 {
        let times: Vec<f64> = self.times.iter().map(|time| f64::from(*time)).collect();
        let row = |index: usize| DVec4::from_array(self.rows[index].map(f64::from));
        let each = if self.kind == "CUBICSPLINE" { 3 } else { 1 };
        let value = |key: usize| row(each * key + each / 2);
        let last = times.len() - 1;
        if time <= times[0] {
            return value(0);
        }
        let Some(key) = (0..last).find(|key| time < times[key + 1]) else { return value(last) };
        let span = times[key + 1] - times[key];
        let s = (time - times[key]) / span;
        match self.kind {
            "STEP" => value(key),
            "LINEAR" if self.path == "rotation" => {
                let [a, b] =
                    [value(key), value(key + 1)].map(|it| DQuat::from_vec4(it).normalize());
                // Along the great arc, by axis and angle.
                let (axis, angle) = (a.inverse() * b).to_axis_angle();
                let angle = if angle > std::f64::consts::PI {
                    angle - std::f64::consts::TAU
                } else {
                    angle
                };
                DVec4::from_array((a * DQuat::from_axis_angle(axis, s * angle)).to_array())
            }
            "LINEAR" => value(key) + (value(key + 1) - value(key)) * s,
            _ => {
                let (leaving, arriving) = (row(3 * key + 2) * span, row(3 * key + 3) * span);
                value(key) * (2.0 * s.powi(3) - 3.0 * s.powi(2) + 1.0)
                    + leaving * (s.powi(3) - 2.0 * s.powi(2) + s)
                    + value(key + 1) * (3.0 * s.powi(2) - 2.0 * s.powi(3))
                    + arriving * (s.powi(3) - s.powi(2))
            }
        }
    }
}

/// Four nodes in a row, turned, moved and scaled evenly, all of them joints but the first.
struct File {
    nodes: Vec<(DVec3, DQuat, f64)>,
    curves: Vec<Curve>,
}

impl File {
    fn random(random: &mut Random, kinds: [&'static str; 2]) -> Self {
        let node = |random: &mut Random| {
            let turn = Quat::from_scaled_axis(random.vector(2.0)).as_dquat().normalize();
            (random.vector(1.0).as_dvec3(), turn, f64::from(random.within(0.3..3.0)))
        };
        let nodes = (0..4).map(|_| node(random)).collect();
        let mut curves = Vec::new();
        for node in 1..4 {
            for (path, kind) in ["rotation", "translation"].into_iter().zip(kinds) {
                if node == 1 || random.chance(0.8) {
                    curves.push(Curve::random(random, node, path, kind));
                }
            }
        }
        Self { nodes, curves }
    }

    fn text(&self) -> Text {
        let node = |(index, (at, turn, scale)): (usize, &(DVec3, DQuat, f64))| {
            let children: Vec<usize> = (index + 1..4).take(1).collect();
            let mut node = json!({
                "name": format!("n{index}"),
                "translation": at.as_vec3().to_array(),
                "rotation": turn.as_quat().to_array(),
                "scale": vec![*scale as f32; 3],
            });
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            node
        };
        let nodes: Vec<_> = self.nodes.iter().enumerate().map(node).collect();
        let mut text = Text::new(json!(nodes), &[1, 2, 3]);
        self.curves.iter().for_each(|curve| curve.write(&mut text));
        text
    }

    /// Transforms of the nodes to the world.
    fn worlds(&self, time: f64) -> Vec<DAffine3> {
        let mut world = DAffine3::IDENTITY;
        let node = |(index, (at, turn, scale)): (usize, &(DVec3, DQuat, f64))| {
            let of = |path| self.curves.iter().find(|it| it.node == index && it.path == path);
            let at = of("translation").map_or(at.as_vec3().as_dvec3(), |it| it.at(time).truncate());
            let given = turn.as_quat().as_dquat().normalize();
            let turn = of("rotation").map_or(given, |it| DQuat::from_vec4(it.at(time)).normalize());
            let scale = DVec3::splat(f64::from(*scale as f32));
            world *= DAffine3::from_scale_rotation_translation(scale, turn, at);
            world
        };
        self.nodes.iter().enumerate().map(node).collect()
    }

    fn times(&self, random: &mut Random) -> Vec<f64> {
        let keys =
            self.curves.iter().flat_map(|curve| curve.times.iter().map(|time| f64::from(*time)));
        // A step jumps at a key, so its side must be certain.
        let keys = keys.flat_map(|time| [time - 1e-4, time + 1e-4]);
        let between = (0..40).map(|_| f64::from(random.within(-0.2..5.0)));
        keys.chain(between.collect::<Vec<_>>()).collect()
    }
}

fn document(text: &Text) -> Document {
    let opened = io::parse("x.gltf", &text.embedded(), &io::OpenOptions::default());
    opened.unwrap_or_else(|error| panic!("{error}")).document
}

#[test]
fn every_curve_is_where_an_independent_reader_has_it_at_keys_and_between() {
    let kinds = ["LINEAR", "STEP", "CUBICSPLINE"];
    let mut random = Random(18);
    for case in 0..90 {
        let file = File::random(&mut random, [kinds[case % 3], kinds[case / 3 % 3]]);
        let document = document(&file.text());
        for time in file.times(&mut random) {
            let (expected, evaluated) = (file.worlds(time), document.evaluate(time));
            let pose = evaluated.skeleton().pose();
            let size = expected.iter().map(|world| world.translation.length()).fold(1.0, f64::max);
            for (node, expected) in expected.iter().enumerate().skip(1) {
                let joint = evaluated.skeleton().find(&format!("n{node}")).expect("a joint");
                let (is, was) = (pose.base(joint).as_dvec3(), expected.translation);
                let far = is.distance(was) / size;
                assert!(far < 1e-5, "case {case}, n{node} at {time}: {is}, not {was}: {far:e}");
            }
        }
    }
}

#[test]
fn linear_and_stepped_keys_stay_the_keys_of_the_file() {
    let mut random = Random(5);
    for (kind, expected) in [
        ("LINEAR", [Interpolation::Slerp, Interpolation::Linear]),
        ("STEP", [Interpolation::Step; 2]),
    ] {
        let file = File::random(&mut random, [kind; 2]);
        let document = document(&file.text());
        for curve in &file.curves {
            let joint = document.skeleton().find(&format!("n{}", curve.node)).expect("a joint");
            let (channel, interpolation) = match curve.path {
                "rotation" => (Channel::Rotation(joint), expected[0]),
                _ => (Channel::Offset(joint), expected[1]),
            };
            let knots = document.keys.track(channel).expect("keyed").knots();
            let times: Vec<f32> = knots.iter().map(|knot| knot.time as f32).collect();
            assert_eq!(times, curve.times);
            assert!(knots.iter().all(|knot| knot.interpolation == interpolation));
        }
    }
}

/// Interpolations of the samplers of a file, by the names of their nodes and their paths.
fn kinds(glb: &Glb) -> Vec<(String, String, String)> {
    let animation = &glb.json["animations"][0];
    let channels = animation["channels"].as_array().into_iter().flatten();
    let kind = |channel: &Value| {
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        let text = |value: &Value| value.as_str().expect("a text").to_owned();
        let target = &channel["target"];
        let node = glb.name(index(&target["node"])).to_owned();
        (node, text(&target["path"]), text(&sampler["interpolation"]))
    };
    channels.map(kind).collect()
}

#[test]
fn an_exported_file_keeps_the_keys_with_their_interpolation_and_the_curves_between() {
    let all = ["LINEAR", "STEP", "CUBICSPLINE"];
    let mut random = Random(19);
    for case in 0..60 {
        let turned = all[case % 2];
        let file = File::random(&mut random, [turned, all[case / 2 % 3]]);
        let before = document(&file.text());
        let bytes = glb(&before);
        let written = kinds(&Glb::new(&bytes));
        for curve in &file.curves {
            let node = format!("n{}", curve.node);
            let is_it =
                |(name, path, _): &&(String, String, String)| *name == node && path == curve.path;
            let found =
                written.iter().find(is_it).unwrap_or_else(|| panic!("{node} {}", curve.path));
            assert_eq!(found.2, curve.kind, "{node} {}", curve.path);
        }
        let opened = io::read("x.glb", &bytes[..], &io::OpenOptions::default());
        let after = opened.unwrap_or_else(|error| panic!("{error}")).document;
        assert_eq!(after.animation_name, before.animation_name);
        assert_eq!(after.timeline.start, before.timeline.start, "case {case}");
        assert!(
            (after.timeline.end - before.timeline.end).abs() < 1e-3 / before.timeline.frame_rate
        );
        for time in file.times(&mut random) {
            let [was, is] = [&before, &after].map(|document| document.evaluate(time));
            let (old, new) = (was.skeleton().pose(), is.skeleton().pose());
            let size = old.points().map(Vec3::length).fold(1.0, f32::max);
            for joint in was.skeleton().ids() {
                let name = &was.skeleton()[joint].name;
                let found = is.skeleton().find(name).expect("a joint");
                let far = new.base(found).distance(old.base(joint)) / size;
                assert!(far < 1e-5, "case {case}, {name} at {time}: {far:e}");
            }
        }
    }
}

#[test]
fn uneven_scales_above_a_joint_give_keys_at_every_frame_at_the_same_places() {
    let mut random = Random(7);
    for _ in 0..10 {
        let file = File::random(&mut random, ["LINEAR"; 2]);
        let mut text = file.text();
        text.json["nodes"][0]["scale"] = json!([1.0, 2.0, 0.5]);
        let document = document(&text);
        let rate = document.timeline.frame_rate;
        assert!(document.keys.tracks().any(|(_, track)| track.knots().len() > 10), "{rate}");
        let start = document.timeline.start;
        let (world, evaluated) = (file.worlds(start)[1], document.evaluate(start));
        let inner = file.worlds(start)[0].inverse() * world;
        let (at, turn, scale) = file.nodes[0];
        let stretched = DVec3::new(1.0, 2.0, 0.5);
        let _ = scale;
        let outer = DAffine3::from_scale_rotation_translation(
            stretched,
            turn.as_quat().as_dquat().normalize(),
            at.as_vec3().as_dvec3(),
        );
        let expected = (outer * inner).translation.as_vec3();
        let joint = evaluated.skeleton().find("n1").expect("a joint");
        let found = evaluated.skeleton().pose().base(joint);
        assert!(found.distance(expected) < 1e-4, "{found}, not {expected}: {}", Vec3::ZERO);
    }
}
