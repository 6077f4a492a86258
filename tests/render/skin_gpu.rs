//! Skins moved by the device against those moved by the CPU.

use glam::{Affine3A, Vec2, Vec3};
use ik_arm::document::{Camera, Document, Overlay, Skin, Theme};
use ik_arm::io::Example;
use ik_arm::kinematics::Shared;
use ik_arm::kinematics::skeleton::{Joint, JointId, Skeleton};
use ik_arm::kinematics::skin::{
    BindSet, Morph, SkinShape, SkinnedMesh, Skinning, TriangleMesh, VertexWeights,
};
use ik_arm::render::{PictureRenderer, SkinDeformer};
use ik_arm::rig::{FileMesh, MeshSkin, PartLook, SkeletonRig, SkinPart, SkinSource, SkinTexture};
use ik_arm::scene::{Scene, SkinInstance};
use ik_arm::session::Overlays;
use pollster::block_on;

use crate::common::Random;
use crate::common::skeletons::{shake, transform, tree};
use crate::pictures::{GPU, SIZE, draw};

fn assert_agrees(skeleton: &Skeleton, mesh: &SkinnedMesh, case: &str) {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let deformer = SkinDeformer::new(&gpu);
    let pose = mesh.pose(skeleton);
    for skinning in Skinning::ALL {
        let expected = mesh.posed(&pose, skinning);
        let (positions, normals) =
            block_on(deformer.deform(&gpu, mesh, &pose, skinning)).expect("deformed");
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
        let Some(skin) = &document.rig.skin else { continue };
        let mesh = &skin.mesh().expect("a mesh").mesh;
        for time in [0.0, 0.7] {
            assert_agrees(
                document.at(time).skeleton(),
                mesh,
                &format!("{} at {time} s", example.name),
            );
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
        // Attached in other spaces, with a scale: the first vertices in one, the others in another.
        let count = mesh.mesh().positions.len();
        let first = random.below(count);
        let sets = [first, count - first].map(|vertices| {
            let attached = Affine3A::from_scale(Vec3::splat(random.within(0.5..2.0)));
            let binds = mesh.inverse_binds().iter().map(|bind| *bind * attached);
            BindSet { vertices, inverse_binds: binds.collect() }
        });
        let weights = mesh.weights().to_vec();
        let mesh = SkinnedMesh::with_bind_sets(mesh.mesh().clone(), weights, sets.into());
        shake(&mut random, &mut skeleton);
        assert_agrees(&skeleton, &mesh.expect("mesh"), &format!("seed {seed}"));
    }
}

/// A square of the size 2 about the origin, with the colours and textures of its two halves.
fn square(parts: Vec<SkinPart>) -> Document {
    coloured_square(parts, Vec::new())
}

/// A square whose corners have colours, from the lower left counter-clockwise.
fn coloured_square(parts: Vec<SkinPart>, colours: Vec<[u8; 4]>) -> Document {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let positions: Vec<Vec3> =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| corner(x, y)).into();
    let coordinates = positions.iter().map(|at| Vec2::new(0.5 * at.x + 0.5, 0.5 - 0.5 * at.y));
    let mesh = TriangleMesh {
        normals: vec![Vec3::Z; 4],
        texture_coordinates: coordinates.collect(),
        positions,
        colours,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..TriangleMesh::default()
    };
    let weights = vec![VertexWeights::rigid(JointId::new(0)); 4];
    let mesh = SkinnedMesh::new(mesh, weights, vec![Affine3A::IDENTITY]).expect("a mesh");
    let skeleton = Skeleton::with_root("root");
    let in_file = FileMesh { mesh, parents: vec![None], parts };
    let skin = MeshSkin::new(in_file.into(), None, vec![Some(JointId::new(0))], &skeleton);
    let mut rig = SkeletonRig::new(skeleton);
    rig.skin = Some(Skin::new(SkinSource::Mesh(skin)));
    let camera =
        Camera { target: Vec3::ZERO, yaw: 0.0, pitch: 0.0, distance: 4.0, ..Camera::default() };
    let display = [Overlay::Skin].into_iter().collect();
    Document { camera, display, ..Document::new(rig) }
}

/// The greatest channel at a point of the square, which is nearly white otherwise.
fn channel_at(picture: &image::RgbaImage, x: f32, y: f32) -> usize {
    let (width, height) = (picture.width() as f32, picture.height() as f32);
    let at = (0.5 * width + 0.2 * height * x, 0.5 * height - 0.2 * height * y);
    let pixel = picture.get_pixel(at.0 as u32, at.1 as u32).0;
    let greatest = (0..3).max_by_key(|channel| pixel[*channel]).expect("three channels");
    let others = (0..3).filter(|channel| *channel != greatest);
    assert!(others.into_iter().all(|other| pixel[other] < pixel[greatest] / 2), "{pixel:?}");
    greatest
}

#[test]
fn a_double_sided_part_is_seen_from_behind_and_lit_as_from_outside() {
    let seen = |is_double_sided: bool, yaw: f32| {
        let look = PartLook { is_double_sided, ..PartLook::default() };
        let part = SkinPart { colour: [1.0, 0.1, 0.1], look, ..SkinPart::white(2) };
        let mut document = square(vec![part]);
        document.camera.yaw = yaw;
        let picture = draw(&Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark));
        let [red, green, _, _] =
            picture.get_pixel(picture.width() / 2 + 9, picture.height() / 2 + 9).0;
        (red > green.saturating_mul(3)).then_some(red)
    };
    let front = seen(false, 0.0).expect("the front is drawn");
    assert_eq!(seen(true, 0.0), Some(front));
    assert_eq!(seen(false, std::f32::consts::PI), None, "the back is not drawn");
    let back = seen(true, std::f32::consts::PI).expect("the back is drawn");
    // The light comes from the front right: the back is darker than the front, but lit by its own
    // normal and not black.
    assert!(back > 40 && back != front, "{back}, {front}");
}

#[test]
fn a_mesh_that_morphs_from_frame_to_frame_is_drawn_as_if_it_were_new() {
    let red = SkinPart { colour: [1.0, 0.1, 0.1], ..SkinPart::white(2) };
    let document = square(vec![red]);
    let skin = document.rig.skin.as_ref().and_then(|skin| skin.mesh_skin()).expect("a mesh");
    let FileMesh { mesh, parents, parts } = FileMesh::clone(skin.in_file().expect("a mesh"));
    let morph = Morph {
        name: "wide".into(),
        vertices: vec![1, 2],
        offsets: vec![Vec3::X; 2],
        normals: vec![Vec3::ZERO; 2],
    };
    let mesh = mesh.with_morphs(vec![morph]).expect("a morph target");
    let in_file = FileMesh { mesh, parents, parts };
    let joints = vec![Some(JointId::new(0))];
    let skin = MeshSkin::new(in_file.into(), None, joints, document.skeleton());
    let scene = |weight: f32| {
        let mut document = document.clone();
        let morphed = skin.clone().with_morph_weights(vec![weight]);
        document.rig.skin = Some(Skin::new(SkinSource::Mesh(morphed)));
        Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark)
    };
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let fresh = |weight: f32| {
        let mut renderer = PictureRenderer::new(&gpu, SIZE.0, SIZE.1, 1.0);
        block_on(renderer.draw(&scene(weight))).expect("drawn")
    };
    let mut renderer = PictureRenderer::new(&gpu, SIZE.0, SIZE.1, 1.0);
    for weight in [0.0, 0.5, 1.0, -0.5, 0.0] {
        let drawn = block_on(renderer.draw(&scene(weight))).expect("drawn");
        assert!(drawn == fresh(weight), "weight {weight}");
    }
    assert!(fresh(0.0) != fresh(1.0));
}

#[test]
fn see_through_parts_let_what_is_behind_through_and_shining_ones_are_as_bright_as_their_light() {
    let middle = |part: SkinPart| {
        let square = square(vec![part]);
        let picture = draw(&Scene::new(&square.at(0.0), &Overlays::default(), Theme::Dark));
        picture.get_pixel(picture.width() / 2 + 9, picture.height() / 2 + 9).0
    };
    let of = |opacity| {
        let look = PartLook { opacity, ..PartLook::default() };
        middle(SkinPart { colour: [1.0, 0.1, 0.1], look, ..SkinPart::white(2) })
    };
    let (opaque, half, none) = (of(None), of(Some(0.5)), of(Some(0.0)));
    assert_eq!(of(Some(1.0)), opaque);
    for channel in 0..3 {
        let mean = (u16::from(opaque[channel]) + u16::from(none[channel])) / 2;
        assert!(mean.abs_diff(half[channel].into()) <= 25, "{opaque:?}, {half:?}, {none:?}");
    }
    assert!(half[0] < opaque[0] && half[0] > none[0], "{opaque:?}, {half:?}, {none:?}");
    let look = PartLook { emission: [0.1, 0.9, 0.1], ..PartLook::default() };
    let shining = middle(SkinPart { colour: [0.0; 3], look, ..SkinPart::white(2) });
    assert!(shining[1] > 200 && shining[0] < 90, "{shining:?}");
}

#[test]
fn see_through_parts_are_drawn_farthest_first_from_all_sides_and_in_every_pose() {
    // Two squares, one behind the other: the one in front colours what is seen more.
    let of = |order: [f32; 2], yaw: f32, moves: bool| {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let squares = order.iter().flat_map(|z| corners.map(|(x, y)| Vec3::new(x, y, *z)));
        let mesh = TriangleMesh {
            positions: squares.collect(),
            normals: vec![Vec3::Z; 8],
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
            ..TriangleMesh::default()
        };
        // Each square follows a joint of its own.
        let weights = (0..8).map(|it| VertexWeights::rigid(JointId::new(it / 4))).collect();
        let mut skeleton = Skeleton::with_root("one");
        skeleton.add(Joint::new("other", None, Vec3::ZERO)).expect("a joint");
        let mesh = SkinnedMesh::new(mesh, weights, vec![Affine3A::IDENTITY; 2]).expect("a mesh");
        let look = PartLook { opacity: Some(0.7), is_double_sided: true, ..PartLook::default() };
        let part = |z: f32| {
            let colour = if z > 0.0 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
            SkinPart { colour, look, ..SkinPart::white(2) }
        };
        let in_file = FileMesh { mesh, parents: vec![None; 2], parts: order.map(part).to_vec() };
        let joints = (0..2).map(|it| Some(JointId::new(it))).collect();
        let skin = MeshSkin::new(in_file.into(), None, joints, &skeleton);
        if moves {
            // The squares change places.
            for (joint, z) in order.into_iter().enumerate() {
                let offset = Vec3::Z * (-2.0 * z);
                let moved = skeleton.change(JointId::new(joint), |it| it.offset = offset);
                moved.expect("finite");
            }
        }
        let mut document = Document::new(SkeletonRig::new(skeleton));
        document.rig.skin = Some(Skin::new(SkinSource::Mesh(skin)));
        document.display = [Overlay::Skin].into_iter().collect();
        document.camera =
            Camera { yaw, pitch: 0.0, distance: 8.0, target: Vec3::ZERO, ..Camera::default() };
        let picture = draw(&Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark));
        let [red, green, ..] =
            picture.get_pixel(picture.width() / 2 + 9, picture.height() / 2 + 9).0;
        red > green
    };
    for order in [[0.5, -0.5], [-0.5, 0.5]] {
        assert!(of(order, 0.0, false) && !of(order, std::f32::consts::PI, false), "{order:?}");
        assert!(!of(order, 0.0, true) && of(order, std::f32::consts::PI, true), "{order:?}, moved");
    }
}

#[test]
fn what_a_texture_cuts_out_of_a_see_through_skin_lets_all_behind_through() {
    let texture = SkinTexture::new(Vec::new(), [8, 8]);
    texture.pixels(|_| Ok(vec![[255, 255, 255, 0]; 64])).expect("pixels");
    let look = PartLook { alpha_cutoff: 0.5, is_double_sided: true, ..PartLook::default() };
    let cut_out = SkinPart { texture: Some(Shared::from(texture)), look, ..SkinPart::white(1) };
    let skin = |part: &SkinPart, z: f32| {
        let square = square(vec![part.clone(); 2]);
        let mut scene = Scene::new(&square.at(0.0), &Overlays::default(), Theme::Dark);
        let mut skin = scene.skins.pop().expect("a skin");
        (skin.colour, skin.offset) = (skin.colour.with_opacity(0.5), Vec3::Z * z);
        skin
    };
    let red = SkinPart { colour: [1.0, 0.0, 0.0], ..SkinPart::white(1) };
    let picture = |skins: Vec<SkinInstance>| {
        let square = square(vec![red.clone()]);
        let mut scene = Scene::new(&square.at(0.0), &Overlays::default(), Theme::Dark);
        scene.skins = skins;
        draw(&scene)
    };
    let behind = picture(vec![skin(&red, -0.5)]);
    assert!(picture(vec![skin(&cut_out, 0.5), skin(&red, -0.5)]) == behind);
    assert!(picture(vec![skin(&red, 0.5), skin(&red, -0.5)]) != behind);
}

#[test]
fn a_figure_stays_in_front_of_its_onion_skins() {
    let square = square(vec![SkinPart { colour: [1.0, 0.0, 0.0], ..SkinPart::white(2) }]);
    let scene = || Scene::new(&square.at(0.0), &Overlays::default(), Theme::Dark);
    let mut ghost = scene().skins.pop().expect("a skin");
    // Nearer than the figure, and beside it in part.
    (ghost.colour, ghost.offset) = (ghost.colour.with_opacity(0.5), Vec3::new(0.6, 0.0, 0.5));
    let picture = |has_figure: bool, has_ghost: bool| {
        let mut scene = scene();
        scene.skins.truncate(usize::from(has_figure));
        scene.skins.extend(has_ghost.then(|| ghost.clone()));
        draw(&scene)
    };
    let [empty, alone] = [false, true].map(|has_figure| picture(has_figure, false));
    let [ghost_alone, both] = [false, true].map(|has_figure| picture(has_figure, true));
    // Clear of edges, where pixels are mixed.
    let covers = |picture: &image::RgbaImage, x: u32, y: u32| {
        let around = [(x - 2, y), (x + 2, y), (x, y - 2), (x, y + 2)];
        around.iter().all(|(x, y)| picture.get_pixel(*x, *y) != empty.get_pixel(*x, *y))
    };
    let inside = (2..SIZE.0 - 2).flat_map(|x| (2..SIZE.1 - 2).map(move |y| (x, y)));
    let (mut shared, mut beside) = (0, 0);
    for (x, y) in inside.filter(|(x, y)| covers(&ghost_alone, *x, *y)) {
        if covers(&alone, x, y) {
            shared += 1;
            assert_eq!(both.get_pixel(x, y), alone.get_pixel(x, y), "at {x}, {y}");
        } else if alone.get_pixel(x, y) == empty.get_pixel(x, y) {
            beside += u32::from(both.get_pixel(x, y) == ghost_alone.get_pixel(x, y));
        }
    }
    assert!(shared > 500 && beside > 500, "{shared} pixels of both, {beside} of the ghost");
}

#[test]
fn vertices_have_their_colours() {
    let [red, green] = [[255, 0, 0, 255], [0, 255, 0, 255]];
    let square = coloured_square(vec![SkinPart::white(2)], vec![red, red, green, green]);
    let picture = draw(&Scene::new(&square.at(0.0), &Overlays::default(), Theme::Dark));
    assert_eq!((channel_at(&picture, 0.6, -0.8), channel_at(&picture, -0.6, 0.8)), (0, 1));
}

#[test]
fn texels_below_the_cutoff_are_not_drawn() {
    // Opaque on the left, half as opaque on the right.
    let pixels: Vec<[u8; 4]> =
        (0..64).map(|at| [255, 0, 0, if at % 8 < 4 { 255 } else { 128 }]).collect();
    let texture = SkinTexture::new(Vec::new(), [8, 8]);
    texture.pixels(|_| Ok(pixels)).expect("pixels");
    let texture = Some(Shared::from(texture));
    let red_at = |alpha_cutoff: f32, x: f32| {
        let look = PartLook { alpha_cutoff, ..PartLook::default() };
        let part = SkinPart { texture: texture.clone(), look, ..SkinPart::white(2) };
        let picture =
            draw(&Scene::new(&square(vec![part]).at(0.0), &Overlays::default(), Theme::Dark));
        let (width, height) = (picture.width() as f32, picture.height() as f32);
        let [red, green, _, _] = picture
            .get_pixel((0.5 * width + 0.2 * height * x) as u32, (0.5 * height - 9.0) as u32)
            .0;
        red > green.saturating_mul(3)
    };
    assert_eq!([-0.6, 0.6].map(|x| red_at(0.4, x)), [true, true]);
    assert_eq!([-0.6, 0.6].map(|x| red_at(0.6, x)), [true, false]);
}

#[test]
fn parts_shine_where_the_texture_of_their_emission_tells() {
    let halves = || (0..64).map(|at| [if at % 8 < 4 { 255 } else { 0 }; 4]).collect();
    let texture = SkinTexture::new(Vec::new(), [8, 8]);
    texture.pixels(|_| Ok(halves())).expect("pixels");
    let broken = SkinTexture::new(b"no image".to_vec(), [8, 8]);
    let green = |texture: SkinTexture, x: f32| {
        let look = PartLook { emission: [0.0, 1.0, 0.0], ..PartLook::default() };
        let emission_texture = Some(Shared::from(texture));
        let black = SkinPart { colour: [0.0; 3], emission_texture, look, ..SkinPart::white(2) };
        let picture =
            draw(&Scene::new(&square(vec![black]).at(0.0), &Overlays::default(), Theme::Dark));
        let (width, height) = (picture.width() as f32, picture.height() as f32);
        let at = ((0.5 * width + 0.2 * height * x) as u32, (0.5 * height - 9.0) as u32);
        picture.get_pixel(at.0, at.1).0[1]
    };
    assert!(green(texture.clone(), -0.6) > 200 && green(texture, 0.6) < 60);
    assert!(green(broken, -0.6) < 60, "without its image it does not shine");

    // With coordinates of its own, mirrored, the emission shines on the other side.
    let mirrored = |texture: SkinTexture, x: f32| {
        let look = PartLook { emission: [0.0, 1.0, 0.0], ..PartLook::default() };
        let emission_texture = Some(Shared::from(texture));
        let black = SkinPart { colour: [0.0; 3], emission_texture, look, ..SkinPart::white(2) };
        let mut document = square(vec![black]);
        let skin = document.rig.skin.as_ref().and_then(|skin| skin.mesh_skin()).expect("a mesh");
        let FileMesh { mesh, parents, parts } = FileMesh::clone(skin.in_file().expect("a mesh"));
        let mut triangles = mesh.mesh().clone();
        let flipped = triangles.texture_coordinates.iter().map(|at| Vec2::new(1.0 - at.x, at.y));
        triangles.emission_coordinates = flipped.collect();
        let binds = vec![Affine3A::IDENTITY];
        let mesh = SkinnedMesh::new(triangles, mesh.weights().to_vec(), binds).expect("a mesh");
        let in_file = FileMesh { mesh, parents, parts };
        let joints = vec![Some(JointId::new(0))];
        let skin = MeshSkin::new(in_file.into(), None, joints, document.skeleton());
        document.rig.skin = Some(Skin::new(SkinSource::Mesh(skin)));
        let picture = draw(&Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark));
        let (width, height) = (picture.width() as f32, picture.height() as f32);
        let at = ((0.5 * width + 0.2 * height * x) as u32, (0.5 * height - 9.0) as u32);
        picture.get_pixel(at.0, at.1).0[1]
    };
    let again = SkinTexture::new(Vec::new(), [8, 8]);
    again.pixels(|_| Ok(halves())).expect("pixels");
    assert!(mirrored(again.clone(), 0.6) > 200 && mirrored(again, -0.6) < 60);
}

#[test]
fn each_part_has_its_colour_and_its_texture_the_right_way_up() {
    let part = |colour, texture| SkinPart { colour, texture, ..SkinPart::white(1) };
    // Red at the upper left, green at the upper right, blue below.
    let [red, green, blue] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    let pixels: Vec<[u8; 4]> = (0..64)
        .map(|at| {
            if at >= 32 {
                blue
            } else if at % 8 < 4 {
                red
            } else {
                green
            }
        })
        .collect();
    let texture = SkinTexture::new(Vec::new(), [8, 8]);
    texture.pixels(|_| Ok(pixels)).expect("pixels");
    let texture = Shared::from(texture);
    let textured =
        square(vec![part([1.0; 3], Some(texture.clone())), part([1.0; 3], Some(texture))]);
    let picture = draw(&Scene::new(&textured.at(0.0), &Overlays::default(), Theme::Dark));
    for (x, y, expected) in [(-0.6, 0.6, 0), (0.6, 0.6, 1), (-0.6, -0.6, 2), (0.6, -0.6, 2)] {
        assert_eq!(channel_at(&picture, x, y), expected, "at {x}, {y}");
    }
    let coloured = square(vec![part([1.0, 0.1, 0.1], None), part([0.1, 1.0, 0.1], None)]);
    let picture = draw(&Scene::new(&coloured.at(0.0), &Overlays::default(), Theme::Dark));
    assert_eq!((channel_at(&picture, 0.6, -0.6), channel_at(&picture, -0.6, 0.6)), (0, 1));
}
