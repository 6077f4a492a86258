//! Skins moved by the device against those moved by the CPU.
#![cfg(feature = "render")]

mod common;
mod pictures;

use common::Random;
use common::skeletons::{shake, transform, tree};
use glam::{Affine3A, Vec3};
use ik_arm::io::Example;
use ik_arm::kinematics::skeleton::Skeleton;
use ik_arm::kinematics::skin::{SkinShape, SkinnedMesh, Skinning};
use ik_arm::render::SkinDeformer;
use pictures::GPU;

fn assert_agrees(skeleton: &Skeleton, mesh: &SkinnedMesh, case: &str) {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let deformer = SkinDeformer::new(&gpu);
    let pose = mesh.pose(skeleton);
    for skinning in Skinning::ALL {
        let expected = mesh.posed(&pose, skinning);
        let (positions, normals) = deformer.deform(&gpu, mesh, &pose, skinning).expect("deformed");
        assert_eq!(positions.len(), expected.positions.len());
        let size = expected.size();
        for (vertex, at) in positions.iter().enumerate() {
            let error = at.distance(expected.positions[vertex]) / size;
            assert!(error < 1e-5, "{case}, {skinning}: vertex {vertex} is {error:.1e} away");
            let turned = normals[vertex].distance(expected.normals[vertex]);
            assert!(turned < 1e-2, "{case}, {skinning}: normal {vertex} is off by {turned:.1e}");
        }
    }
}

#[test]
fn the_device_moves_the_skins_of_all_examples_as_the_cpu_does() {
    let mut skins = 0;
    for example in Example::ALL {
        let document = example.open().expect("opens").document;
        let Some(skin) = &document.skeleton_rig.skin else { continue };
        let mesh = &skin.mesh().expect("a mesh").mesh;
        for time in [0.0, 0.7] {
            let shown = document.evaluate(time);
            let posed = shown.skeleton_rig.skeleton_at(time);
            assert_agrees(&posed, mesh, &format!("{} at {time} s", example.name));
        }
        skins += 1;
    }
    assert!(skins >= 5, "{skins} examples have skins");
}

#[test]
fn the_device_moves_skins_of_random_trees_as_the_cpu_does() {
    for seed in 0..12 {
        let mut random = Random(seed);
        let (mut skeleton, _) = tree(&mut random, 3, 1.0);
        skeleton.set_transform(transform(&mut random)).expect("transform");
        let shape = SkinShape { detail: SkinShape::LEAST_DETAIL, ..SkinShape::default() };
        let mesh = SkinnedMesh::from_bones(&skeleton, &shape).expect("skin");
        // Attached in another space, with a scale.
        let attached = Affine3A::from_scale(Vec3::splat(random.within(0.5..2.0)));
        let binds = mesh.inverse_binds().iter().map(|bind| *bind * attached).collect();
        let mesh = SkinnedMesh::new(mesh.mesh().clone(), mesh.weights().to_vec(), binds);
        shake(&mut random, &mut skeleton);
        assert_agrees(&skeleton, &mesh.expect("mesh"), &format!("seed {seed}"));
    }
}
