//! Pictures of the singularities of twist references, of twisting limbs, and of a hand, compared
//! with the ones kept in `tests/golden`; and numbers read off such pictures.
//!
//! `UPDATE_GOLDEN=1 cargo test --test render` keeps the new ones; look at them before
//! committing.

use crate::common::arm::Arm;
use glam::{Affine3A, DVec3, Mat3, Vec2, Vec3};
use ik_arm::document::{AxisView, Camera, Display, Document, Overlay, Theme};
use ik_arm::kinematics::skin::TriangleMesh;
use ik_arm::kinematics::twist::{Stereographic, TwistReference};
use ik_arm::kinematics::two_bone::Pointer;
use ik_arm::render::PictureRenderer;
use ik_arm::rig::TaperedCylinder;
use ik_arm::scene::{Colour, Globe, Hand, Label, Palette, Scene, Shadow, Solid, hand_mesh};
use ik_arm::session::Overlays;
use image::RgbaImage;
use pollster::block_on;

use crate::pictures::{GPU, check, compare, draw, kept};

const POLE: Vec3 = Vec3::new(180.0, 260.0, 200.0);

fn scene(document: &Document, theme: Theme) -> Scene {
    Scene::new(&document.at(0.0), &Overlays::default(), theme)
}

fn globe(reference: TwistReference) -> Globe {
    let arm = Arm::default();
    Globe { centre: arm.root, radius: arm.bones.outer_limit(), reference, axes: Mat3::IDENTITY }
}

fn globe_scene(reference: TwistReference, theme: Theme) -> Scene {
    let mut document = Document::default();
    document.camera = Camera { target: Vec3::ZERO, distance: 1650.0, ..document.camera };
    let mut scene = scene(&document, theme);
    scene.add_globe(globe(reference));
    scene
}

fn references() -> [(&'static str, TwistReference); 3] {
    [
        ("up", TwistReference::Up),
        ("pole", TwistReference::Pole(POLE)),
        ("stereographic", TwistReference::Stereographic(Stereographic::default())),
    ]
}

#[test]
fn the_globe_of_each_reference_in_both_themes() {
    for (name, reference) in references() {
        check(&format!("globe_{name}"), &globe_scene(reference, Theme::Dark));
        check(&format!("globe_{name}-light"), &globe_scene(reference, Theme::Light));
    }
}

#[test]
fn the_globe_seen_from_inside() {
    let mut inside =
        globe_scene(TwistReference::Stereographic(Stereographic::default()), Theme::Dark);
    let target = Vec3::NEG_X * globe(TwistReference::Up).radius;
    inside.camera = Camera { target, yaw: 1.8, pitch: 0.2, distance: 430.0, ..inside.camera };
    let eye = inside.camera.projection(1.0).eye;
    assert!(eye.distance(Vec3::ZERO) < globe(TwistReference::Up).radius);
    check("globe_inside", &inside);
}

#[test]
fn another_reference_is_another_globe() {
    for (name, reference) in references() {
        for (other, another) in references() {
            let drawn = draw(&globe_scene(another, Theme::Dark));
            let same = compare(&drawn, &kept(&format!("globe_{name}"))).is_ok();
            assert_eq!(same, reference == another, "{name} and {other}");
        }
    }
}

/// Nothing but a globe before an empty sky.
fn bare(globe: Globe, theme: Theme, camera: Camera) -> Scene {
    let display = Overlay::all().fold(Display::default(), |all, one| all.with(one, false));
    let mut scene = scene(&Document { display, camera, ..Document::default() }, theme);
    scene.solids.clear();
    scene.balls.clear();
    scene.globe = Some(globe);
    scene
}

fn picture(scene: &Scene, side: u32) -> RgbaImage {
    let gpu = GPU.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    block_on(PictureRenderer::new(&gpu, side, side, 1.0).draw(scene)).expect("drawn")
}

/// The far side of a globe, or the near one, at a place of a picture.
struct GlobeSide {
    gain: f64,
    /// Opacity that is added to that of the gain's colour, and the part of both that is seen.
    rim: f64,
    share: f64,
}

/// The far side and, if it is in front of the camera, the near one at a place of a picture in pixels;
/// `None` towards the rim, where lines are dense.
fn sides(scene: &Scene, at: Vec2, side: u32) -> Option<Vec<GlobeSide>> {
    const NEAR_OPACITY: f64 = 0.45;
    const RIM_OPACITY: f64 = 0.24;
    let globe = scene.globe?;
    let (radius, centre) = (f64::from(globe.radius), globe.centre.as_dvec3());
    let from_middle = at / side as f32 * 2.0 - 1.0;
    let ray = scene.camera.projection(1.0).ray(from_middle * Vec2::new(1.0, -1.0));
    let (origin, direction) =
        (ray.origin.as_dvec3() - centre, ray.direction.as_dvec3().normalize());
    let middle = -origin.dot(direction);
    let half = (radius * radius - (origin + direction * middle).length_squared()).sqrt();
    (half > 0.65 * radius).then_some(())?;
    let near_is_seen = middle > half || scene.camera.orthographic;
    let sides = [(middle + half, 1.0), (middle - half, NEAR_OPACITY)];
    let sides = sides.into_iter().take(1 + usize::from(near_is_seen));
    let gain = |along: f64| gain(globe.reference, (origin + direction * along) / radius);
    let rim = RIM_OPACITY * (1.0 - half / radius).powi(5);
    Some(sides.map(|(along, share)| GlobeSide { gain: gain(along), rim, share }).collect())
}

/// Expected colours of a pixel of the globe, if no line is near: the ramp's for the library's own gain
/// where the far and the near side are met, laid over the sky.
fn expected(scene: &Scene, (x, y): (u32, u32), side: u32, sky: [f64; 3]) -> Option<[f64; 3]> {
    /// Pixels from a line, which reaches 1.15 pixels, within which it may be seen.
    const LINE: f64 = 1.6;
    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    let here = sides(scene, at, side)?;
    // The GPU takes the slope from either neighbour.
    let beside = [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y];
    let beside = beside.map(|by| sides(scene, at + by, side));
    let mut colour = sky;
    for (index, GlobeSide { gain, rim, share }) in here.into_iter().enumerate() {
        let level = gain.ln_1p();
        let step =
            |of: &Option<Vec<GlobeSide>>| Some((of.as_ref()?[index].gain.ln_1p() - level).abs());
        let [right, left, below, above] = beside.each_ref().map(step);
        let steep = right?.max(left?) + below?.max(above?);
        let off = |line: f64| (level - line.ln_1p()).abs();
        [1.0, 2.0, 5.0].into_iter().all(|line| off(line) > LINE * steep).then_some(())?;
        let [r, g, b, a] = scene.palette.gain(gain as f32).channels().map(f64::from);
        let a = (a + rim) * share;
        colour = [0, 1, 2].map(|channel| colour[channel] * (1.0 - a) + [r, g, b][channel] * a);
    }
    Some(colour)
}

fn gain(reference: TwistReference, direction: DVec3) -> f64 {
    let pointer = Pointer::towards(direction.as_vec3(), Pointer::default());
    f64::from(reference.gain(pointer))
}

#[test]
fn every_pixel_of_a_globe_has_the_colour_of_its_gain() {
    const SIDE: u32 = 240;
    const STEP: usize = 2;
    const OFF: f64 = 2.5 / 255.0;
    let tilted = Stereographic::new(Vec3::new(0.4, 0.8, 0.7), Vec3::Y).expect("a map");
    let references = [
        TwistReference::Up,
        TwistReference::Pole(Vec3::new(-0.3, 0.2, 0.9) * 300.0),
        TwistReference::Stereographic(tilted),
        TwistReference::Transport,
    ];
    let outside =
        Camera { target: Vec3::ZERO, yaw: 0.5, pitch: 0.9, distance: 1700.0, orthographic: false };
    let cameras = [
        outside,
        Camera { orthographic: true, ..outside },
        Camera { distance: 60.0, pitch: -0.6, ..outside },
    ];
    for (reference, camera, theme) in references.into_iter().flat_map(|reference| {
        cameras.into_iter().flat_map(move |camera| {
            [Theme::Dark, Theme::Light].map(|theme| (reference, camera, theme))
        })
    }) {
        let globe = Globe { centre: Vec3::new(20.0, -30.0, 10.0), ..globe(reference) };
        let scene = bare(globe, theme, camera);
        let drawn = picture(&scene, SIDE);
        let mut without = scene.clone();
        without.globe = None;
        let sky = picture(&without, SIDE);
        let mut compared = 0;
        for (x, y, pixel) in drawn.enumerate_pixels().step_by(STEP) {
            let screen = |pixel: &image::Rgba<u8>| {
                [0, 1, 2].map(|channel| f64::from(pixel.0[channel]) / 255.0)
            };
            let Some(expected) = expected(&scene, (x, y), SIDE, screen(sky.get_pixel(x, y))) else {
                continue;
            };
            let seen = screen(pixel);
            let off = [0, 1, 2].map(|channel| (seen[channel] - expected[channel]).abs());
            assert!(
                off.iter().all(|off| *off < OFF),
                "{reference:?} {camera:?} {theme:?} at {x}, {y}: {seen:?}, not {expected:?}"
            );
            compared += 1;
        }
        assert!(compared > 500, "{reference:?}: only {compared} pixels");
    }
}

#[test]
fn an_invalid_pole_is_drawn_as_the_globe_of_transport() {
    let camera = Camera { distance: 1700.0, ..Document::default().camera };
    let calm = picture(&bare(globe(TwistReference::Transport), Theme::Dark, camera), 200);
    for pole in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let pole = globe(TwistReference::Pole(pole));
        assert_eq!(picture(&bare(pole, Theme::Dark, camera), 200), calm);
    }
}

#[test]
fn a_globe_without_a_size_is_not_drawn() {
    let plain = scene(&Document::default(), Theme::Dark);
    for (centre, radius) in [
        (Vec3::ZERO, 0.0),
        (Vec3::ZERO, -1.0),
        (Vec3::ZERO, f32::NAN),
        (Vec3::ZERO, f32::INFINITY),
        (Vec3::NAN, 1.0),
    ] {
        let globe = Globe { centre, radius, reference: TwistReference::Up, axes: Mat3::IDENTITY };
        let mut with = plain.clone();
        with.add_globe(globe);
        assert_eq!(with, plain, "{globe:?}");
        with.globe = Some(globe);
        let drawn = draw(&with);
        assert_eq!(drawn, draw(&plain), "{globe:?}");
    }
}

#[test]
fn every_singular_direction_is_marked_on_the_globe() {
    let expected = [
        (TwistReference::Up, vec![Vec3::Y, Vec3::NEG_Y]),
        (TwistReference::Pole(Vec3::X * 30.0), vec![Vec3::X, Vec3::NEG_X]),
        (TwistReference::Pole(Vec3::X * 1e-30), vec![Vec3::X, Vec3::NEG_X]),
        (TwistReference::Pole(Vec3::X * 1e30), vec![Vec3::X, Vec3::NEG_X]),
        (TwistReference::Pole(Vec3::ZERO), vec![]),
        (TwistReference::Stereographic(Stereographic::default()), vec![Vec3::NEG_X]),
        (TwistReference::Transport, vec![]),
    ];
    for (reference, directions) in expected {
        let mut marked = scene(&Document::default(), Theme::Dark);
        let before = (marked.balls.len(), marked.labels.len());
        let globe = Globe {
            centre: Vec3::new(1.0, 2.0, 3.0),
            radius: 100.0,
            reference,
            axes: Mat3::IDENTITY,
        };
        marked.add_globe(globe);
        assert_eq!(marked.globe, Some(globe));
        let places: Vec<_> = directions.iter().map(|way| globe.centre + way * 100.0).collect();
        let balls: Vec<_> = marked.balls[before.0..].iter().map(|ball| ball.centre).collect();
        let is_name = |label: &&Label| marked.text(label).starts_with("Elbow spins");
        let labels = marked.labels[before.1..].iter();
        let (names, numbers): (Vec<&Label>, Vec<&Label>) = labels.partition(is_name);
        let names: Vec<_> = names.iter().map(|label| label.at).collect();
        assert_eq!((&balls, &names), (&places, &places), "{reference:?}");
        assert_eq!(numbers.len(), 3 * places.len(), "{reference:?}");
        for label in numbers {
            let way = (label.at - globe.centre).as_dvec3();
            let shown: f64 = marked.text(label).trim_end_matches('×').parse().expect("a number");
            assert!((way.length() - 100.0).abs() < 1e-3, "{reference:?}: {way}");
            let off = gain(reference, way.normalize()) / shown - 1.0;
            assert!(off.abs() < 1e-4, "{reference:?}: {shown} is off by {off}");
        }
        assert!(directions.iter().all(|way| gain(reference, way.as_dvec3()) > 1e6));
    }
}

/// Lightness as people see it: L of Oklab.
fn lightness(colour: [f32; 4]) -> f32 {
    let light = |c: f32| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    let [r, g, b, _] = colour.map(light);
    let l = 0.412_22 * r + 0.536_33 * g + 0.051_45 * b;
    let m = 0.211_90 * r + 0.680_70 * g + 0.107_40 * b;
    let s = 0.088_30 * r + 0.281_72 * g + 0.629_98 * b;
    0.210_45 * l.cbrt() + 0.793_62 * m.cbrt() - 0.004_07 * s.cbrt()
}

#[test]
fn the_colours_of_gains_rise_in_contrast() {
    for theme in [Theme::Dark, Theme::Light] {
        let palette = Palette::new(theme);
        let background = lightness(palette.sky_bottom.mixed(palette.sky_top, 0.5).channels());
        let ramp: Vec<_> = (0..=40)
            .map(|step| palette.gain(((step as f32 / 40.0) * Palette::MAX_GAIN.ln_1p()).exp_m1()))
            .collect();
        let contrast = |colour: &Colour| {
            (lightness(colour.channels()) - background).abs() * colour.channels()[3]
        };
        let contrasts: Vec<_> = ramp.iter().map(contrast).collect();
        assert!(contrasts.windows(2).all(|pair| pair[1] > pair[0]), "{theme:?}: {contrasts:?}");
        assert_eq!(palette.gain(0.0), palette.gains[0]);
        assert_eq!(palette.gain(f32::NAN), palette.gains[0]);
        for hot in [Palette::MAX_GAIN, 100.0, f32::INFINITY] {
            assert_eq!(palette.gain(hot), palette.gains[Palette::GAINS - 1]);
        }
    }
}

/// The default arm, without its hand, with a lower limb that winds, from near.
fn winding(lower: Option<f32>) -> Scene {
    let mut document = Document::default();
    document.camera = Camera { distance: 460.0, ..document.camera };
    document.display = document.display.with(Overlay::Hand, false);
    let mut scene = scene(&document, Theme::Dark);
    let colour = scene.palette.lower;
    let limbs = scene.solids.iter_mut().filter(|solid| solid.colour == colour);
    assert_eq!(limbs.map(|limb| limb.winding = lower).count(), 1);
    scene
}

#[test]
fn a_lower_limb_that_winds() {
    let turn = 270_f32.to_radians();
    check("winding", &winding(Some(turn)));
    for other in [Some(0.0), Some(-turn), None] {
        let drawn = draw(&winding(other));
        assert!(compare(&drawn, &kept("winding")).is_err(), "{other:?}");
    }
    for no_angle in [f32::NAN, f32::INFINITY] {
        assert_eq!(draw(&winding(Some(no_angle))), draw(&winding(None)));
    }
}

/// Half of the height of a round rectangle of the radius 1 across and 0.66 through, with the power
/// 3.2, whose thin axis is turned from the vertical by an angle.
fn half_height(along: f32, angle: f32) -> f32 {
    let shape = along * along * (3.0 - 2.0 * along);
    let (thin, power) = (1.0 - 0.34 * shape, 2.0 + 1.2 * shape);
    let points = (0..720).map(|nth| (nth as f32 * 0.5).to_radians());
    let heights = points.map(|turn| {
        let (sine, cosine) = turn.sin_cos();
        let size = (cosine.abs().powf(power) + sine.abs().powf(power)).powf(-1.0 / power);
        thin * size * cosine * angle.cos() - size * sine * angle.sin()
    });
    heights.fold(0.0, f32::max)
}

/// From the front a section is as high as its thin axis is turned away from the vertical.
#[test]
fn limbs_wind_right_handed_from_base_to_tip() {
    const SIDE: u32 = 400;
    const RADIUS: f32 = 60.0;
    let (transform, shape) =
        TaperedCylinder::between(Vec3::NEG_X * 100.0, Vec3::X * 100.0, RADIUS, RADIUS);
    for (start, winding) in [(0.6, 90_f32), (0.6, -90.0), (-0.3, 250.0)] {
        let (start, winding) = (start as f32, winding.to_radians());
        let transform = Affine3A { matrix3: glam::Mat3A::from_rotation_x(start), ..transform };
        let camera = Camera {
            target: Vec3::ZERO,
            distance: 400.0,
            orthographic: true,
            ..Document::default().camera
        };
        let mut scene =
            bare(globe(TwistReference::Transport), Theme::Light, camera.along(AxisView::Front));
        scene.globe = None;
        let empty = picture(&scene, SIDE);
        let colour = Colour([60, 60, 60, 255]);
        scene.solids.push(Solid { transform, shape, colour, winding: Some(winding) });
        let drawn = picture(&scene, SIDE);
        let projection = scene.camera.projection(1.0);
        let pixels = SIDE as f32 / 2.0 / projection.half_height_at(Vec3::ZERO);
        for step in 2..49 {
            let along = step as f32 / 50.0;
            let at = projection.project(Vec3::new(200.0 * along - 100.0, 0.0, 0.0)).expect("seen");
            let column = ((at.x * 0.5 + 0.5) * SIDE as f32) as u32;
            let is_drawn =
                |row: &u32| drawn.get_pixel(column, *row) != empty.get_pixel(column, *row);
            let height = (0..SIDE).filter(is_drawn).count() as f32;
            let expected = 2.0 * RADIUS * pixels * half_height(along, start + winding * along);
            assert!(
                (height - expected).abs() < 4.0,
                "at {along} of {winding}: {height}, {expected}"
            );
        }
    }
}

/// Brightness of the floor in a row of pixels under limbs that lie along x, from above.
fn floor_under(limbs: &[[f32; 2]]) -> Vec<f32> {
    const SIDE: u32 = 200;
    let camera = Camera {
        target: Vec3::ZERO,
        distance: 600.0,
        orthographic: true,
        ..Document::default().camera
    };
    let document = Document {
        display: Display::from_iter([Overlay::Ground]),
        camera: camera.along(AxisView::Top),
        ..Document::default()
    };
    let mut scene = scene(&document, Theme::Light);
    let limb = |[from, to]: &[f32; 2]| {
        let [base, tip] = [*from, *to].map(|x| Vec3::new(x, 40.0, 20.0));
        Shadow { base, base_radius: 12.0, tip, tip_radius: 12.0 }
    };
    scene.shadows = limbs.iter().map(limb).collect();
    let drawn = picture(&scene, SIDE);
    (0..SIDE).map(|column| f32::from(drawn.get_pixel(column, SIDE / 2).0[1])).collect()
}

#[test]
fn limbs_in_a_row_cast_the_shadow_of_one_limb_without_beads() {
    let bare = floor_under(&[]);
    let shade = |limbs: &[[f32; 2]]| -> Vec<f32> {
        floor_under(limbs).iter().zip(&bare).map(|(shaded, bare)| bare - shaded).collect()
    };
    let one = shade(&[[-120.0, 120.0]]);
    let darkest = one.iter().copied().fold(0.0, f32::max);
    assert!(darkest > 30.0, "{darkest}");
    for parts in [2_u8, 5, 12] {
        let end = |nth: u8| 240.0 * f32::from(nth) / f32::from(parts) - 120.0;
        let row: Vec<[f32; 2]> = (0..parts).map(|nth| [end(nth), end(nth + 1)]).collect();
        for (column, (several, one)) in shade(&row).iter().zip(&one).enumerate() {
            let off = several - one;
            assert!((-0.3 * darkest..=2.0).contains(&off), "{parts} at {column}: {several}, {one}");
        }
    }
}

/// A hand held up before an empty sky, its palm to the front.
fn hand(theme: Theme, yaw: f32) -> Scene {
    let camera = Camera {
        target: Vec3::new(3.0, 46.0, 0.0),
        yaw,
        pitch: 0.15,
        distance: 185.0,
        orthographic: false,
    };
    let mut scene = bare(globe(TwistReference::Transport), theme, camera);
    scene.globe = None;
    let colour = scene.palette.joint;
    let held_up = Mat3::from_cols(Vec3::Y, Vec3::NEG_Z, Vec3::NEG_X);
    scene.hands.push(Hand { transform: Affine3A::from_mat3(held_up), size: 100.0, colour });
    scene
}

#[test]
fn a_hand_from_its_palm_and_from_its_back() {
    check("hand", &hand(Theme::Dark, 0.35));
    check("hand_back-light", &hand(Theme::Light, 3.6));
}

#[test]
fn a_hand_is_one_closed_body_of_length_1_with_the_thumb_of_a_right_hand() {
    let mesh = hand_mesh();
    let mut edges = std::collections::HashMap::new();
    for [a, b, c] in &mesh.triangles {
        for edge in [[a, b], [b, c], [c, a]] {
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    let is_closed = |[from, to]: &[&u32; 2]| edges.get(&[*to, *from]) == Some(&1);
    assert!(!edges.is_empty() && edges.keys().all(is_closed));
    assert!(edges.values().all(|count| *count == 1));
    assert!((1_000..20_000).contains(&mesh.positions.len()), "{}", mesh.positions.len());
    let greatest =
        |of: &dyn Fn(&Vec3) -> f32| mesh.positions.iter().map(of).fold(f32::MIN, f32::max);
    let longest = greatest(&|at| at.length());
    assert!((longest - 1.0).abs() < 0.02, "{longest}");
    assert!(greatest(&|at| -at.z) > 1.3 * greatest(&|at| at.z), "the thumb is at −z");
    let furthest = mesh.positions.iter().max_by(|a, b| a.x.total_cmp(&b.x)).expect("vertices");
    assert!(furthest.y < 0.0, "fingers bend towards the palm, at −y");
    // A plane across the fingers cuts each of them apart.
    let cuts = cuts_at(&mesh, 0.68);
    assert_eq!(cuts, 4, "fingers");
}

/// Number of closed curves in which a plane across x cuts a mesh.
fn cuts_at(mesh: &TriangleMesh, x: f32) -> usize {
    let is_beyond = |vertex: u32| mesh.positions[vertex as usize].x > x;
    let mut group: Vec<usize> = (0..mesh.triangles.len()).collect();
    fn root(group: &mut [usize], mut at: usize) -> usize {
        while group[at] != at {
            group[at] = group[group[at]];
            at = group[at];
        }
        at
    }
    let is_cut = |corners: &[u32; 3]| {
        let beyond = corners.iter().filter(|corner| is_beyond(**corner)).count();
        beyond == 1 || beyond == 2
    };
    let mut of_edge = std::collections::HashMap::new();
    for (index, corners) in mesh.triangles.iter().enumerate().filter(|(_, it)| is_cut(it)) {
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
            if is_beyond(from) != is_beyond(to) {
                let other = *of_edge.entry([from.min(to), from.max(to)]).or_insert(index);
                let (one, other) = (root(&mut group, index), root(&mut group, other));
                group[one] = other;
            }
        }
    }
    let cut: Vec<usize> =
        (0..mesh.triangles.len()).filter(|it| is_cut(&mesh.triangles[*it])).collect();
    let roots: std::collections::HashSet<usize> =
        cut.into_iter().map(|index| root(&mut group, index)).collect();
    roots.len()
}
