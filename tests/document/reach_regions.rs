//! The reach region of the selected target: searched for in the background, shown while it is true.

use glam::Vec3;
use ik_arm::document::{BalanceTarget, Overlay};
use ik_arm::rig::ReachRegion;
use ik_arm::session::{
    DisplayEdit, PlaybackAction, ReachAction, SelectAction, Session, SolverEdit, TargetEdit,
    TransactionAction,
};
use pollster::block_on;

use crate::common::Random;
use crate::common::documents::{example, open_example};

const HANDS: [&str; 2] = ["left_hand", "right_hand"];
/// Index of the left hand among the targets of the Human.
const LEFT_HAND: usize = 1;

/// The Human with its left hand selected and reach regions shown.
fn session() -> Session {
    let mut session = Session::default();
    session.apply(open_example("human"));
    session.apply(DisplayEdit::ShowOverlay(Overlay::ReachRegion, true));
    select(&mut session, HANDS[0]);
    session
}

fn select(session: &mut Session, name: &str) {
    let joint = session.skeleton().find(name).expect("a joint");
    session.apply(SelectAction::Joints(vec![joint]));
}

/// Runs the search that the session wants.
fn search(session: &mut Session) {
    let job = session.next_reach_region().expect("a search");
    session.apply(ReachAction::Started(job.clone()));
    assert!(session.is_finding_reach_region() && session.next_reach_region().is_none());
    session.apply(block_on(job.run()));
    assert!(!session.is_finding_reach_region());
}

/// Moves the target of a hand.
fn move_target(session: &mut Session, name: &str, by: Vec3) {
    let joint = session.skeleton().find(name).expect("a joint");
    let index = session.rig().target_of_end(joint).expect("a target");
    let target = session.rig().targets[index];
    session.apply(TargetEdit::SetTarget(target.with_home(target.home + by)));
}

#[test]
fn the_region_of_the_selected_target_is_found_once_and_stays_while_it_is_true() {
    let mut session = session();
    assert!(session.reach_region().is_none());
    search(&mut session);
    let region = session.reach_region().expect("a region").clone();
    assert!(region.mesh.mesh.mesh().triangles.len() > 500);
    move_target(&mut session, HANDS[0], Vec3::new(0.1, 0.2, 0.1));
    assert_eq!(session.reach_region(), Some(&region), "it does not depend on the target's place");
    session.apply(SolverEdit::SetTracked(false));
    assert_eq!(session.reach_region(), Some(&region));
    move_target(&mut session, HANDS[1], Vec3::new(0.1, -0.2, 0.1));
    assert!(session.reach_region().is_none(), "the other hand holds the body elsewhere");
    session.apply(TransactionAction::Undo);
    assert_eq!(session.reach_region(), Some(&region));
    session.apply(SolverEdit::SetBodyFollows(false));
    assert!(session.reach_region().is_none() && session.next_reach_region().is_some());
    session.apply(DisplayEdit::ShowOverlay(Overlay::ReachRegion, false));
    assert!(session.next_reach_region().is_none(), "nothing is searched for that is hidden");
}

#[test]
fn nothing_is_searched_for_during_playback_and_for_joints_without_targets() {
    let mut session = session();
    session.apply(PlaybackAction::Play(true));
    assert!(session.next_reach_region().is_none());
    session.apply(PlaybackAction::Play(false));
    select(&mut session, "chest");
    assert!(session.next_reach_region().is_none());
    select(&mut session, "left_forearm");
    assert!(session.next_reach_region().is_some(), "a joint of a limb has its target's region");
}

#[test]
fn a_search_that_another_one_replaces_is_cancelled_and_its_result_forgotten() {
    let mut session = session();
    let job = session.next_reach_region().expect("a search");
    session.apply(ReachAction::Started(job.clone()));
    session.apply(SolverEdit::SetBalance(Some(BalanceTarget::default())));
    let other = session.next_reach_region().expect("another search");
    session.apply(ReachAction::Started(other));
    let ended = block_on(job.run());
    assert!(matches!(&ended, ReachAction::Ended(_, None)), "it was cancelled");
    session.apply(ended);
    assert!(session.is_finding_reach_region(), "the other one goes on");
}

/// Places on a grid from the hip to above the head, in front of the Human and beside it.
fn grid() -> impl Iterator<Item = Vec3> {
    let steps = |count: u8, from: f32, to: f32| {
        (0..count).map(move |at| from + (to - from) * f32::from(at) / f32::from(count - 1))
    };
    steps(5, 0.85, 1.95).flat_map(move |y| {
        steps(8, -0.3, 0.9).flat_map(move |x| steps(5, 0.0, 0.9).map(move |z| Vec3::new(x, y, z)))
    })
}

#[test]
fn the_human_reaches_the_places_of_its_region_with_its_feet_planted_and_balanced() {
    let mut random = Random(9);
    for balance in [None, Some(BalanceTarget::default())] {
        let mut document = example("human");
        document.rig.balance = balance;
        let region = ReachRegion::of(&document.rig, LEFT_HAND, 0.0).expect("a region");
        let (mut inside, mut places) = (0, 0);
        for place in grid() {
            places += 1;
            let is_in = region.contains(place);
            let mut near = (0..30).map(|_| place + random.direction() * region.cell());
            let is_clear = near.all(|it| region.contains(it) == is_in);
            document.rig.targets[LEFT_HAND].home = place;
            let posed = document.at(0.0);
            let errors: Vec<f32> = posed.targets().iter().map(|target| target.error).collect();
            let feet = errors[2].max(errors[3]);
            assert!(feet < 1e-4, "{place}: the feet are off by {feet}");
            if is_clear && is_in {
                inside += 1;
                assert!(
                    errors[LEFT_HAND] < 1e-3,
                    "{place}: the hand is off by {}",
                    errors[LEFT_HAND]
                );
                let evaluated = posed.evaluated_skeleton();
                assert!(document.rig.is_balanced(evaluated), "{place}: {:?}", evaluated.balance);
            }
        }
        assert!(places == 200 && inside > 60, "{inside} of {places} are clearly inside");
    }
}
