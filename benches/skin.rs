//! Skins: made from bones, moved on the CPU, and read from files.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use ik_arm::document::Document;
use ik_arm::io::{self, Example, Progress};
use ik_arm::kinematics::skin::{SkinShape, SkinnedMesh, Skinning};
use ik_arm::rig::SkinSource;
use pollster::block_on;

fn example(name: &str) -> Document {
    Example::find(name).expect("an example").open().expect("it opens").document
}

/// The Human with so much detail, and the number of its vertices.
fn human(detail: f32) -> (Document, SkinShape, u64) {
    let document = example("human");
    let skin = document.rig.skin.as_ref().expect("a skin");
    let SkinSource::Bones(bones) = &skin.source else { panic!("the Human's skin is from bones") };
    let shape = SkinShape { detail, ..bones.shape().clone() };
    let mesh = SkinnedMesh::from_bones(document.skeleton(), &shape).expect("a mesh");
    let vertices = mesh.mesh().positions.len() as u64;
    (document, shape, vertices)
}

/// The time per vertex, of which each cell of the grid that the surface passes through has about
/// one, is the same for every detail.
fn from_bones(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("skin/from bones");
    group.sample_size(10);
    for detail in [1.2, 1.8, 2.4] {
        let (document, shape, vertices) = human(detail);
        group.throughput(Throughput::Elements(vertices));
        group.bench_function(BenchmarkId::new("human", detail), |bench| {
            bench.iter(|| SkinnedMesh::from_bones(document.skeleton(), &shape));
        });
    }
}

fn posed(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("skin/posed on the CPU");
    let (document, shape, vertices) = human(1.2);
    let mesh = SkinnedMesh::from_bones(document.skeleton(), &shape).expect("a mesh");
    let pose = mesh.pose(&document.rig.skeleton_at(0.0));
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    group.throughput(Throughput::Elements(vertices));
    for skinning in Skinning::ALL {
        group.bench_function(skinning.title(), |bench| {
            bench.iter(|| mesh.write_posed(&pose, skinning, &mut positions, &mut normals));
        });
    }
}

/// A file with about 50,000 vertices, without motion.
fn opened(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("skin/opened");
    group.sample_size(10);
    let (mut document, shape, _) = human(1.9);
    let rig = &mut document.rig;
    let source = ik_arm::rig::BoneSkin::new(rig.skeleton.clone(), shape);
    rig.skin.as_mut().expect("a skin").source = SkinSource::Bones(source);
    let bytes = block_on(io::glb(&document, None, &Progress::default())).expect("an export");
    group.throughput(Throughput::Bytes(bytes.len() as u64));
    group.bench_function("glb", |bench| {
        bench.iter(|| {
            io::read("human.glb", &bytes[..], &io::OpenOptions::default()).expect("it opens")
        });
    });
}

criterion_group!(benches, from_bones, posed, opened);
criterion_main!(benches);
