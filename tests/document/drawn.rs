//! Parts of a skeleton in a scene: bones, shadows and onion skins.

use glam::{Vec2, Vec3};
use ik_arm::document::{Display, Document, Overlay, SkeletonRig, Skin, Target, Theme, Track};
use ik_arm::kinematics::skeleton::{Balance, Joint, JointId, Skeleton};
use ik_arm::scene::{Line, Palette, Scene, Shadow, Solid};
use ik_arm::session::{
    DisplayEdit, FileAction, Overlays, PanelTab, PlaybackAction, SelectAction, Session, ViewAction,
};

use crate::common::documents::{self, open_example};

/// A vertical chain of bones, two units long, with a target for its tip.
fn chain(bones: usize) -> Document {
    let mut skeleton = Skeleton::default();
    let length = 2.0 / bones as f32;
    let mut parent = None;
    for nth in 0..bones {
        let axis = Vec3::Y * length;
        let offset = if nth == 0 { Vec3::ZERO } else { axis };
        let joint = Joint { offset, radius: 0.02, ..Joint::new(&nth.to_string(), parent, axis) };
        parent = Some(skeleton.add(joint).expect("a joint"));
    }
    let mut document = Document::new(SkeletonRig::default());
    document.rig.skeleton = skeleton.into();
    document.rig.targets = vec![Target::new(JointId::new(bones - 1), Vec3::Y, 0.1)];
    document.display = Display::default().with(Overlay::Axes, false);
    document
}

fn scene(document: &Document) -> Scene {
    Scene::new(&document.at(0.0), &Overlays::default(), Theme::Dark)
}

#[test]
fn bones_of_a_long_chain_can_be_seen_beside_its_target() {
    for bones in [10, 50, 100, 400] {
        let scene = scene(&chain(bones));
        let palette = scene.palette;
        let is_limb = |colour| colour == palette.upper || colour == palette.lower;
        let solids = scene.solids.iter().filter(|it| is_limb(it.colour));
        let thinnest = solids.map(|it| it.shape.base_radius).fold(f32::MAX, f32::min);
        // A four hundredth of the reach: some two pixels in a picture of the chain 700 pixels high.
        assert!(thinnest >= 2.0 * 0.0025, "{bones}: {thinnest}");
        let target = scene.guide_balls.iter().map(|ball| ball.radius).fold(0.0, f32::max);
        assert!(target <= 2.0 * thinnest, "{bones}: {target} hides bones of {thinnest}");
        // No grey ball hides a bone between two others.
        let length = 2.0 / bones as f32;
        let hiding = scene.balls.iter().filter(|ball| !is_limb(ball.colour));
        let covered = hiding.map(|ball| ball.radius).fold(0.0, f32::max);
        assert!(covered <= 0.45 * length || bones >= 50, "{bones}: {covered}");
        if bones >= 100 {
            let between = |y: f32| y > 0.01 && y < 1.99;
            let grey = scene.balls.iter().filter(|it| !is_limb(it.colour) && between(it.centre.y));
            assert_eq!(grey.count(), 0, "{bones}: grey dots cover the bones");
        }
    }
}

#[test]
fn shadows_of_short_bones_do_not_add_up() {
    for bones in [10, 24, 100, 400] {
        let scene = scene(&chain(bones));
        assert!(scene.shadows.len() <= 26, "{bones}: {}", scene.shadows.len());
        let length: f32 = scene.shadows.iter().map(|it| it.base.distance(it.tip)).sum();
        assert!((length - 2.0).abs() < 1e-3, "{bones}: the shadows are {length} long");
    }
}

#[test]
fn a_hand_casts_one_shadow_that_ends_among_its_fingertips() {
    let mut session = Session::default();
    session.apply(open_example("human"));
    let document = session.shown();
    for has_skin in [true, false] {
        let mut document = document.clone();
        document.display = document.display.with(Overlay::Skin, has_skin);
        let posed = document.at(0.0);
        let scene = Scene::new(&posed, &Overlays::default(), Theme::Dark);
        let skeleton = posed.skeleton();
        for side in ["left", "right"] {
            let joint = |name: &str| skeleton.find(&format!("{side}_{name}")).expect("a joint");
            let wrist = skeleton.base(joint("hand"));
            let shadows: Vec<_> = scene.shadows.iter().filter(|it| it.base == wrist).collect();
            let [shadow] = shadows[..] else { panic!("{side}: {shadows:?}") };
            let fingers = ["thumb", "index", "middle", "ring", "little"];
            let tips = fingers.map(|finger| skeleton.tip(joint(&format!("{finger}_3"))));
            let [low, high] =
                [Vec3::min, Vec3::max].map(|bound| tips.into_iter().reduce(bound).expect("a tip"));
            assert!(shadow.tip.cmpge(low).all() && shadow.tip.cmple(high).all(), "{shadow:?}");
        }
        assert!(
            scene.shadows.len() <= 19,
            "{}: as many as before the fingers",
            scene.shadows.len()
        );
    }
}

#[test]
fn a_skin_stands_for_the_limbs_of_an_arm_and_colours_its_hand() {
    let mut document = Document::default();
    document.rig.skin = Some(Skin::from_bones(&document.rig.skeleton));
    let [bare, skinned, both] =
        [(false, true), (true, false), (true, true)].map(|(skin, bones)| {
            let display = document.display.with(Overlay::Skin, skin).with(Overlay::Bones, bones);
            scene(&Document { display, ..document.clone() })
        });
    assert_eq!([&bare, &skinned, &both].map(|it| it.solids.len()), [2, 0, 2]);
    assert_eq!([&bare, &skinned, &both].map(|it| it.skins.len()), [0, 1, 1]);
    assert_eq!(skinned.hands[0].colour, skinned.skins[0].colour);
    assert_eq!(skinned.shadows, bare.shadows);
}

#[test]
fn the_page_about_a_limb_colours_its_bones_alone() {
    let mut session = Session::default();
    session.apply(open_example("human"));
    session.apply(DisplayEdit::ShowOverlay(Overlay::Skin, false));
    // The start and the colour of each bone.
    let bones = |session: &Session| {
        let scene = Scene::new(session.posed(), &session.overlays(), Theme::Dark);
        let start = |solid: &Solid| solid.transform.transform_point3(Vec3::ZERO);
        scene.solids.iter().map(|solid| (start(solid), solid.colour)).collect::<Vec<_>>()
    };
    let palette = Palette::new(Theme::Dark);
    for (end, limb) in [
        ("right_hand", ["right_upper_arm", "right_forearm"]),
        ("left_foot", ["left_thigh", "left_shin"]),
    ] {
        let joint = |name: &str| session.skeleton().find(name).expect("a joint");
        let (end, limb) = (joint(end), limb.map(joint));
        session.apply(SelectAction::Joints(vec![end]));
        let bones = bones(&session);
        for (joint, colour) in limb.into_iter().zip([palette.upper, palette.lower]) {
            let coloured: Vec<_> = bones.iter().filter(|bone| bone.1 == colour).collect();
            let [(start, _)] = coloured[..] else { panic!("{} bones", coloured.len()) };
            assert!(start.distance(session.skeleton_pose().base(joint)) < 1e-5);
        }
    }
    session.apply(ViewAction::ShowTab(PanelTab::Race));
    let coloured = bones(&session).iter().filter(|bone| bone.1 == palette.upper).count();
    assert!(coloured > 10, "all bones have the limbs' colours: {coloured}");
}

#[test]
fn an_onion_skin_of_a_figure_is_its_skin_or_else_its_bones_with_hips() {
    let mut session = Session::default();
    session.apply(open_example("walk"));
    session.apply(PlaybackAction::SetTime(1.0));
    for has_skin in [true, false] {
        let mut document = session.shown().clone();
        document.display =
            document.display.with(Overlay::OnionSkins, true).with(Overlay::Skin, has_skin);
        let mut shown = Session::default();
        shown.apply(FileAction::Opened {
            document: Box::new(document),
            file: None,
            contents: None,
        });
        shown.apply(PlaybackAction::SetTime(1.0));
        let overlays = shown.overlays();
        let [.., skin] = &overlays.onion_skins[..] else { panic!("onion skins") };
        let scene = Scene::new(shown.posed(), &overlays, Theme::Dark);
        assert_eq!(skin.skin.is_some(), has_skin);
        let names = scene.labels.iter().map(|label| scene.text(label));
        let names: Vec<&str> = names.filter(|name| name.starts_with(['−', '+'])).collect();
        assert_eq!(names, ["−20 frames", "−10", "+10", "+20 frames"]);
        if has_skin {
            let [own, onion_skins @ ..] = &scene.skins[..] else { panic!("no skins") };
            assert_eq!(onion_skins.len(), overlays.onion_skins.len());
            assert!(onion_skins.iter().all(|it| it.mesh.is_same(&own.mesh) && it.pose != own.pose));
            assert!(onion_skins.iter().all(|it| (0.1..0.6).contains(&it.colour.channels()[3])));
            continue;
        }
        let skeleton = shown.skeleton();
        let joint = |name: &str| skeleton.find(name).expect("a joint");
        // The legs start beside the pelvis: a rod leads to each.
        let thigh = skin.pose.base(joint("left_thigh"));
        let hips = scene.solids.iter().filter(|it| {
            let tip = it.transform.transform_point3(Vec3::X * it.shape.length);
            tip.distance(thigh) < 1e-4
        });
        assert!(hips.count() >= 1, "nothing leads to the hip of an onion skin");
        let shin = skin.pose.base(joint("left_shin"));
        let broadest = scene.balls.iter().filter(|it| it.centre.distance(shin) < 1e-4);
        let broadest = broadest.map(|it| it.radius).fold(0.0, f32::max);
        // A stick, as they were, has 0.8 % of the reach.
        let stick = 0.008 * shown.rig().reach();
        assert!(broadest > 1.2 * stick, "the knee has {broadest}, a stick {stick}");
    }
}

#[test]
fn the_balance_is_drawn_as_it_is_and_told() {
    let mut document = documents::example("human");
    document.display = document.display.with(Overlay::Balance, true);
    let texts = |document: &Document| {
        let scene = scene(document);
        scene.labels.iter().map(|label| scene.text(label).to_owned()).collect::<Vec<_>>()
    };
    let balance = Balance::of(document.at(0.0).skeleton()).expect("a balance");
    let margin = balance.margin().expect("it stands");
    assert!(margin > 0.02, "the figure stands on both feet: {margin}");
    let told = format!("Balanced: {margin:.4} inside");
    assert!(texts(&document).contains(&told), "{:?} {told}", texts(&document));
    let scene = scene(&document);
    let guide = scene.palette.guide;
    for [from, to] in balance.edges() {
        let is_edge =
            |line: &&Line| [line.from, line.to].map(|it| Vec2::new(it.x, it.z)) == [from, to];
        let line = scene.lines.iter().find(is_edge).expect("an edge");
        assert_eq!(line.colour, guide);
    }
    assert!(scene.guide_balls.iter().any(|ball| ball.centre == balance.centre));

    // Without targets, the legs go where the pelvis goes: the figure is above the ground.
    document.rig.targets.clear();
    let skeleton = document.rig.skeleton.make_mut();
    skeleton.change(JointId::new(0), |pelvis| pelvis.offset.y += 0.5).expect("an offset");
    assert!(texts(&document).contains(&"Stands on nothing".to_owned()));
    lean(&mut document);
    assert!(texts(&document).iter().any(|text| text.starts_with("Tips over: ")));
}

/// Tilts the figure forward about its pelvis, with its feet at the ground.
fn lean(document: &mut Document) {
    let skeleton = document.rig.skeleton.make_mut();
    let tilted = |pelvis: &mut Joint| {
        pelvis.offset.y = 0.85;
        pelvis.rotation.x += 0.4;
    };
    skeleton.change(JointId::new(0), tilted).expect("a pelvis");
}

#[test]
fn a_trail_casts_a_shadow_in_one_piece_from_its_first_point_to_its_last() {
    for (name, shows) in [("keyframes", true), ("keyframes", false), ("arm", true)] {
        let mut document = documents::example(name);
        document.display = document.display.with(Overlay::Shadow, shows);
        let track = Track::new(&document);
        let posed = track.at(1.0);
        let overlays = Overlays::new(&track, &posed);
        let points: Vec<Vec3> = overlays.trail.points.iter().map(|(_, at)| *at).collect();
        let scene = Scene::new(&posed, &overlays, Theme::Dark);
        let is_of_trail = |it: &&Shadow| points.contains(&it.base) && points.contains(&it.tip);
        let cast: Vec<&Shadow> = scene.shadows.iter().filter(is_of_trail).collect();
        if !shows || name == "arm" {
            assert_eq!(cast.len(), 0, "{name}");
            continue;
        }
        assert!((20..=64).contains(&cast.len()), "{}", cast.len());
        assert!(cast.windows(2).all(|pair| pair[0].tip == pair[1].base));
        assert_eq!(Some(&cast[0].base), points.first());
        assert_eq!(Some(&cast[cast.len() - 1].tip), points.last());
    }
}

#[test]
fn a_trail_has_a_ball_at_each_key_and_what_is_far_is_fainter() {
    let document = documents::example("keyframes");
    let track = Track::new(&document);
    let (timeline, palette) = (document.timeline, Palette::new(Theme::Dark));
    let tip = |time: f64| {
        let posed = track.at(time);
        let target = posed.document().rig.sole_limb().expect("a limb");
        (time, posed.skeleton().tip(target.joint))
    };
    let keys: Vec<(f64, Vec3)> = document.keys.times().into_iter().map(tip).collect();
    assert!(keys.len() >= 5);
    for now in [timeline.start, 0.5 * timeline.end, timeline.end] {
        let posed = track.at(now);
        let overlays = Overlays::new(&track, &posed);
        assert_eq!(overlays.trail.keys, keys);
        let scene = Scene::new(&posed, &overlays, Theme::Dark);
        let is_shown = |(_, at): &(f64, Vec3)| {
            scene.balls.iter().any(|it| it.centre == *at && it.colour == palette.accent)
        };
        assert!(keys.iter().all(is_shown), "at {now} s");
        // The Pointer is longer than the way from one frame to the next.
        let short = || scene.guide_solids.iter().filter(|it| it.shape.length < 50.0);
        let (heads, tubes): (Vec<&Solid>, Vec<&Solid>) =
            short().partition(|it| it.shape.tip_radius == 0.0);
        assert_eq!(heads.len(), keys.len() - 1, "an arrowhead between two keys");
        assert_eq!(tubes.len() + 1, timeline.frames(), "a tube between two frames");
        let view = scene.camera.projection(1.0);
        let mut seen: Vec<(f32, u8)> = tubes
            .iter()
            .map(|it| (view.forward.dot(it.transform.translation.into()), it.colour.0[2]))
            .collect();
        seen.sort_by(|one, other| one.0.total_cmp(&other.0));
        assert!(seen.is_sorted_by(|near, far| near.1 >= far.1), "{seen:?}");
    }
}
