//! URDF: robots are where a reader of the tests has them, at all angles, and targets pose them.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DAffine3, DMat3, DVec3, Vec3};
use ik_arm::document::Document;
use ik_arm::io::{self, OpenOptions, Opened, Progress, Upwards};
use ik_arm::kinematics::skeleton::{JointId, RotationAxis, Skeleton};
use ik_arm::kinematics::skin::Skinning;
use pollster::block_on;
use tempfile::TempDir;

use crate::common::Random;
use crate::common::damage::{message, mutations, wrong_lines};

const ROBOTS: [&str; 6] = ["ur5", "puma560", "panda", "allegro_hand", "a1", "gripper"];

fn path_of(robot: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/data/robots/{robot}.urdf"))
}

fn text_of(robot: &str) -> String {
    fs::read_to_string(path_of(robot)).expect("a robot of the tests")
}

fn open(text: &str) -> Opened {
    io::parse("test.urdf", text, &OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn refusal(text: &str) -> String {
    message(io::parse("test.urdf", text, &OpenOptions::default()).expect_err("it is refused"))
}

/// A robot as the tests read it: by attributes alone, in f64.
struct Twin {
    links: Vec<String>,
    joints: Vec<TwinJoint>,
    /// Link, transform to the link and points of bodies that vertices must be at.
    points: Vec<(String, DVec3)>,
}

struct TwinJoint {
    name: String,
    turns: bool,
    parent: String,
    child: String,
    origin: DAffine3,
    axis: DVec3,
    limits: [f64; 2],
}

/// The value of an attribute of an element like `<tag … name="value" …>`.
fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let start = element.find(&format!(" {name}=\""))? + name.len() + 3;
    element[start..].split('"').next()
}

fn vector(text: &str) -> DVec3 {
    let numbers: Vec<f64> = text.split(' ').map(|it| it.parse().expect("a number")).collect();
    DVec3::from_slice(&numbers)
}

fn origin_of(block: &str) -> DAffine3 {
    let element =
        block.split("<origin").nth(1).map_or("", |rest| rest.split("/>").next().expect(""));
    let turn = attribute(element, "rpy").map_or(DVec3::ZERO, vector);
    let rotation = DMat3::from_rotation_z(turn.z)
        * DMat3::from_rotation_y(turn.y)
        * DMat3::from_rotation_x(turn.x);
    let place = attribute(element, "xyz").map_or(DVec3::ZERO, vector);
    DAffine3::from_mat3_translation(rotation, place)
}

impl Twin {
    fn new(text: &str) -> Self {
        let blocks =
            |tag: &str| -> Vec<&str> { text.split(&format!("  <{tag} name=")).skip(1).collect() };
        let name = |block: &str| block[1..].split('"').next().expect("a name").to_owned();
        let mut points = Vec::new();
        for block in blocks("link") {
            let block = block.split("</link>").next().expect("a link");
            for visual in block.split("<visual>").skip(1) {
                let place = origin_of(visual);
                let number = |name: &str| attribute(visual, name).and_then(|it| it.parse().ok());
                let of_body: Vec<DVec3> = if visual.contains("<box") {
                    let half = 0.5 * vector(attribute(visual, "size").expect("a size"));
                    vec![half, -half, DVec3::new(half.x, -half.y, half.z)]
                } else if visual.contains("<cylinder") {
                    let (radius, length): (f64, f64) =
                        (number("radius").expect("a radius"), number("length").expect("a length"));
                    vec![
                        DVec3::new(radius, 0.0, 0.5 * length),
                        DVec3::new(0.0, radius, -0.5 * length),
                    ]
                } else {
                    let radius: f64 = number("radius").expect("a radius");
                    vec![radius * DVec3::Z, -radius * DVec3::Z, radius * DVec3::X]
                };
                let of_link = |point: DVec3| (name(block), place.transform_point3(point));
                points.extend(of_body.into_iter().map(of_link));
            }
        }
        let joint = |block: &str| {
            let block = block.split("</joint>").next().expect("a joint");
            let element = |tag: &str| {
                let rest = block.split(&format!("<{tag}")).nth(1);
                rest.map(|rest| rest.split("/>").next().expect("closed"))
            };
            let link =
                |tag| attribute(element(tag).expect(tag), "link").expect("a link").to_owned();
            let kind = attribute(block.split('>').next().expect("a tag"), "type").expect("a type");
            let limit = |name| {
                let limit = element("limit").and_then(|it| attribute(it, name)?.parse().ok());
                limit.unwrap_or_default()
            };
            TwinJoint {
                name: name(block),
                turns: kind == "revolute" && element("mimic").is_none(),
                parent: link("parent"),
                child: link("child"),
                origin: origin_of(block),
                axis: element("axis").and_then(|it| attribute(it, "xyz")).map_or(DVec3::X, vector),
                limits: [limit("lower"), limit("upper")],
            }
        };
        Self {
            links: blocks("link").into_iter().map(name).collect(),
            joints: blocks("joint").into_iter().map(joint).collect(),
            points,
        }
    }

    /// Random angles of the joints that turn, within a fraction of their limits around the middle.
    fn angles(&self, random: &mut Random, fraction: f32) -> HashMap<String, f64> {
        let turning = self.joints.iter().filter(|joint| joint.turns);
        turning
            .map(|joint| {
                let [lower, upper] = joint.limits;
                let by = 0.5 * (upper - lower) * f64::from(random.within(-fraction..fraction));
                (joint.name.clone(), 0.5 * (lower + upper) + by)
            })
            .collect()
    }

    /// The frames of all links in the world, in which y points up.
    fn frames(&self, angles: &HashMap<String, f64>) -> HashMap<&str, DAffine3> {
        let is_child = |link: &&String| self.joints.iter().any(|joint| joint.child == **link);
        let up = DAffine3::from_rotation_x(-FRAC_PI_2);
        let roots = self.links.iter().filter(|link| !is_child(link));
        let mut frames: HashMap<&str, DAffine3> = roots.map(|root| (root.as_str(), up)).collect();
        while frames.len() < self.links.len() {
            for joint in &self.joints {
                if let Some(parent) = frames.get(joint.parent.as_str()) {
                    let angle = angles.get(&joint.name).copied().unwrap_or_default();
                    let turn = DAffine3::from_axis_angle(joint.axis, angle);
                    let frame = *parent * joint.origin * turn;
                    frames.insert(&joint.child, frame);
                }
            }
        }
        frames
    }
}

/// Turns the joints of a skeleton.
fn turn(document: &mut Document, angles: &HashMap<String, f64>) {
    for (name, angle) in angles {
        let joint = document.skeleton().find(name).expect(name);
        let rotation = Vec3::new(0.0, 0.0, *angle as f32);
        let turned = document.rig.skeleton_mut().set_rotation(joint, rotation);
        turned.expect("within the limits");
    }
}

#[test]
fn links_are_where_a_reader_of_the_tests_has_them_at_all_angles() {
    let mut random = Random(1);
    for robot in ROBOTS {
        let text = text_of(robot);
        let twin = Twin::new(&text);
        let Opened { mut document, order, .. } = open(&text);
        let size = document.rig.reach();
        assert_eq!(document.skeleton().joints().len(), twin.links.len(), "{robot}");
        for _ in 0..40 {
            let angles = twin.angles(&mut random, 1.0);
            turn(&mut document, &angles);
            let pose = document.skeleton().pose();
            let frames = twin.frames(&angles);
            for (link, joint) in twin.links.iter().zip(&order) {
                let expected = frames[link.as_str()].translation.as_vec3();
                let missed = pose.base(*joint).distance(expected);
                assert!(missed < 1e-5 * size, "{robot}, {link}: {missed} off");
            }
        }
    }
}

#[test]
fn bodies_are_where_a_reader_of_the_tests_has_them_at_all_angles() {
    let mut random = Random(2);
    for robot in ROBOTS {
        let text = text_of(robot);
        let twin = Twin::new(&text);
        let mut document = open(&text).document;
        let size = document.rig.reach();
        for _ in 0..3 {
            let angles = twin.angles(&mut random, 1.0);
            turn(&mut document, &angles);
            let obj = io::to_obj(&document, 0.0, Some(Skinning::Linear)).expect("a mesh");
            let obj = String::from_utf8(obj.bytes).expect("UTF-8");
            let vertices: Vec<Vec3> = obj
                .lines()
                .filter_map(|line| line.strip_prefix("v "))
                .map(|line| vector(line).as_vec3())
                .collect();
            let frames = twin.frames(&angles);
            for (link, point) in &twin.points {
                let expected = frames[link.as_str()].transform_point3(*point).as_vec3();
                let nearest = vertices.iter().map(|vertex| vertex.distance(expected));
                let nearest = nearest.fold(f32::MAX, f32::min);
                assert!(nearest < 1e-4 * size, "{robot}, {link}: {nearest} from {point}");
            }
        }
    }
}

#[test]
fn joints_have_the_limits_of_the_file_and_nothing_else_turns() {
    for robot in ROBOTS {
        let text = text_of(robot);
        let twin = Twin::new(&text);
        let document = open(&text).document;
        let skeleton = document.skeleton();
        let turning: Vec<&TwinJoint> = twin.joints.iter().filter(|joint| joint.turns).collect();
        for joint in &turning {
            let [lower, upper] = joint.limits.map(|limit| limit as f32);
            let found = &skeleton[skeleton.find(&joint.name).expect("a joint")];
            let range = found.limits.range(RotationAxis::Z).expect("limits");
            assert_eq!((range.min, range.max), (lower, upper), "{robot}, {}", joint.name);
            let fixed = [RotationAxis::X, RotationAxis::Y].map(|axis| found.limits.is_fixed(axis));
            assert_eq!((fixed, found.locked), ([true; 2], false), "{robot}, {}", joint.name);
        }
        let unlocked = skeleton.joints().iter().filter(|joint| !joint.locked).count();
        assert_eq!(unlocked, turning.len(), "{robot}");
    }
}

/// The last links of each robot, by which it is posed.
fn tips(robot: &str) -> &'static [&'static str] {
    match robot {
        "ur5" => &["tool0"],
        "puma560" => &["tip"],
        "panda" => &["hand"],
        "allegro_hand" => &["index_tip", "middle_tip", "ring_tip", "thumb_tip"],
        "a1" => &["FL_foot", "FR_foot", "RL_foot", "RR_foot"],
        _ => &["finger_joint"],
    }
}

#[test]
fn targets_pose_every_robot_within_its_limits() {
    let mut random = Random(3);
    for robot in ROBOTS {
        let text = text_of(robot);
        let twin = Twin::new(&text);
        let start = open(&text).document;
        let size = start.rig.reach();
        let (mut reached, mut all) = (0, 0);
        for _ in 0..20 {
            let mut goal = start.clone();
            turn(&mut goal, &twin.angles(&mut random, 0.8));
            let mut document = start.clone();
            let ends = tips(robot).iter().map(|tip| goal.skeleton().find(tip).expect(tip));
            let ends: Vec<JointId> = ends.collect();
            for end in &ends {
                let target = document.rig.new_target(*end, goal.skeleton());
                document.rig.targets.push(target.expect("a new target"));
            }
            let evaluated = document.rig.evaluate(0.0);
            let errors = evaluated.targets.iter().map(|report| report.error);
            let worst = errors.fold(0.0, f32::max);
            all += 1;
            reached += usize::from(worst < 1e-3 * size);
            for (_, joint) in evaluated.solved.iter() {
                assert!(joint.limits.contains(joint.rotation), "{robot}, {}", joint.name);
            }
        }
        println!("{robot}: {reached} of {all}");
        assert!(reached >= 18, "{robot}: {reached} of {all}");
    }
}

#[test]
fn the_target_of_a_last_link_without_bodies_is_at_its_frame() {
    for (robot, link) in [("ur5", "tool0"), ("puma560", "tip"), ("allegro_hand", "index_tip")] {
        let document = open(&text_of(robot)).document;
        let skeleton = document.skeleton();
        let joint = skeleton.find(link).expect(link);
        assert_eq!(skeleton.tip(joint), skeleton.base(joint), "{robot}");
    }
}

fn small(joints: &str) -> String {
    format!("<robot name='r'><link name='a'/><link name='b'/><link name='c'/>{joints}</robot>")
}

fn hinge(name: &str, parent: &str, child: &str, more: &str) -> String {
    format!(
        "<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>\
         <origin xyz='0 0 1'/><limit lower='-1' upper='1'/>{more}</joint>"
    )
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_name() {
    let both = hinge("one", "a", "b", "") + &hinge("two", "b", "c", "");
    open(&small(&both));
    for (joints, told) in [
        (String::new(), "r: a robot must have a joint that turns"),
        (both.replace("revolute", "fixed"), "a robot must have a joint that turns"),
        (both.replace("revolute", "hinge"), "one: its type must be revolute, continuous"),
        (hinge("one", "a", "x", ""), "one: its child must be a link, got \"x\""),
        (
            hinge("one", "a", "b", "") + &hinge("two", "c", "b", ""),
            "must not be the child of \"one\"",
        ),
        (
            hinge("one", "b", "c", "") + &hinge("two", "c", "b", ""),
            "its child link must not be an ancestor of its parent link",
        ),
        (
            hinge("one", "a", "a", ""),
            "one: its child link must not be an ancestor of its parent link",
        ),
        (hinge("one", "a", "b", "<axis xyz='0 0 0'/>"), "one: its axis must not be zero"),
        (hinge("one", "a", "b", "<axis xyz='0 1'/>"), "xyz of axis must be 3 numbers within ±1e12"),
        (both.replace("'-1'", "'x'"), "lower of limit must be a number within ±1e12, got \"x\""),
        (both.replace("0 0 1", "0 0 1e13"), "xyz of origin must be 3 numbers within ±1e12"),
        (both.replace("name='two'", ""), "a joint must have a name"),
        ("<link name='a'/>".to_owned() + &both, "a: names of links must be unique"),
        (
            "<link name='d'><visual><geometry><sphere radius='-1'/></geometry></visual></link>"
                .to_owned()
                + &both,
            "d: the radius of a sphere must be 0 or more, got -1",
        ),
    ] {
        let error = refusal(&small(&joints));
        assert!(error.contains(told), "{error}\nwithout {told}");
    }
    for (text, told) in [
        ("<robot name='r'>\n <link\n</robot>", "line 2, column 2: link: not XML"),
        ("<robot name='r'>\n</robit>", "line 2, column 1: not XML"),
        ("<robot name='r'>\n <link name='a'/>", "not XML: the file ends within robot"),
    ] {
        assert!(refusal(text).contains(told), "{}", refusal(text));
    }
    let xacro = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n\
                 <xacro:macro name='m'/></robot>";
    assert!(refusal(xacro).contains("line 2, column 1: must be URDF, got xacro"));
    let error = io::parse("t", &small(&both), &OpenOptions::of_skeleton("x")).expect_err("none");
    assert!(message(error).contains("\"r\""));
}

#[test]
fn what_is_left_out_is_told() {
    let joints = hinge("one", "a", "b", "")
        + &hinge("two", "b", "c", "<mimic joint='one'/>")
        + "<link name='d'><visual><geometry><mesh filename='package://r/d.dae'/></geometry>\
           </visual></link><joint name='slide' type='prismatic'><parent link='c'/>\
           <child link='d'/></joint>";
    let told: Vec<String> =
        open(&small(&joints)).warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        told,
        [
            "prismatic, planar, floating and mimic joints are locked: two (revolute, mimic), slide (prismatic)",
            "meshes and textures are not read, only boxes, cylinders and spheres are shown: \
             \"package://r/d.dae\"",
        ]
    );
    let swapped = hinge("one", "a", "b", "").replace("'1'", "'-2'") + &hinge("two", "b", "c", "");
    let opened = open(&small(&swapped));
    assert!(opened.warnings[0].to_string().contains("turn without limits: one (-1 to -2)"));
    let skeleton = opened.document.skeleton();
    let one = &skeleton[skeleton.find("one").expect("a joint")];
    assert_eq!(one.limits.range(RotationAxis::Z), None);
}

#[test]
fn z_is_up_unless_the_options_say_otherwise() {
    let text = text_of("ur5");
    let top = |up: Option<Upwards>| {
        let options = OpenOptions { up, ..OpenOptions::default() };
        let opened = io::parse("t", &text, &options).expect("it opens");
        let skeleton = opened.document.skeleton();
        skeleton.base(skeleton.find("shoulder_pan_joint").expect("a joint"))
    };
    let place = Vec3::new(0.0, 0.0, 0.089_159);
    assert!(top(Some(Upwards::Y)).distance(place) < 1e-6);
    for up in [None, Some(Upwards::Z), Some(Upwards::Auto)] {
        assert!(top(up).distance(Vec3::new(0.0, 0.089_159, 0.0)) < 1e-6, "{up:?}");
    }
}

#[test]
fn a_document_takes_its_bodies_from_the_file_again() {
    let folder = TempDir::new().expect("a folder");
    let robot = folder.path().join("panda.urdf");
    fs::copy(path_of("panda"), &robot).expect("copied");
    let document = io::open(&robot, &OpenOptions::default()).expect("it opens").document;
    let saved = folder.path().join("panda.json");
    io::save(&document, &saved).expect("saved");
    let again = io::open(&saved, &OpenOptions::default()).expect("it opens");
    assert!(again.warnings.is_empty(), "{:?}", again.warnings);
    assert_eq!(again.document.rig, document.rig);
    assert!(again.document.rig.skin.is_some());
}

#[test]
fn exported_robots_are_where_they_were() {
    for robot in ROBOTS {
        let mut document = open(&text_of(robot)).document;
        turn(&mut document, &Twin::new(&text_of(robot)).angles(&mut Random(4), 1.0));
        let glb = block_on(io::glb(&document, None, &Progress::default())).expect("exported");
        let again = io::read("r.glb", &glb[..], &OpenOptions::default()).expect("it opens");
        let [before, after] = [&document, &again.document].map(|it| it.skeleton().pose());
        let joints = |skeleton: &Skeleton| -> Vec<String> {
            skeleton.joints().iter().map(|joint| joint.name.clone()).collect()
        };
        for (joint, name) in document.skeleton().ids().zip(joints(document.skeleton())) {
            let same = again.document.skeleton().find(&name).expect("a joint of this name");
            let missed = before.base(joint).distance(after.base(same));
            assert!(missed < 1e-5 * document.rig.reach(), "{robot}, {name}: {missed}");
        }
    }
}

#[test]
fn names_of_links_and_joints_may_be_the_same() {
    let joints = hinge("a", "a", "b", "") + &hinge("b", "b", "c", "");
    let document = open(&small(&joints)).document;
    let names = document.skeleton().joints().iter().map(|joint| joint.name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["a", "a_2", "b"]);
}

#[test]
fn damaged_files_open_or_are_refused() {
    let mut random = Random(5);
    let whole = text_of("panda");
    let words = ["<link name='x'/>", "</joint>", "/>", "1e400", "-", "NaN", "&amp;", "<!--", "é"];
    let wrong_words = wrong_lines(&whole, &words, &mut random, 300);
    let mut opened = 0;
    for bytes in mutations(&whole, &mut random, 600).into_iter().chain(wrong_words) {
        match io::read("damaged.urdf", &bytes[..], &OpenOptions::default()) {
            Ok(read) => {
                opened += 1;
                let again = io::to_json(&read.document).expect("written");
                io::parse("again", &again, &OpenOptions::default())
                    .expect("every document can be saved and opened");
            }
            Err(error) => drop(message(error)),
        }
    }
    assert!((50..800).contains(&opened), "{opened}");
}

#[test]
fn deep_and_endless_files_are_refused() {
    let deep = format!("<robot name='r'>{}", "<a>".repeat(300_000));
    assert!(refusal(&deep).contains("XML"), "without deep recursion");
    let links: String = (0..20_000).map(|it| format!("<link name='l{it}'/>")).collect();
    let many = small(&(hinge("one", "a", "b", "") + &links));
    assert!(refusal(&many).contains("must have at most 10000 links, got 20003"));
    let entities = "<!DOCTYPE robot [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><robot>&b;</robot>";
    drop(refusal(entities));
}
