//! Keys and the curves between them, against a reader written for these tests.

use glam::{DAffine3, DQuat, DVec3, DVec4, Quat, Vec3};
use ik_arm::document::{Channel, Document};
use ik_arm::io;
use ik_arm::kinematics::skeleton::{JointId, JointLimits};
use ik_arm::kinematics::spline::{Interpolation, Knot, Slopes};
use serde_json::{Value, json};

use crate::common::Random;
use crate::common::documents::example;
use crate::gltf::documents::glb;
use crate::gltf::glb::{Glb, index};
use crate::gltf::text::Text;

/// A sampler of the file, as the specification has it: rows of times and values.
pub struct Curve {
    pub node: usize,
    pub path: &'static str,
    pub kind: &'static str,
    pub times: Vec<f32>,
    /// For cubic splines three rows a key: in-tangent, value, out-tangent.
    pub rows: Vec<[f32; 4]>,
}

impl Curve {
    pub fn random(
        random: &mut Random,
        node: usize,
        path: &'static str,
        kind: &'static str,
    ) -> Self {
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

    pub fn write(&self, text: &mut Text) {
        let width = if self.path == "rotation" { 4 } else { 3 };
        let numbers: Vec<f32> =
            self.rows.iter().flat_map(|row| row.iter().take(width).copied()).collect();
        let (times, values) = (text.floats(1, &self.times), text.floats(width, &numbers));
        text.animate(self.node, self.path, self.kind, times, values);
    }

    pub fn at(&self, time: f64) -> DVec4 {
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
pub struct File {
    pub nodes: Vec<(DVec3, DQuat, f64)>,
    pub curves: Vec<Curve>,
}

impl File {
    pub fn random(random: &mut Random, kinds: [&'static str; 2]) -> Self {
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

    pub fn text(&self) -> Text {
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
    pub fn worlds(&self, time: f64) -> Vec<DAffine3> {
        let mut world = DAffine3::IDENTITY;
        let node = |(index, (at, turn, scale)): (usize, &(DVec3, DQuat, f64))| {
            let of = |path| self.curves.iter().find(|it| it.node == index && it.path == path);
            let at = of("translation").map_or(at.as_vec3().as_dvec3(), |it| it.at(time).truncate());
            let given = turn.as_quat().as_dquat().normalize();
            let turn = of("rotation").map_or(given, |it| DQuat::from_vec4(it.at(time)).normalize());
            let given = DVec3::splat(f64::from(*scale as f32));
            let scale = of("scale").map_or(given, |it| it.at(time).truncate());
            world *= DAffine3::from_scale_rotation_translation(scale, turn, at);
            world
        };
        self.nodes.iter().enumerate().map(node).collect()
    }

    pub fn times(&self, random: &mut Random) -> Vec<f64> {
        let keys =
            self.curves.iter().flat_map(|curve| curve.times.iter().map(|time| f64::from(*time)));
        // A step jumps at a key, so its side must be certain.
        let keys = keys.flat_map(|time| [time - 1e-4, time + 1e-4]);
        let between = (0..40).map(|_| f64::from(random.within(-0.2..5.0)));
        keys.chain(between.collect::<Vec<_>>()).collect()
    }
}

impl File {
    /// A file of four nodes with linear keys, all at times of their own, and keys of the scales of
    /// the first three, that are near `scale`, as much uneven as `uneven` says.
    fn scaled(random: &mut Random, scale: core::ops::Range<f32>, uneven: f32) -> Self {
        let mut file = Self::random(random, ["LINEAR"; 2]);
        for node in 0..3 {
            let mut curve = Curve::random(random, node, "scale", "LINEAR");
            for row in &mut curve.rows {
                let even = random.within(scale.clone());
                *row = [0.0; 4].map(|_| even * (1.0 + uneven * random.within(-1.0..1.0)));
            }
            file.curves.push(curve);
        }
        file
    }

    /// Asserts that joints are where this file has them, to a hundred thousandth of their size.
    fn assert_read(&self, document: &Document, times: &[f64], case: &str) {
        for &time in times {
            let (expected, evaluated) = (self.worlds(time), document.at(time).into_document());
            let pose = evaluated.skeleton().pose();
            let size = expected.iter().map(|world| world.translation.length()).fold(1.0, f64::max);
            for (node, expected) in expected.iter().enumerate().skip(1) {
                let joint = evaluated.skeleton().find(&format!("n{node}")).expect("a joint");
                let (is, was) = (pose.base(joint).as_dvec3(), expected.translation);
                let far = is.distance(was) / size;
                assert!(far < 1e-5, "{case}, n{node} at {time}: {is}, not {was}: {far:e}");
            }
        }
    }

    pub fn key_times(&self) -> Vec<f64> {
        self.curves.iter().flat_map(|it| &it.times).map(|time| f64::from(*time)).collect()
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
        file.assert_read(&document, &file.times(&mut random), &format!("case {case}"));
    }
}

#[test]
fn scales_that_are_rounded_leave_the_keys_of_joints_as_they_are() {
    let mut random = Random(392);
    for case in 0..60 {
        // Below 2·10⁻⁶, offsets do not depend on scales either; above, they have more keys.
        let noise = [3e-7, 1e-6, 1e-5, 4e-5][case % 4];
        let file = File::scaled(&mut random, 1.0 - noise..1.0 + noise, noise);
        let document = document(&file.text());
        let times = [file.key_times(), file.times(&mut random)].concat();
        file.assert_read(&document, &times, &format!("noise {noise}"));
        for curve in file.curves.iter().filter(|curve| curve.path == "rotation") {
            let joint = document.skeleton().find(&format!("n{}", curve.node)).expect("a joint");
            let knots = document.keys.track(Channel::Rotation(joint)).expect("keyed").knots();
            let times: Vec<f32> = knots.iter().map(|knot| knot.time as f32).collect();
            assert_eq!(times, curve.times);
            assert!(knots.iter().all(|knot| knot.interpolation == Interpolation::Slerp));
        }
    }
}

#[test]
fn scales_that_change_evenly_move_joints_and_leave_their_turns() {
    let mut random = Random(393);
    for case in 0..40 {
        let mut file = File::scaled(&mut random, 0.4..2.0, 0.0);
        // The offset of a joint is then linear from key to key: its node stays, and one node above
        // it scales.
        let scaling = case % 3;
        file.curves.retain(|it| match it.path {
            "scale" => it.node == scaling,
            "translation" => it.node == 0,
            _ => true,
        });
        let document = document(&file.text());
        let times = [file.key_times(), file.times(&mut random)].concat();
        file.assert_read(&document, &times, &format!("case {case}"));
    }
}

#[test]
fn joints_are_at_the_last_key_also_if_it_is_no_frame() {
    let mut random = Random(394);
    for case in 0..40 {
        let file = File::scaled(&mut random, 0.5..2.0, 0.6);
        let document = document(&file.text());
        file.assert_read(&document, &file.key_times(), &format!("case {case}"));
    }
}

#[test]
fn values_that_an_animation_gives_once_and_for_all_are_those_of_the_joints() {
    let mut random = Random(395);
    for case in 0..60 {
        let mut file = File::random(&mut random, ["LINEAR"; 2]);
        // A node above the joints has another place, turn and scale, and a joint another scale.
        for (node, path) in [(0, "translation"), (0, "rotation"), (0, "scale"), (2, "scale")] {
            let mut curve = Curve::random(&mut random, node, path, "LINEAR");
            let first = match path {
                "scale" => [random.within(0.4..2.0); 4],
                _ => curve.rows[0],
            };
            curve.rows.fill(first);
            file.curves.push(curve);
        }
        let document = document(&file.text());
        let times = [file.key_times(), file.times(&mut random)].concat();
        file.assert_read(&document, &times, &format!("case {case}"));
        let joints = document.skeleton().joints().len();
        assert_eq!(joints, 3, "the node above the joints does not move");
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
            let [was, is] = [&before, &after].map(|document| document.at(time).into_document());
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
        let (world, evaluated) = (file.worlds(start)[1], document.at(start).into_document());
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

/// A skeleton with keys of random curves, some with slopes of their own, at whole frames. `kinds`
/// has the curves of the angles and of the offsets.
fn keyed(random: &mut Random, kinds: [&[Interpolation]; 2]) -> Document {
    let mut document = example("human");
    document.rig.targets.clear();
    document.keys = Default::default();
    document.timeline = ik_arm::document::Timeline { start: 0.5, end: 4.5, frame_rate: 24.0 };
    let joints = document.skeleton().joints().len();
    for joint in (0..joints).map(JointId::new) {
        let unlimited =
            document.skeleton_mut().change(joint, |joint| joint.limits = JointLimits::NONE);
        unlimited.expect("limits may go");
        let offset = document.skeleton()[joint].offset;
        let channels = [Channel::Rotation(joint), Channel::Offset(joint)];
        for (channel, kinds) in channels.into_iter().zip(kinds) {
            if random.chance(0.4) {
                continue;
            }
            let mut frame = random.below(30);
            for _ in 0..2 + random.below(5) {
                let time = document.timeline.time(frame);
                let value = match channel {
                    Channel::Rotation(_) => random.vector(3.0),
                    _ => offset + random.vector(0.2 * offset.length().max(0.1)),
                };
                let slope = |random: &mut Random| random.vector(1.0);
                let slopes = random
                    .chance(0.2)
                    .then(|| Slopes { arriving: slope(random), leaving: slope(random) });
                let interpolation = kinds[random.below(kinds.len())];
                document.keys.insert_key(channel, Knot { time, value, interpolation, slopes });
                frame += 1 + random.below(12);
            }
        }
    }
    document
}

/// The curves of an exported file.
fn curves(glb: &Glb) -> Vec<Curve> {
    let animation = &glb.json["animations"][0];
    let channels = animation["channels"].as_array().into_iter().flatten();
    let curve = |channel: &Value| {
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        let kind = match sampler["interpolation"].as_str() {
            Some("CUBICSPLINE") => "CUBICSPLINE",
            Some("STEP") => "STEP",
            _ => "LINEAR",
        };
        let rows = glb.rows(&sampler["output"]).into_iter();
        let row = |row: Vec<f32>| std::array::from_fn(|at| row.get(at).copied().unwrap_or(0.0));
        Curve {
            node: index(&channel["target"]["node"]),
            path: if channel["target"]["path"] == "rotation" { "rotation" } else { "translation" },
            kind,
            times: glb.rows(&sampler["input"]).into_iter().map(|row| row[0]).collect(),
            rows: rows.map(row).collect(),
        }
    };
    channels.map(curve).collect()
}

const CURVES: [Interpolation; 4] =
    [Interpolation::Auto, Interpolation::Smooth, Interpolation::Linear, Interpolation::Slerp];

#[test]
fn curves_of_keys_are_cubic_splines_of_the_file_and_its_joints_are_where_the_documents_are() {
    let mut random = Random(41);
    for case in 0..12 {
        let before = keyed(&mut random, [&CURVES, &CURVES[..3]]);
        let (glb, skeleton) = (Glb::new(&glb(&before)), before.skeleton());
        let curves = curves(&glb);
        assert!(curves.iter().filter(|curve| curve.kind == "CUBICSPLINE").count() > 10);
        let parent =
            |node: usize| (0..glb.nodes().len()).find(|it| glb.children(*it).contains(&node));
        let between = (0..60).map(|_| f64::from(random.within(0.5..4.5)));
        for time in between.collect::<Vec<_>>() {
            let evaluated = before.at(time).into_document();
            let pose = evaluated.skeleton().pose();
            let world = |mut node: usize| {
                let mut world = DAffine3::IDENTITY;
                loop {
                    let of = |path| curves.iter().find(|it| it.node == node && it.path == path);
                    let (_, turn, at) = glb.local(node).to_scale_rotation_translation();
                    let at = of("translation").map_or(at.as_dvec3(), |it| it.at(time).truncate());
                    let turn =
                        of("rotation").map_or(turn.as_dquat(), |it| DQuat::from_vec4(it.at(time)));
                    world = DAffine3::from_rotation_translation(turn.normalize(), at) * world;
                    match parent(node) {
                        Some(above) => node = above,
                        None => break world,
                    }
                }
            };
            for joint in skeleton.ids() {
                let found = world(glb.node(&skeleton[joint].name));
                let was = pose.base(joint).as_dvec3() * f64::from(before.metres_per_unit());
                // Each joint above turns by at most 1e-4 too far, about 2 m away.
                let far = found.translation.distance(was);
                assert!(far < 6e-4, "case {case}, {} at {time}: {far:e}", skeleton[joint].name);
            }
        }
    }
}

#[test]
fn offsets_are_the_cubic_splines_of_the_file_exactly_and_angles_to_a_ten_thousandth() {
    let mut random = Random(43);
    for _ in 0..12 {
        let document = keyed(&mut random, [&CURVES[..2], &CURVES[..2]]);
        let glb = Glb::new(&glb(&document));
        let skeleton = document.skeleton();
        let metres = f64::from(document.metres_per_unit());
        for curve in curves(&glb) {
            let joint = skeleton.find(glb.name(curve.node)).expect("a joint");
            let bind = glb.local(curve.node).to_scale_rotation_translation();
            let channel = match curve.path {
                "rotation" => Channel::Rotation(joint),
                _ => Channel::Offset(joint),
            };
            // Rounding turns some joints without keys.
            let Some(track) = document.keys.track(channel) else { continue };
            assert_eq!(curve.kind, "CUBICSPLINE", "{channel:?}");
            let start = track.knots()[0].value;
            for _ in 0..40 {
                let time = f64::from(random.within(0.5..4.5));
                let value = document.keys.value(channel, time).expect("keyed").as_dvec3();
                if curve.path == "translation" {
                    // A rotation keeps lengths; the first row is the first key.
                    let moved = (curve.at(time) - curve.at(0.0)).truncate().length();
                    let expected = (value - start.as_dvec3()).length() * metres;
                    assert!((moved - expected).abs() < 2e-6, "{channel:?} at {time}");
                    continue;
                }
                // The angle of a rotation is the same in every frame.
                let found = DQuat::from_vec4(curve.at(time)).normalize();
                let turned = bind.1.as_dquat().normalize().inverse() * found;
                let angle = 2.0 * turned.xyz().length().atan2(turned.w.abs());
                let turn = DQuat::from_rotation_z(value.z)
                    * DQuat::from_rotation_y(value.y)
                    * DQuat::from_rotation_x(value.x);
                let expected = 2.0 * turn.xyz().length().atan2(turn.w.abs());
                assert!((angle - expected).abs() < 1e-4, "{channel:?} at {time}: {angle}");
            }
        }
    }
}

#[test]
fn the_names_of_curves_and_the_keys_return_from_the_programs_own_files() {
    let mut random = Random(47);
    let mut angles = 0;
    for case in 0..12 {
        let before = keyed(&mut random, [&CURVES, &CURVES[..3]]);
        let opened = io::read("x.glb", &glb(&before)[..], &io::OpenOptions::default());
        let after = opened.unwrap_or_else(|error| panic!("{error}")).document;
        assert_eq!(after.timeline.frame_rate, before.timeline.frame_rate);
        for (channel, track) in before.keys.tracks() {
            let name = &before.skeleton()[channel.joint().expect("a joint's")].name;
            let joint = after.skeleton().find(name).expect("a joint");
            let (is_angle, other) = match channel {
                Channel::Rotation(_) => (true, Channel::Rotation(joint)),
                _ => (false, Channel::Offset(joint)),
            };
            // Slerps and lines alone are those of glTF.
            let kinds = |knots: &[Knot<Vec3>]| -> Vec<_> {
                knots.iter().map(|knot| knot.interpolation).collect()
            };
            let (_, inner) = track.knots().split_last().expect("keys");
            let is_plain = inner.iter().all(|it| !it.interpolation.is_cubic())
                && inner.windows(2).all(|pair| pair[0].interpolation == pair[1].interpolation);
            if is_plain {
                continue;
            }
            let found = after.keys.track(other).unwrap_or_else(|| panic!("{case} {channel:?}"));
            assert_eq!(kinds(found.knots()), kinds(track.knots()), "case {case}, {channel:?}");
            for (is, was) in found.knots().iter().zip(track.knots()) {
                assert!((is.time - was.time).abs() < 1e-6);
                assert_eq!(is.slopes.is_some(), was.slopes.is_some());
                if is_angle {
                    assert_eq!((is.value, is.slopes), (was.value, was.slopes), "unwrapped");
                    angles += 1;
                }
            }
        }
    }
    assert!(angles > 300, "{angles}");
}

#[test]
fn keys_beside_a_curve_that_was_changed_since_are_not_taken() {
    let mut random = Random(53);
    let before = keyed(&mut random, [&CURVES[..1], &CURVES[..1]]);
    let mut changed = before.clone();
    for (channel, track) in before.keys.tracks() {
        let moved = track.knots().iter().map(|knot| Knot { value: knot.value + 0.1, ..*knot });
        moved.for_each(|knot| changed.keys.insert_key(channel, knot));
    }
    let [mut bytes, other] = [glb(&before), glb(&changed)];
    // The JSON with the keys of one file, the binary curves of the other.
    let length = |bytes: &[u8]| u32::from_le_bytes(bytes[12..16].try_into().expect("4")) as usize;
    let (own, theirs) = (20 + length(&bytes), 20 + length(&other));
    bytes.truncate(own);
    bytes.extend(&other[theirs..]);
    let total = (bytes.len() as u32).to_le_bytes();
    bytes[8..12].copy_from_slice(&total);
    let Ok(opened) = io::read("x.glb", &bytes[..], &io::OpenOptions::default()) else {
        panic!("the file opens")
    };
    let mut kept = 0;
    for (_, track) in opened.document.keys.tracks() {
        kept += track.knots().iter().filter(|it| it.interpolation == Interpolation::Auto).count();
    }
    assert_eq!(kept, 0);
}
