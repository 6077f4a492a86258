//! Figures that are recognised as people, those that are not, and the targets that people get.

mod schemes;

use std::f32::consts::FRAC_PI_2;

use glam::{Affine3A, Mat3, Quat, Vec3};
use ik_arm_kinematics::humanoid::{BodyPart, Humanoid, HumanoidLimb, NotHumanoid};
use ik_arm_kinematics::rig::SkeletonRig;
use ik_arm_kinematics::skeleton::{JointId, Skeleton};
use schemes::{Place, SCHEMES, Scheme, skeleton, unnamed};

use crate::common::Random;

fn scheme(name: &str) -> &'static Scheme {
    SCHEMES.iter().find(|scheme| scheme.name == name).expect(name)
}

/// The joints that a scheme's names stand for.
fn expected(scheme: &Scheme, person: &Skeleton) -> Humanoid {
    let joint = |name: &str| person.find(name).expect(name);
    let limb = |limb: usize, side: usize| {
        let [upper, lower, end] =
            scheme.limbs[limb].map(|it| joint(&it.replace('%', scheme.sides[side])));
        HumanoidLimb { upper, lower, end }
    };
    let limbs = |it| [limb(it, 0), limb(it, 1)];
    Humanoid { head: Some(joint(scheme.head)), arms: limbs(0), legs: limbs(1) }
}

#[test]
fn people_are_recognised_by_the_names_of_every_scheme() {
    for scheme in SCHEMES {
        let person = scheme.person();
        assert_eq!(Humanoid::of(&person), Ok(expected(scheme, &person)), "{}", scheme.name);
    }
}

#[test]
fn rolled_and_posed_people_are_recognised() {
    let mut random = Random(1);
    for scheme in SCHEMES {
        let mut person = skeleton(&scheme.places(), |_| random.rotation());
        for joint in person.ids() {
            let turn = random.vector(0.6);
            person.set_rotation(joint, turn).expect("a finite rotation");
        }
        let turn = Quat::from_mat3(&random.rotation());
        let place = Affine3A::from_scale_rotation_translation(Vec3::splat(70.0), turn, Vec3::ONE);
        person.set_transform(place).expect("a finite transform");
        assert_eq!(Humanoid::of(&person), Ok(expected(scheme, &person)), "{}", scheme.name);
    }
}

#[test]
fn people_whose_left_is_called_right_face_where_their_toes_point() {
    for scheme in SCHEMES {
        let mirrored = Scheme { sides: [scheme.sides[1], scheme.sides[0]], ..*scheme };
        let person = mirrored.person();
        let humanoid = Humanoid::of(&person).expect(scheme.name);
        let (directions, _) = humanoid.directions(&person).expect("an upright figure");
        assert!(directions.forward.dot(Vec3::Z) > 0.99, "{}: {directions:?}", scheme.name);
    }
}

#[test]
fn people_without_known_names_are_recognised_by_their_shape() {
    let mut random = Random(2);
    for name in ["Mixamo", "SMPL", "VRM 1.0", "CMU, BVH"] {
        let scheme = scheme(name);
        let named = scheme.person();
        let known = expected(scheme, &named);
        for _ in 0..20 {
            let turn = random.rotation();
            let turned = |(name, parent, place): Place| (name, parent, turn * place);
            let places: Vec<Place> = scheme.places().into_iter().map(turned).collect();
            let places = unnamed(&places, &mut random);
            let person = skeleton(&places, |_| Mat3::IDENTITY);
            let found = Humanoid::of(&person).expect(name);
            let place = |person: &Skeleton, joint: JointId| person.base(joint);
            for ((_, found), (part, known)) in found.limbs().into_iter().zip(known.limbs()) {
                for (found, known) in [(found.lower, known.lower), (found.end, known.end)] {
                    let (found, known) = (place(&person, found), turn * place(&named, known));
                    assert!(found.distance(known) < 1e-4, "{name}, {part}: {found} is not {known}");
                }
            }
        }
    }
}

/// A person of VRM whose joints have names that tell nothing, with the bones that a file says they are.
fn with_bones(places: &[Place], bone: impl Fn(&str) -> Option<String>) -> Skeleton {
    let mut person = skeleton(places, |_| Mat3::IDENTITY);
    let joints: Vec<JointId> = person.ids().collect();
    for (number, joint) in joints.into_iter().enumerate() {
        let human_bone = bone(&person[joint].name);
        person.change(joint, |it| it.human_bone = human_bone).expect("a name");
        person.rename(joint, &format!("骨{number}")).expect("a name");
    }
    person
}

#[test]
fn a_person_is_recognised_by_the_bones_that_its_file_tells() {
    let vrm = scheme("VRM 1.0");
    let places = without(vrm, &["Toes", "toes"]);
    let named = skeleton(&places, |_| Mat3::IDENTITY);
    let known = expected(vrm, &named);
    let is_bone = |name: &str| {
        let limbs = known.limbs().into_iter().flat_map(|(_, it)| [it.upper, it.lower, it.end]);
        limbs.chain(known.head).any(|joint| named[joint].name == name)
    };
    let unnamed = with_bones(&places, |_| None);
    assert!(Humanoid::of(&unnamed).is_err(), "without toes, the shape tells nothing");
    let person = with_bones(&places, |name| is_bone(name).then(|| name.to_owned()));
    assert_eq!(Humanoid::of(&person), Ok(known));

    // A map is not believed more than the shape: hands for feet, and an incomplete one.
    let swapped = with_bones(&places, |name| {
        is_bone(name).then(|| match name.contains("Foot") {
            true => name.replace("Foot", "Hand"),
            false => name.replace("Hand", "Foot"),
        })
    });
    assert!(Humanoid::of(&swapped).is_err());
    let mut incomplete = named.clone();
    let head = incomplete.find(vrm.head).expect("a head");
    incomplete.change(head, |it| it.human_bone = Some("head".into())).expect("a name");
    assert_eq!(Humanoid::of(&incomplete), Ok(known), "by its names");
}

fn refused(places: &[Place]) -> NotHumanoid {
    Humanoid::of(&skeleton(places, |_| Mat3::IDENTITY)).expect_err("no person")
}

/// The places of a person without the joints whose names contain one of some texts, and those
/// below.
fn without(scheme: &Scheme, parts: &[&str]) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    for (name, parent, place) in scheme.places() {
        let is_there = |parent: &String| kept.iter().any(|(it, ..)| it == parent);
        let is_named = parts.iter().any(|part| name.contains(part));
        if !is_named && parent.as_ref().is_none_or(is_there) {
            kept.push((name, parent, place));
        }
    }
    kept
}

#[test]
fn a_part_of_a_person_is_refused_with_what_was_found() {
    let unreal = scheme("Unreal");
    assert_eq!(
        refused(&without(unreal, &["foot_l"])),
        NotHumanoid::Missing {
            found: vec![BodyPart::LeftArm, BodyPart::RightArm, BodyPart::RightLeg, BodyPart::Head],
            missing: vec![BodyPart::LeftLeg],
        }
    );
    let torso = refused(&without(unreal, &["thigh"]));
    assert_eq!(
        torso.to_string(),
        "found left arm, right arm and head, but no left leg or right leg"
    );
    let joints = "hand_l - wrist, thumb_l hand_l thumb, index_l hand_l finger";
    let hand = Scheme { joints, ..*unreal };
    assert_eq!(refused(&hand.places()), NotHumanoid::Unknown);
}

#[test]
fn two_people_in_one_skeleton_are_refused() {
    let unity = scheme("Unity");
    let second = |(name, parent, place): Place| {
        (format!("{name}.001"), parent.map(|it| format!("{it}.001")), place + Vec3::X)
    };
    let places: Vec<Place> =
        unity.places().into_iter().chain(unity.places().into_iter().map(second)).collect();
    assert!(matches!(refused(&places), NotHumanoid::Several { part: BodyPart::LeftArm, .. }));
}

#[test]
fn people_with_unequal_sides_are_refused() {
    let unity = scheme("Unity");
    let longer = |(name, parent, place): Place| {
        let is_hand = name == "LeftHand" || name == "LeftIndexProximal";
        (name, parent, if is_hand { place + 0.1 * Vec3::X } else { place })
    };
    let places: Vec<Place> = unity.places().into_iter().map(longer).collect();
    assert!(matches!(refused(&places), NotHumanoid::Uneven { limbs: "arms", .. }));
}

/// A horse: the places of a person with the trunk turned forwards, so that the arms go down.
fn horse(scheme: &Scheme) -> Vec<Place> {
    let forwards = Quat::from_rotation_x(FRAC_PI_2);
    let hips = Vec3::Y;
    let turned = |(name, parent, place): Place| {
        let place = if place.y > 1.0 && place.x.abs() <= 0.2 {
            hips + forwards * (place - hips)
        } else if place.y > 1.0 {
            let down = place.x.abs() - 0.2;
            Vec3::new(0.2 * place.x.signum(), 1.0 - down, 0.45)
        } else {
            place
        };
        (name, parent, place)
    };
    scheme.places().into_iter().map(turned).collect()
}

#[test]
fn four_legged_animals_with_the_names_of_people_are_refused() {
    for scheme in SCHEMES {
        assert_eq!(refused(&horse(scheme)), NotHumanoid::NotUpright, "{}", scheme.name);
    }
}

#[test]
fn unnamed_animals_and_machines_are_refused() {
    let mut random = Random(3);
    let horse = unnamed(&horse(scheme("SMPL")), &mut random);
    assert_eq!(refused(&horse), NotHumanoid::Unknown);
    let chain = |count: usize| -> Vec<Place> {
        let parent = |index: usize| index.checked_sub(1).map(|above| format!("part {above}"));
        (0..count).map(|it| (format!("part {it}"), parent(it), it as f32 * Vec3::Y)).collect()
    };
    assert_eq!(refused(&chain(30)), NotHumanoid::Unknown);
    let spider = (0..8).flat_map(|leg| {
        let way = Quat::from_rotation_y(leg as f32 * FRAC_PI_2 / 2.0) * Vec3::X;
        (1..4).map(move |part| {
            let parent = if part == 1 { "body".into() } else { format!("leg {leg} {}", part - 1) };
            let down = Vec3::NEG_Y * (part as f32 - 1.0);
            (format!("leg {leg} {part}"), Some(parent), part as f32 * way + down)
        })
    });
    let body = ("body".to_owned(), None, Vec3::ZERO);
    assert_eq!(
        refused(&[body].into_iter().chain(spider).collect::<Vec<_>>()),
        NotHumanoid::Unknown
    );
}

#[test]
fn unnamed_people_without_toes_are_refused() {
    let places = without(scheme("Mixamo"), &["Toe"]);
    assert_eq!(refused(&unnamed(&places, &mut Random(4))), NotHumanoid::NoFront);
}

/// A person with targets.
struct Posed {
    humanoid: Humanoid,
    rig: SkeletonRig,
    before: Skeleton,
}

impl Posed {
    fn new(person: Skeleton) -> Self {
        let humanoid = Humanoid::of(&person).expect("a person");
        let mut rig = SkeletonRig::new(person.clone());
        let added = rig.add_humanoid_targets(&person).expect("a person");
        assert_eq!(added.len(), 5);
        Self { humanoid, rig, before: person }
    }

    /// Size of the person in the world.
    fn size(&self) -> f32 {
        self.rig.reach()
    }

    fn target_of(&self, limb: HumanoidLimb) -> usize {
        self.rig.target(limb.lower).expect("a target of the limb")
    }
}

#[test]
fn new_targets_of_people_leave_the_pose() {
    let mut random = Random(5);
    for scheme in SCHEMES {
        let mut person = skeleton(&scheme.places(), |_| random.rotation());
        // Elbows and knees that are bent the wrong way would bend back.
        let limbs = expected(scheme, &person).limbs().map(|(_, limb)| limb);
        let is_within = |person: &Skeleton, joint: JointId| {
            limbs.iter().any(|limb| {
                let mut bones = person.ancestors(limb.end).take_while(|above| *above != limb.upper);
                bones.any(|bone| bone == joint)
            })
        };
        for joint in person.ids() {
            if is_within(&person, joint) {
                continue;
            }
            let turn = random.vector(0.4);
            person.set_rotation(joint, turn).expect("a finite rotation");
        }
        let posed = Posed::new(person);
        let evaluated = posed.rig.evaluate(0.0);
        let now = evaluated.solved.pose();
        for (joint, name) in posed.before.iter().map(|(id, joint)| (id, &joint.name)) {
            let moved = now.base(joint).distance(posed.before.base(joint));
            assert!(moved < 2e-3 * posed.size(), "{}: {name} moves by {moved}", scheme.name);
        }
        for report in &evaluated.targets {
            assert!(posed.rig.is_reached(report), "{}: {report:?}", scheme.name);
        }
    }
}

/// Moves the end of each limb towards its upper joint in turn, and checks that it gets there and on
/// which side the elbow or knee is.
fn assert_limbs_bend_as_those_of_people(posed: &Posed, name: &str) {
    let (directions, _) = posed.humanoid.directions(&posed.before).expect("an upright figure");
    for (part, limb) in posed.humanoid.limbs() {
        let base = |joint| posed.before.base(joint);
        for fraction in [0.95, 0.8, 0.6] {
            let mut rig = posed.rig.clone();
            let (upper, end) = (base(limb.upper), base(limb.end));
            let goal = upper + fraction * (end - upper);
            let index = posed.target_of(limb);
            rig.targets[index] = rig.targets[index].placed(&posed.before, 0.0, goal);
            let evaluated = rig.evaluate(0.0);
            let pose = evaluated.solved.pose();
            let missed = pose.base(limb.end).distance(goal);
            assert!(missed < 1e-3 * posed.size(), "{name}, {part}: {missed} away at {fraction}");
            let along = (goal - pose.base(limb.upper)).normalize();
            let middle =
                (pose.base(limb.lower) - pose.base(limb.upper)).reject_from_normalized(along);
            let front = posed.before.transform().transform_vector3(directions.forward).normalize();
            let ahead = middle.normalize().dot(front);
            let is_right = if part.is_leg() { ahead > 0.7 } else { ahead < -0.7 };
            assert!(is_right, "{name}, {part} at {fraction}: {ahead} to the front");
        }
    }
}

#[test]
fn knees_bend_to_the_front_and_elbows_to_the_back() {
    for scheme in SCHEMES {
        assert_limbs_bend_as_those_of_people(&Posed::new(scheme.person()), scheme.name);
    }
}

#[test]
fn rolled_joints_bend_as_others() {
    let mut random = Random(6);
    for scheme in SCHEMES {
        let mut person = skeleton(&scheme.places(), |_| random.rotation());
        let turn = Quat::from_mat3(&random.rotation());
        let place = Affine3A::from_scale_rotation_translation(Vec3::splat(100.0), turn, Vec3::X);
        person.set_transform(place).expect("a finite transform");
        assert_limbs_bend_as_those_of_people(&Posed::new(person), scheme.name);
    }
}

#[test]
fn knees_and_elbows_that_are_bent_slightly_the_wrong_way_bend_the_right_way() {
    for scheme in SCHEMES {
        for bend in [0.02, 0.05, 0.08, 0.12] {
            let mut person = scheme.person();
            for (part, limb) in expected(scheme, &person).limbs() {
                let side = if part.is_leg() { -Vec3::X } else { Vec3::Y };
                let sign = if part == BodyPart::LeftArm { 1.0 } else { -1.0 };
                let sign = if part.is_leg() { 1.0 } else { sign };
                person.set_rotation(limb.lower, bend * sign * side).expect("a finite rotation");
            }
            let name = format!("{}, {bend}", scheme.name);
            assert_limbs_bend_as_those_of_people(&Posed::new(person), &name);
        }
    }
}

#[test]
fn heads_follow_what_they_look_at() {
    for scheme in SCHEMES {
        let mut posed = Posed::new(scheme.person());
        let head = posed.humanoid.head.expect("a head");
        let index = posed.rig.target(head).expect("a target of the head");
        let mut aim = posed.rig.targets[index].aim.expect("an aim");
        aim.point += Vec3::new(0.4, -0.1, 0.0);
        posed.rig.targets[index].aim = Some(aim);
        let evaluated = posed.rig.evaluate(0.0);
        let space = evaluated.solved.pose().full(head);
        let facing = space.transform_vector3(aim.axis).normalize();
        let way = (aim.point - Vec3::from(space.translation)).normalize();
        assert!(facing.angle_between(way) < 0.01, "{}: {facing} is not {way}", scheme.name);
    }
}

#[test]
fn parts_that_have_a_target_keep_it() {
    let person = scheme("Unity").person();
    let humanoid = Humanoid::of(&person).expect("a person");
    let mut rig = SkeletonRig::new(person.clone());
    let hand = humanoid.arms[0].end;
    let own = rig.new_target(hand, &person).expect("a target of the hand");
    rig.targets.push(own);
    let solver = rig.solver;
    assert_eq!(rig.add_humanoid_targets(&person).map(|added| added.len()), Ok(4));
    assert_eq!((rig.targets[0], rig.solver), (own, solver));
    assert_eq!(rig.add_humanoid_targets(&person), Ok(Vec::new()));
}
