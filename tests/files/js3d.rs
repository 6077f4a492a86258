//! Scotty3D's scenes: their bones are where Scotty3D's formulas put them.

use std::fmt::Write as _;

use glam::{DMat4, DQuat, DVec3, DVec4, Vec3};
use ik_arm::document::Timeline;
use ik_arm::io::{self, Opened};
use ik_arm::kinematics::skeleton::JointId;

use crate::common::Random;
use crate::common::damage::{message, mutations};

fn open(text: &str) -> Opened {
    io::parse("test.js3d", text, &io::OpenOptions::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str) -> String {
    message(io::parse("test.js3d", text, &io::OpenOptions::default()).expect_err("it is refused"))
}

/// A scene with one skeleton; the bones begin on line 2.
fn skeleton(fields: &str) -> String {
    format!("{{\"scene\":{{\"skinned_meshes\":{{\"X\":{{\"skeleton\":{{\n{fields}}}}}}}}}}}")
}

fn bones(bones: &str) -> String {
    skeleton(&format!("\"bones\":[{bones}]"))
}

// Contents of a scene

#[test]
fn the_smallest_scene_opens() {
    let text = r#"{"scene":{"skinned_meshes":{"X":{"skeleton":{"bones":[{"extent":[0,1,0]}]}}}}}"#;
    let Opened { document, warnings, order, skeletons, .. } = open(text);
    let skeleton = document.skeleton();
    let joint = &skeleton.joints()[0];
    assert_eq!((joint.name.as_str(), joint.parent, joint.locked), ("bone_0", None, false));
    assert_eq!((joint.offset, joint.axis, joint.rotation), (Vec3::ZERO, Vec3::Y, Vec3::ZERO));
    assert!(joint.radius > 0.0);
    assert_eq!((warnings, order, skeletons), (vec![], vec![JointId::new(0)], vec!["X".to_owned()]));
}

#[test]
fn the_camera_shows_all_of_a_small_skeleton_and_of_a_large_one() {
    for size in ["0.001", "1000"] {
        let Opened { document, .. } = open(&bones(&format!("{{\"extent\":[0,{size},0]}}")));
        let size: f32 = size.parse().expect("a number");
        assert!(document.camera.target.distance(Vec3::Y * size / 2.0) < 1e-3 * size);
        assert!((size..10.0 * size).contains(&document.camera.distance), "{:?}", document.camera);
    }
}

#[test]
fn everything_but_skeletons_is_counted_in_a_warning() {
    let mesh = "AAECAwQF".repeat(100_000);
    let text = format!(
        r#"{{"animator":{{"FORMAT":"js3d-v1","splines":{{"a":{{"c":1,"d":2}},"b":{{}}}}}},
        "scene":{{"FORMAT":"js3d-v1","cameras":{{"c":1}},
        "skinned_meshes":{{"X":{{"mesh":{{"positions":"vec3:{mesh}"}},
        "skeleton":{{"bones":[{{"extent":[0,1,0],"colour":5}}]}}}},
        "Y":{{"mesh":{{"indices":[0]}}}},"Z":{{"mesh":{{}}}}}},
        "particles":{{"p":{{}},"q":{{}}}},"delta_lights":{{"d":1}},"env_lights":{{"e":[2]}},
        "textures":{{"t":null}}}}}}"#
    );
    let opened = open(&text);
    let said: Vec<_> = opened.warnings.iter().map(ToString::to_string).collect();
    let expected = [
        "line 1, column 43: animator.splines: not read: 2 animated channels",
        "line 2, column 17: scene: not read: 2 meshes, 2 particle systems, 1 camera, 2 lights, \
         1 texture",
    ];
    assert_eq!(
        (said, opened.skeletons),
        (expected.map(str::to_owned).to_vec(), vec!["X".to_owned()])
    );
}

/// The value at `time` of a Catmull–Rom spline through the knots, from its cubic polynomial in f64.
fn catmull_rom(knots: &[(f64, DVec3)], time: f64) -> DVec3 {
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let mirrored =
        |end: (f64, DVec3), next: (f64, DVec3)| (2.0 * end.0 - next.0, 2.0 * end.1 - next.1);
    let (before, after) = (mirrored(first, knots[1]), mirrored(last, knots[knots.len() - 2]));
    let all: Vec<_> = [before].into_iter().chain(knots.iter().copied()).chain([after]).collect();
    if time <= first.0 || time >= last.0 {
        return if time <= first.0 { first.1 } else { last.1 };
    }
    let at = (1..all.len() - 1).rev().find(|at| all[*at].0 <= time).expect("in between");
    let [(t0, p0), (t1, p1), (t2, p2), (t3, p3)] = [all[at - 1], all[at], all[at + 1], all[at + 2]];
    let (m1, m2) = ((p2 - p0) / (t2 - t0), (p3 - p1) / (t3 - t1));
    let (h, s) = (t2 - t1, (time - t1) / (t2 - t1));
    let (a, b) = (2.0 * (p1 - p2) + h * (m1 + m2), 3.0 * (p2 - p1) - h * (2.0 * m1 + m2));
    ((a * s + b) * s + h * m1) * s + p1
}

#[test]
fn the_splines_of_a_skeleton_become_keys_with_the_same_curves() {
    let mut random = Random(81);
    for _ in 0..30 {
        let frames = [0.0, 7.0, 9.5, 24.0];
        let mut knots = |size: f32| -> Vec<(f64, DVec3)> {
            frames.iter().map(|frame| (*frame, random.vector(size).as_dvec3())).collect()
        };
        let (pose, base, target) = (knots(200.0), knots(2.0), knots(3.0));
        let list = |knots: &[(f64, DVec3)]| {
            let values = knots.iter().map(|(time, v)| format!("{time},[{},{},{}]", v.x, v.y, v.z));
            values.collect::<Vec<_>>().join(",")
        };
        let text = format!(
            r#"{{"scene":{{"skinned_meshes":{{"X":{{"skeleton":{{"base":[1,2,3],"bones":[
            {{"extent":[0,1,0],"channel_id":7}},{{"extent":[0,2,0],"parent":0,"channel_id":9}}],
            "handles":[{{"bone":1,"target":[0,0,0],"channel_id":4}}]}}}}}}}},
            "animator":{{"FORMAT":"js3d-v1","splines":{{
            "X":{{"base_offset":{{"type":"Vec3","knots":[{}]}},
            "bone.9.pose":{{"type":"Vec3","knots":[{}]}},
            "bone.8.pose":{{"type":"Vec3","knots":[0,[1,2,3]]}},
            "handle.4.target":{{"type":"Vec3","knots":[{}]}},
            "handle.4.enabled":{{"type":"bool","knots":[0,false,9.5,true]}}}},
            "camera":{{"vertical_fov":{{"type":"float","knots":[0,60]}}}}}}}}}}"#,
            list(&base),
            list(&pose),
            list(&target)
        );
        let opened = open(&text);
        let said: Vec<_> = opened.warnings.iter().map(|remark| remark.reason.as_str()).collect();
        assert_eq!(said, ["not read: 2 animated channels"]);
        let document = &opened.document;
        assert_eq!(document.timeline, Timeline { start: 0.0, end: 0.8, frame_rate: 30.0 });
        for step in -2..=28 {
            let frame = f64::from(step) * 0.97;
            let evaluated = document.at(frame / 30.0).into_document();
            let joints = evaluated.skeleton().joints();
            let near = |found: Vec3, expected: DVec3, size: f64| {
                assert!(
                    found.as_dvec3().distance(expected) < 1e-5 * size,
                    "frame {frame}: {found}"
                );
            };
            let angles = catmull_rom(&pose, frame) * std::f64::consts::PI / 180.0;
            near(joints[1].rotation, angles, 5.0);
            near(joints[0].offset, DVec3::new(1.0, 2.0, 3.0) + catmull_rom(&base, frame), 5.0);
            let target_now = evaluated.rig.targets[0];
            near(target_now.home, catmull_rom(&target, frame), 5.0);
            assert_eq!(target_now.enabled, frame >= 9.5);
        }
    }
}

#[test]
fn knots_that_are_no_times_and_values_are_left_out() {
    let alone = bones(r#"{"extent":[0,1,0]}"#);
    for knots in ["3", "[0]", "[0,1]", "[\"a\",[1,2,3]]", "[0,[1,2]]", "[1e20,[1,2,3]]"] {
        let spline = format!(
            r#"{{"animator":{{"frame_rate":24,"splines":{{"X":{{"bone.0.pose":{{"knots":{knots}}}}}}}}},"#
        );
        let opened = open(&alone.replacen('{', &spline, 1));
        assert_eq!(opened.warnings.len(), 1, "{knots}: {:?}", opened.warnings);
        assert!(opened.document.keys.is_empty());
    }
}

#[test]
fn contents_that_are_not_read_may_be_of_any_kind() {
    for value in ["null", "true", "-1", "2", "0.5", "\"text\"", "[]", "{}"] {
        let text = format!(
            "{{\"animator\":{{\"splines\":{value}}},\"scene\":{{\"meshes\":{value},\"cameras\":{value},\
             \"skinned_meshes\":{{\"X\":{{\"mesh\":{value},\"skeleton\":{{\"bones\":[]}}}}}}}}}}"
        );
        assert_eq!(open(&text).warnings, [], "{value}");
    }
    let alone = bones(r#"{"extent":[0,1,0]}"#);
    let without = alone.replacen('{', "{\"animator\":null,", 1);
    assert_eq!((open(&alone).warnings, open(&without).warnings), (vec![], vec![]));
}

#[test]
fn of_several_skeletons_the_first_in_the_file_opens_or_the_one_that_is_named() {
    let one = |name: &str, length: u32| {
        format!(r#""{name}":{{"skeleton":{{"bones":[{{"extent":[0,{length},0]}}]}}}}"#)
    };
    let text =
        format!(r#"{{"scene":{{"skinned_meshes":{{{},{}}}}}}}"#, one("zebra", 1), one("ant", 2));
    let length = |opened: Opened| opened.document.skeleton().joints()[0].axis.y;
    assert_eq!(open(&text).skeletons, ["zebra", "ant"]);
    assert_eq!(length(open(&text)), 1.0);
    let named = |name| io::parse("x.js3d", &text, &io::OpenOptions::of_skeleton(name));
    assert_eq!(length(named("ant").expect("there")), 2.0);
    let remarks = open(&text).warnings;
    assert_eq!(
        remarks.iter().map(|it| it.reason.as_str()).collect::<Vec<_>>(),
        ["the skeleton \"zebra\" is read, one of 2: \"zebra\", \"ant\""]
    );
    assert_eq!(named("ant").expect("there").warnings, []);
    let error = named("Ant").expect_err("not there").to_string();
    assert_eq!(error, "x.js3d has no skeleton called \"Ant\"; it has \"zebra\", \"ant\"");
}

#[test]
fn radius_and_pose_are_imported() {
    let opened = open(&bones(r#"{"extent":[0,1,0],"radius":0.25,"pose":[90,-180,720]}"#));
    let joint = &opened.document.skeleton().joints()[0];
    let degrees = joint.rotation.to_array().map(|angle| f64::from(angle).to_degrees() as f32);
    assert_eq!((joint.radius, degrees), (0.25, [90.0, -180.0, 720.0]));
}

#[test]
fn parents_are_sorted_before_their_children() {
    let opened = open(&bones(
        r#"{"extent":[1,0,0],"parent":2},{"extent":[0,1,0],"parent":4294967295},
           {"extent":[0,0,1],"parent":1},{"extent":[0,0,2],"parent":0}"#,
    ));
    let joints = opened.document.skeleton().joints();
    let name = |index: usize| joints[opened.order[index].index()].name.as_str();
    assert_eq!([0, 1, 2, 3].map(name), ["bone_0", "bone_1", "bone_2", "bone_3"]);
    let parent = |index: usize| joints[opened.order[index].index()].parent;
    let [a, b, c, _] = [0, 1, 2, 3].map(|index| opened.order[index]);
    assert_eq!([0, 1, 2, 3].map(parent), [Some(c), None, Some(b), Some(a)]);
}

// Handles

#[test]
fn a_handle_becomes_a_target_in_world_space() {
    let text = r#"{"scene":{
        "skinned_meshes":{"X":{"skeleton":{"bones":[{"extent":[0,1,0]},{"extent":[0,1,0],"parent":0}],
            "handles":[{"bone":1,"target":[1,2,3],"enabled":false},{"bone":0,"target":[0,0,0]}]}}},
        "transforms":{"T":{"translation":[10,20,30],"scale":[-2,1,1]}},
        "instances":{"skinned_meshes":{"I":{"mesh":"X","transform":"T"}}}}}"#;
    let targets = open(text).document.rig.targets;
    let at = |target: usize| {
        (targets[target].joint.index(), targets[target].home, targets[target].enabled)
    };
    assert_eq!(targets.len(), 2);
    assert_eq!(at(0), (1, Vec3::new(8.0, 22.0, 33.0), false));
    assert_eq!(at(1), (0, Vec3::new(10.0, 20.0, 30.0), true));
}

#[test]
fn of_several_handles_on_a_bone_the_first_enabled_one_counts() {
    let handle = |x: u32, enabled: bool| {
        format!("{{\"bone\":0,\"target\":[{x},0,0],\"enabled\":{enabled}}}")
    };
    for (enabled, counts) in [
        ([false, false, false], 0),
        ([false, true, true], 1),
        ([true, false, true], 0),
        ([false, false, true], 2),
    ] {
        let handles: Vec<_> = (0..).zip(enabled).map(|(x, enabled)| handle(x, enabled)).collect();
        let fields =
            format!("\"bones\":[{{\"extent\":[0,1,0]}}],\n\"handles\":[{}]", handles.join(","));
        let opened = open(&skeleton(&fields));
        let targets = &opened.document.rig.targets;
        assert_eq!((targets.len(), targets[0].home.x), (1, counts as f32), "{enabled:?}");
        assert_eq!(opened.warnings.len(), 2);
        for warning in opened.warnings {
            assert!(warning.field.starts_with("scene.skinned_meshes.X.skeleton.handles["));
            assert!(!warning.field.ends_with(&format!("[{counts}]")), "{enabled:?} {warning}");
            assert_eq!(warning.line, 3);
        }
    }
}

// Bone positions by an independent implementation

/// A bone as the file has it.
struct Bone {
    extent: DVec3,
    roll: f64,
    parent: Option<usize>,
    pose: DVec3,
}

/// One of the steps from the skeleton to the world.
struct Step {
    translation: DVec3,
    rotation: DVec4,
    scale: DVec3,
}

struct Scene {
    base: DVec3,
    base_offset: DVec3,
    bones: Vec<Bone>,
    /// From the instance's own outwards.
    steps: Vec<Step>,
}

impl Scene {
    fn random(random: &mut Random) -> Self {
        let point = |random: &mut Random, size| random.vector(size).as_dvec3();
        let count = 1 + random.below(12);
        let mut bones: Vec<_> = (0..count)
            .map(|index| Bone {
                extent: match random.below(8) {
                    0 => DVec3::ZERO,
                    1 => DVec3::X * f64::from(random.within(-1.0..1.0)),
                    2 => DVec3::Y * f64::from(random.within(-1.0..1.0)),
                    _ => point(random, 1.0),
                },
                roll: f64::from(random.within(-400.0..400.0)),
                parent: (index > 0 && random.below(5) > 0).then(|| random.below(index)),
                pose: point(random, 360.0),
            })
            .collect();
        shuffle(&mut bones, random);
        let steps = (0..random.below(4)).map(|_| {
            let turn = [(); 4].map(|()| f64::from(random.within(-1.0..1.0)));
            let scale = point(random, 1.5);
            Step {
                translation: point(random, 3.0),
                rotation: DVec4::from_array(turn).normalize(),
                scale: scale + 0.5 * DVec3::from_array(scale.to_array().map(f64::signum)),
            }
        });
        let steps = steps.collect();
        Self { base: point(random, 2.0), base_offset: point(random, 2.0), bones, steps }
    }

    fn text(&self) -> String {
        let mut text = String::from("{\"scene\":{\"transforms\":{");
        for (index, Step { translation, rotation, scale }) in self.steps.iter().enumerate() {
            let parent = if index + 1 < self.steps.len() {
                format!("\"T{}\"", index + 1)
            } else {
                "null".to_owned()
            };
            let comma = if index > 0 { "," } else { "" };
            let [t, r, s] =
                [row(&translation.to_array()), row(&rotation.to_array()), row(&scale.to_array())];
            let step =
                format!("\"parent\":{parent},\"translation\":{t},\"rotation\":{r},\"scale\":{s}");
            write!(text, "{comma}\"T{index}\":{{{step}}}").expect("written");
        }
        let bones: Vec<_> = self.bones.iter().map(Bone::text).collect();
        let (base, offset) = (row(&self.base.to_array()), row(&self.base_offset.to_array()));
        let skeleton =
            format!("\"base\":{base},\"base_offset\":{offset},\"bones\":[{}]", bones.join(","));
        let transform = if self.steps.is_empty() { "" } else { ",\"transform\":\"T0\"" };
        let instance = format!("\"mesh\":\"X\"{transform}");
        write!(
            text,
            "}},\"instances\":{{\"skinned_meshes\":{{\"other\":{{\"mesh\":\"Y\"}},\
             \"I\":{{{instance}}}}}}},\
             \"skinned_meshes\":{{\"X\":{{\"skeleton\":{{{skeleton}}}}}}}}}}}"
        )
        .expect("written");
        text
    }

    fn world(&self) -> DMat4 {
        self.steps.iter().fold(DMat4::IDENTITY, |below, step| {
            let turn = DMat4::from_quat(DQuat::from_vec4(step.rotation));
            let moved = DMat4::from_translation(step.translation);
            moved * turn * DMat4::from_scale(step.scale) * below
        })
    }

    /// From the bone's own space to the world.
    fn full(&self, bone: usize) -> DMat4 {
        let Bone { extent, roll, parent, pose } = &self.bones[bone];
        let (above, offset) = match parent {
            Some(parent) => (self.full(*parent), self.bones[*parent].extent),
            None => (self.world(), self.base + self.base_offset),
        };
        let y = if *extent == DVec3::ZERO { DVec3::Y } else { extent.normalize() };
        let flat = DVec3::X - y * y.x;
        let flat = if flat.length() < 1e-9 { DVec3::Z } else { flat.normalize() };
        let (sin, cos) = roll.to_radians().sin_cos();
        let x = flat * cos - flat.cross(y) * sin;
        let frame =
            DMat4::from_cols(x.extend(0.0), y.extend(0.0), x.cross(y).extend(0.0), DVec4::W);
        let turn = DMat4::from_rotation_z(pose.z.to_radians())
            * DMat4::from_rotation_y(pose.y.to_radians())
            * DMat4::from_rotation_x(pose.x.to_radians());
        above * DMat4::from_translation(offset) * frame * turn * frame.transpose()
    }
}

impl Bone {
    fn text(&self) -> String {
        let parent = self.parent.map_or(u32::MAX, |parent| parent as u32);
        let (extent, pose) = (row(&self.extent.to_array()), row(&self.pose.to_array()));
        let roll = self.roll;
        format!("{{\"extent\":{extent},\"roll\":{roll},\"parent\":{parent},\"pose\":{pose}}}")
    }
}

fn row(numbers: &[f64]) -> String {
    format!("{numbers:?}")
}

fn shuffle(bones: &mut [Bone], random: &mut Random) {
    for index in (1..bones.len()).rev() {
        let other = random.below(index + 1);
        bones.swap(index, other);
        for bone in &mut *bones {
            bone.parent = bone.parent.map(|parent| match parent {
                parent if parent == index => other,
                parent if parent == other => index,
                parent => parent,
            });
        }
    }
}

#[test]
fn bones_are_where_the_formulas_of_the_format_put_them() {
    for seed in 0..2000 {
        let scene = Scene::random(&mut Random(seed));
        let text = scene.text();
        let Opened { document, order, .. } = open(&text);
        let pose = document.skeleton().pose();
        assert_eq!(order.len(), scene.bones.len());
        for (bone, &joint) in order.iter().enumerate() {
            let full = scene.full(bone);
            let size = full.to_cols_array().iter().fold(1.0_f64, |size, n| size.max(n.abs()));
            let bound = 2e-5 * size * scene.bones.len() as f64;
            let own = glam::Mat4::from(pose.full(joint)).as_dmat4();
            assert!(own.abs_diff_eq(full, bound), "seed {seed}, bone {bone}: {own} is not {full}");
            let tip = full.transform_point3(scene.bones[bone].extent);
            assert!(pose.tip(joint).as_dvec3().distance(tip) < bound, "seed {seed}, bone {bone}");
        }
    }
}

#[test]
fn tiny_and_huge_bones_have_a_frame() {
    for extent in ["[1e-45,0,0]", "[3e38,-3e38,3e38]", "[1,1e-40,0]", "[0,-1e-44,1e-44]"] {
        let opened = open(&bones(&format!("{{\"extent\":{extent},\"roll\":30}}")));
        let frame = opened.document.skeleton().joints()[0].frame;
        let squared = frame.transpose() * frame;
        assert!(squared.abs_diff_eq(glam::Mat3::IDENTITY, 1e-6), "{extent}: {frame}");
    }
}

// Scenes that are refused

#[test]
fn an_invalid_bone_or_handle_is_named() {
    let at = "scene.skinned_meshes.X.skeleton";
    let one = r#"{"extent":[0,1,0]}"#;
    let parent = |parent: i64| format!("{{\"extent\":[0,1,0],\n\"parent\":{parent}}}");
    for (fields, expected) in [
        ("\"base\":[0,0,0]".to_owned(), format!("line 1, column 45: {at}: missing field `bones`")),
        (
            "\"bones\":[{}]".to_owned(),
            format!("line 2, column 10: {at}.bones[0]: missing field `extent`"),
        ),
        (
            format!("\"bones\":[{one},{}]", parent(7)),
            format!("line 3, column 10: {at}.bones[1].parent: must be a bone from 0 to 1, got 7"),
        ),
        (
            format!("\"bones\":[{one},{}]", parent(-1)),
            format!(
                "line 3, column 10: {at}.bones[1].parent: invalid type: integer `-1`, expected a \
                 whole number from 0 to 4294967295"
            ),
        ),
        (
            format!("\"bones\":[{}]", parent(0)),
            format!(
                "line 3, column 10: {at}.bones[0].parent: must not be a descendant of bone 0, got 0"
            ),
        ),
        (
            format!("\"bones\":[{one},{},{},{}]", parent(2), parent(3), parent(1)),
            format!(
                "line 5, column 10: {at}.bones[3].parent: must not be a descendant of bone 3, got 1"
            ),
        ),
        (
            "\"bones\":[{\"extent\":[0,1]}]".to_owned(),
            format!(
                "line 2, column 20: {at}.bones[0].extent: found 2 numbers, expected three: [x, y, z]"
            ),
        ),
        (
            "\"bones\":[{\"extent\":[0,NaN,0]}]".to_owned(),
            format!("line 2, column 23: {at}.bones[0].extent[1]: not JSON: expected value"),
        ),
        (
            "\"bones\":[{\"extent\":[0,1,0],\"roll\":1e39}]".to_owned(),
            format!("line 2, column 35: {at}.bones[0].roll: must be within ±3.4028235e38"),
        ),
        (
            "\"bones\":[{\"extent\":[0,1,0],\"roll\":\"0\"}]".to_owned(),
            format!(
                "line 2, column 35: {at}.bones[0].roll: invalid type: string \"0\", expected a number"
            ),
        ),
        (
            "\"bones\":[{\"extent\":[0,1,0],\"radius\":-2}]".to_owned(),
            format!("line 2, column 37: {at}.bones[0].radius: must be 0 or more, got -2"),
        ),
        (
            "\"bones\":[],\"base\":[3e38,0,0],\"base_offset\":[3e38,0,0]".to_owned(),
            format!(
                "line 2, column 44: {at}.base_offset: base + base_offset must be within \
                 ±3.4028235e38"
            ),
        ),
        (
            format!("\"bones\":[{one}],\"handles\":[{{\"bone\":3,\"target\":[0,0,0]}}]"),
            format!("line 2, column 49: {at}.handles[0].bone: must be 0, the only bone, got 3"),
        ),
        (
            format!("\"bones\":[{one}],\"handles\":[{{\"bone\":0}}]"),
            format!("line 2, column 41: {at}.handles[0]: missing field `target`"),
        ),
    ] {
        assert_eq!(refusal(&skeleton(&fields)), format!("test.js3d, {expected}"), "{fields}");
    }
}

#[test]
fn an_invalid_instance_transform_is_named() {
    let scene = |transforms: &str| {
        format!(
            "{{\"scene\":{{\"skinned_meshes\":{{\"X\":{{\"skeleton\":{{\"bones\":[]}}}}}},\n\
             \"instances\":{{\"skinned_meshes\":{{\"I\":{{\"mesh\":\"X\",\"transform\":\"A\"}}}}}},\n\
             \"transforms\":{{{transforms}}}}}}}"
        )
    };
    for (transforms, expected) in [
        (
            "",
            "line 2, column 60: scene.instances.skinned_meshes.I.transform: must be the name of a \
             transform, got \"A\"",
        ),
        (
            "\"A\":{\"parent\":\"B\"}",
            "line 3, column 29: scene.transforms.A.parent: must be the name of a transform, \
             got \"B\"",
        ),
        (
            "\"B\":{\"parent\":\"A\"},\n\"A\":{\"parent\":\"B\"}",
            "line 3, column 29: scene.transforms.B.parent: transform must not be its own \
             ancestor, got \"A\"",
        ),
        (
            "\"A\":{\"parent\":\"A\"}",
            "line 3, column 29: scene.transforms.A.parent: transform must not be its own \
             ancestor, got \"A\"",
        ),
        (
            "\"A\":{\"rotation\":[0,0,0,0]}",
            "line 3, column 31: scene.transforms.A.rotation: must not be four zeros; \
             the identity is [0, 0, 0, 1]",
        ),
        (
            "\"A\":{\"rotation\":[0,0,1]}",
            "line 3, column 31: scene.transforms.A.rotation: found 3 numbers, expected four: [x, y, \
             z, w]",
        ),
        (
            "\"A\":{\"parent\":\"B\",\"scale\":[1e30,1,1]},\"B\":{\"scale\":[1e30,1,1]}",
            "line 3, column 57: scene.transforms.B: must be within ±3.4028235e38 in the world",
        ),
        ("\"A\":{},\"A\":{}", "line 3, column 24: scene.transforms: duplicate name \"A\""),
    ] {
        let expected = format!("test.js3d, {expected}");
        assert_eq!(refusal(&scene(transforms)), expected, "{transforms}");
    }
}

#[test]
fn a_scene_without_a_skeleton_is_refused() {
    let reason = "must have a mesh with a `skeleton`";
    for (text, place) in [
        ("{\"scene\":{}}", "line 1, column 10"),
        ("{\"scene\":{\"skinned_meshes\":{}}}", "line 1, column 28"),
        ("{\"scene\":{\"skinned_meshes\":\n{\"X\":{\"mesh\":{}}}}}", "line 2, column 1"),
    ] {
        let expected = format!("test.js3d, {place}: scene.skinned_meshes: {reason}");
        assert_eq!(refusal(text), expected);
    }
    assert_eq!(
        refusal("{\"scene\": []}"),
        "test.js3d, line 1, column 11: scene: invalid type: sequence, expected an object: {…}"
    );
}

#[test]
fn chains_open_up_to_the_largest_number_of_joints() {
    let chain = |count: usize| {
        let bone = |index: usize| {
            let parent = if index + 1 < count { index as u64 + 1 } else { u64::from(u32::MAX) };
            format!("{{\"extent\":[0,1,0],\"parent\":{parent}}}")
        };
        bones(&(0..count).map(bone).collect::<Vec<_>>().join(","))
    };
    let opened = open(&chain(10_000));
    let first = opened.order[0];
    assert_eq!((first.index(), opened.document.skeleton().pose().tip(first).y), (9_999, 10_000.0));
    let expected =
        "scene.skinned_meshes.X.skeleton.bones: a skeleton must have at most 10000 joints";
    assert_eq!(refusal(&chain(10_001)), format!("test.js3d, line 2, column 9: {expected}"));
}

#[test]
fn damaged_scenes_open_or_are_refused_and_never_crash() {
    for seed in 0..50 {
        let random = &mut Random(seed);
        let text = Scene::random(random).text();
        for damaged in mutations(&text, random, 40) {
            let _ = io::read("x", &*damaged, &io::OpenOptions::default()).map_err(message);
        }
    }
}

// Skins

fn base64(bytes: &[u8]) -> String {
    use base64::Engine as _;
    // Scotty3D writes no padding.
    base64::engine::general_purpose::STANDARD_NO_PAD.encode(bytes)
}

fn wholes(numbers: &[u32]) -> String {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    format!("uint32:{}", base64(&bytes))
}

fn floats(kind: &str, numbers: &[f32]) -> String {
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    format!("{kind}:{}", base64(&bytes))
}

/// A box from y = 0 to 2 as six quads around two bones of length 1, as Scotty3D saves it. The faces
/// are numbered by their corners, counter-clockwise seen from outside.
struct HalfEdgeBox {
    positions: Vec<Vec3>,
    faces: Vec<[usize; 4]>,
}

impl HalfEdgeBox {
    fn new() -> Self {
        let corner = |at: usize| {
            Vec3::new((at & 1) as f32 - 0.5, (at >> 1 & 1) as f32 * 2.0, (at >> 2) as f32 - 0.5)
        };
        let faces = vec![
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Self { positions: (0..8).map(corner).collect(), faces }
    }

    /// The mesh as JSON, without weights.
    fn json(&self) -> serde_json::Value {
        let sides =
            self.faces.iter().flat_map(|face| (0..4).map(|at| (face[at], face[(at + 1) % 4])));
        let sides: Vec<(usize, usize)> = sides.collect();
        // Edges, and for each of their sides the index of its half-edge.
        let mut edges: Vec<(usize, usize)> =
            sides.iter().filter(|(from, to)| from < to).copied().collect();
        edges.sort_unstable();
        let index = |(from, to): (usize, usize)| {
            let edge = edges.iter().position(|edge| *edge == (from.min(to), from.max(to)));
            2 * edge.expect("an edge") as u32 + u32::from(from > to)
        };
        let mut nexts = vec![0; sides.len()];
        for face in &self.faces {
            for at in 0..4 {
                let next = (face[(at + 1) % 4], face[(at + 2) % 4]);
                nexts[index((face[at], face[(at + 1) % 4])) as usize] = index(next);
            }
        }
        let of_vertex = |vertex: usize| {
            index(*sides.iter().find(|(from, _)| *from == vertex).expect("a half-edge"))
        };
        let faces: Vec<u32> = self.faces.iter().map(|face| index((face[0], face[1]))).collect();
        let positions: Vec<f32> = self.positions.iter().flat_map(Vec3::to_array).collect();
        serde_json::json!({
            "FORMAT": "s3d-hm-1",
            "halfedge_nexts": wholes(&nexts),
            "halfedge_corner_uvs": floats("vec2", &vec![0.25; 2 * nexts.len()]),
            "halfedge_corner_normals": floats("vec3", &vec![0.0; 3 * nexts.len()]),
            "vertex_halfedges": wholes(&(0..8).map(of_vertex).collect::<Vec<_>>()),
            "vertex_positions": floats("vec3", &positions),
            "face_halfedges": wholes(&faces),
            "face_boundaries": format!("bool:{}", base64(&[0b0000_0010])),
        })
    }

    fn scene(mesh: &serde_json::Value) -> Opened {
        let text = serde_json::json!({ "scene": { "skinned_meshes": { "X": {
            "mesh": mesh,
            "skeleton": { "bones": [
                { "extent": [0, 1, 0], "radius": 0.9, "parent": 1 },
                { "extent": [0, 1, 0], "radius": 2.0 },
            ] },
        } } } });
        open(&text.to_string())
    }
}

#[test]
fn a_half_edge_mesh_becomes_a_skin_with_the_weights_of_the_file() {
    let cube = HalfEdgeBox::new();
    let mut mesh = cube.json();
    // Vertices below follow the root, which is bone 1, the others both bones.
    let (mut bones, mut weights, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    for position in &cube.positions {
        match position.y {
            0.0 => (bones.push(1), weights.push(1.0)),
            _ => (bones.extend([0, 1]), weights.extend([3.0, 1.0])),
        };
        ends.push(bones.len() as u32);
    }
    mesh["vertex_bone_weight_ends"] = wholes(&ends).into();
    mesh["bone_weight_bones"] = wholes(&bones).into();
    mesh["bone_weight_weights"] = floats("float", &weights).into();
    let opened = HalfEdgeBox::scene(&mesh);
    assert_eq!(opened.warnings, []);
    let attached = opened.document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh");
    let (mesh, weights) = (attached.mesh.mesh(), attached.mesh.weights());
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (24, 12));
    let mut volume = 0.0;
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        volume += a.dot(b.cross(c)) / 6.0;
        let normal = mesh.normals[corners[0] as usize];
        assert!((b - a).cross(c - a).normalize().distance(normal) < 1e-6, "flat without normals");
    }
    assert!((volume - 2.0).abs() < 1e-5, "all faces look outwards: {volume}");
    // The root comes first in the skeleton.
    for (position, weights) in mesh.positions.iter().zip(weights) {
        let expected = if position.y == 0.0 { (1.0, 0.0) } else { (0.25, 0.75) };
        let found = (weights.of(JointId::new(0)), weights.of(JointId::new(1)));
        assert_eq!(found, expected, "{position}");
    }
}

#[test]
fn without_weights_in_the_file_bones_weigh_by_the_rest_of_their_radii() {
    let opened = HalfEdgeBox::scene(&HalfEdgeBox::new().json());
    assert_eq!(opened.warnings, []);
    let attached = opened.document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh");
    for (position, weights) in attached.mesh.mesh().positions.iter().zip(attached.mesh.weights()) {
        // The root goes from y = 0 to 1 with the radius 2, the other bone to y = 2 with 0.9.
        let beside = 0.5_f32.hypot(0.5);
        let [of_root, of_tip] = match position.y {
            0.0 => [1.0 - beside / 2.0, (1.0 - beside.hypot(1.0) / 0.9).max(0.0)],
            _ => [1.0 - beside.hypot(1.0) / 2.0, 1.0 - beside / 0.9],
        };
        let found = weights.of(JointId::new(0));
        assert!((found - of_root / (of_root + of_tip)).abs() < 1e-5, "{position}: {weights:?}");
    }
}

#[test]
fn vertices_out_of_all_radii_follow_the_nearest_bone_with_a_remark() {
    let mut cube = HalfEdgeBox::new();
    cube.positions.iter_mut().for_each(|position| *position *= 10.0);
    let opened = HalfEdgeBox::scene(&cube.json());
    let said = &opened.warnings[0].reason;
    assert_eq!(said, "8 of 8 vertices have no weights; they follow the nearest bone");
    let attached = opened.document.rig.skin.as_ref().expect("a skin").mesh().expect("a mesh");
    for (position, weights) in attached.mesh.mesh().positions.iter().zip(attached.mesh.weights()) {
        assert_eq!(weights.first().index(), usize::from(position.y > 0.0), "{position}");
    }
}

#[test]
fn damaged_half_edges_leave_the_skin_out_with_the_reason() {
    let plain = HalfEdgeBox::new().json();
    for (key, value, expected) in [
        ("FORMAT", "s3d-hm-2".to_owned(), "must be \"s3d-hm-1\", got \"s3d-hm-2\""),
        ("halfedge_nexts", wholes(&[0, 1, 2]), "must have an even number of entries, got 3"),
        ("halfedge_nexts", wholes(&[99; 24]), "must be below 24, the number of half-edges, got 99"),
        ("vertex_positions", "vec2:AAAA".to_owned(), "must begin with \"vec3:\""),
        (
            "vertex_positions",
            floats("vec3", &[0.0; 3]),
            "must have 8 entries like vertex_halfedges",
        ),
        ("face_halfedges", wholes(&[24]), "must be below 24, the number of half-edges, got 24"),
    ] {
        let mut mesh = plain.clone();
        mesh[key] = value.into();
        let opened = HalfEdgeBox::scene(&mesh);
        let said = opened.warnings[0].to_string();
        assert!(said.contains(expected) && said.ends_with("; the skin is left out"), "{said}");
        assert!(opened.document.rig.skin.is_none());
    }
    // Half-edges that lead nowhere, faces that share them: some triangles are missing, no more.
    let mut random = Random(7);
    for _ in 0..200 {
        let mut mesh = plain.clone();
        let nexts: Vec<u32> = (0..24).map(|_| random.below(24) as u32).collect();
        mesh["halfedge_nexts"] = wholes(&nexts).into();
        HalfEdgeBox::scene(&mesh);
    }
}

#[test]
fn faces_that_bound_a_hole_are_left_out() {
    let mut mesh = HalfEdgeBox::new().json();
    // The second of six faces, then the mark of the end.
    mesh["face_boundaries"] = format!("bool:{}", base64(&[0b0100_0010])).into();
    let opened = HalfEdgeBox::scene(&mesh);
    let skin = opened.document.rig.skin.as_ref().expect("a skin");
    let mesh = skin.mesh().expect("a mesh").mesh.mesh();
    assert_eq!(mesh.triangles.len(), 10);
    // The second face is that of z = 0.5.
    assert!(mesh.normals.iter().all(|normal| normal.z < 0.5), "{:?}", mesh.normals);
}
