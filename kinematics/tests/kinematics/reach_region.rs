//! Reach regions against solves from many poses, and against the two spheres of two bones.

use std::collections::HashMap;

use glam::Vec3;
use ik_arm_kinematics::chain_ik::{ChainSolver, ChainTarget, Method, SolverOptions};
use ik_arm_kinematics::limb_ik::Limb;
use ik_arm_kinematics::rig::{LimbSettings, ReachRegion, SkeletonRig, Target, TargetKind};
use ik_arm_kinematics::skeleton::{Joint, JointId, JointLimits, Limit, RotationAxis, Skeleton};
use ik_arm_kinematics::skin::TriangleMesh;

use crate::common::Random;
use crate::common::skeletons::{chain, shake};

/// A chain with a whole-body target at its tip.
fn rig(random: &mut Random, is_limited: bool) -> SkeletonRig {
    let mut skeleton = chain(random, 4, 1.0);
    for joint in skeleton.ids().filter(|_| is_limited) {
        let mut limits = JointLimits::NONE;
        for axis in RotationAxis::ALL {
            let (min, max) = (random.within(-1.0..-0.2), random.within(0.2..1.0));
            limits.set_range(axis, Some(Limit { min, max }));
        }
        skeleton.change(joint, |joint| joint.limits = limits).expect("limits");
    }
    let tip = skeleton.ids().last().expect("a tip");
    let mut rig = SkeletonRig::new(skeleton);
    rig.solver = SolverOptions::new(Method::DampedLeastSquares);
    let home = rig.skeleton.tip(tip);
    rig.targets.push(Target { influence: 1.0, ..Target::new(tip, home, 0.1) });
    rig
}

/// True if the tip comes to a place from one of many random poses.
fn is_reached(rig: &SkeletonRig, random: &mut Random, place: Vec3) -> bool {
    let target = [ChainTarget::at(rig.targets[0].joint, place)];
    let mut solver = ChainSolver::new(&rig.skeleton, &target, &rig.solver).expect("a solver");
    (0..12).any(|_| {
        let mut pose = Skeleton::clone(&rig.skeleton);
        shake(random, &mut pose);
        solver.begin_from(&pose);
        solver.run().converged()
    })
}

/// True if all places around a point, up to a cell away, are alike.
fn is_clear(region: &ReachRegion, place: Vec3) -> bool {
    let way = [-1.0, 0.0, 1.0].map(|step| step * region.cell());
    let own = region.contains(place);
    let mut around = way.into_iter().flat_map(|x| {
        way.into_iter().flat_map(move |y| way.into_iter().map(move |z| Vec3::new(x, y, z)))
    });
    around.all(|by| region.contains(place + by) == own)
}

#[test]
fn places_inside_are_reached_and_places_outside_are_not() {
    let mut random = Random(701);
    for is_limited in [false, true] {
        for case in 0..2 {
            let rig = rig(&mut random, is_limited);
            let region = ReachRegion::of(&rig, 0, 0.0).expect("a region");
            let (mut inside, mut outside) = (0, 0);
            let tip = rig.targets[0].joint;
            let (base, length) = (rig.skeleton.base(JointId::new(0)), rig.length_to(tip));
            while inside < 100 || outside < 100 {
                let place = base + random.vector(1.05 * length);
                let is_in = region.contains(place);
                let count = if is_in { &mut inside } else { &mut outside };
                if *count == 100 || !is_clear(&region, place) {
                    continue;
                }
                *count += 1;
                let at = format!("limited: {is_limited}, {case}: {place}");
                assert_eq!(is_reached(&rig, &mut random, place), is_in, "{at}");
            }
        }
    }
}

/// A limb of two bones of these lengths with its target.
fn limb(lengths: [f32; 2]) -> SkeletonRig {
    let mut skeleton = Skeleton::with_root("root");
    let upper = Joint::new("upper", Some(JointId::new(0)), Vec3::X * lengths[0]);
    let upper = skeleton.add(upper).expect("upper");
    let lower = Joint::new("lower", Some(upper), Vec3::X * lengths[1]);
    let lower = skeleton.add(Joint { offset: Vec3::X * lengths[0], ..lower }).expect("lower");
    assert!(Limb::ending_at(&skeleton, lower).is_ok());
    let mut rig = SkeletonRig::new(skeleton);
    let kind = TargetKind::Limb(LimbSettings::default());
    let target = Target::new(lower, Vec3::new(0.3, 0.9, 0.2), 0.1);
    rig.targets.push(Target { kind, influence: 1.0, ..target });
    rig
}

#[test]
fn the_region_of_two_bones_is_the_shell_between_two_spheres() {
    for lengths in [[1.0, 1.0], [1.2, 0.6], [0.5, 1.1]] {
        let rig = limb(lengths);
        let region = ReachRegion::of(&rig, 0, 0.0).expect("a region");
        let base = rig.skeleton.base(JointId::new(1));
        let (least, most) = ((lengths[0] - lengths[1]).abs(), lengths[0] + lengths[1]);
        assert!(region.cell() < most / 10.0);
        for place in region.places() {
            let distance = place.distance(base);
            assert!((least - 1e-3..most + 1e-3).contains(&distance), "{lengths:?}: {distance}");
        }
        for vertex in &region.surface().positions {
            let distance = vertex.distance(base);
            let off = (distance - most).abs().min((distance - least).abs());
            assert!(off < region.cell(), "{lengths:?}: a vertex is {off} from both spheres");
        }
    }
}

/// Volume that a mesh encloses.
fn volume(mesh: &TriangleMesh) -> f32 {
    let of_triangle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        a.cross(b).dot(c) / 6.0
    };
    mesh.triangles.iter().map(of_triangle).sum()
}

#[test]
fn the_surface_is_closed_and_holds_the_volume_of_the_shell() {
    let rig = limb([1.2, 0.6]);
    let region = ReachRegion::of(&rig, 0, 0.0).expect("a region");
    let mesh = region.surface();
    let mut edges: HashMap<[u32; 2], i32> = HashMap::new();
    for [a, b, c] in &mesh.triangles {
        for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() +=
                if from < to { 1 } else { -1 };
        }
    }
    assert!(edges.values().all(|count| *count == 0), "each edge goes both ways");
    let shell = 4.0 / 3.0 * std::f32::consts::PI * (1.8_f32.powi(3) - 0.6_f32.powi(3));
    let part = volume(mesh) / shell;
    assert!((0.93..1.07).contains(&part), "{part} of the volume of the shell");
}

#[test]
fn a_target_that_nothing_holds_has_no_region() {
    let mut free = rig(&mut Random(3), false);
    free.solver = free.solver.with_root(ik_arm_kinematics::chain_ik::Root::Free);
    assert_eq!(ReachRegion::of(&free, 0, 0.0), None);
}

#[test]
fn stiffness_changes_no_region_and_another_method_neither() {
    let mut rig = rig(&mut Random(5), true);
    let before = ReachRegion::of(&rig, 0, 0.0).expect("a region");
    rig.solver = SolverOptions::new(Method::Fabrik);
    for joint in rig.skeleton.ids().collect::<Vec<_>>() {
        let change = |joint: &mut Joint| joint.stiffness = Vec3::splat(0.6);
        rig.skeleton_mut().change(joint, change).expect("a stiffness");
    }
    let after = ReachRegion::of(&rig, 0, 0.0).expect("a region");
    assert_eq!(before, after);
}
