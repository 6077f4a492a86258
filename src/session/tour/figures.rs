//! Live numbers of the scene in the texts of the tour.

use crate::document::{Arm, Document};
use crate::kinematics::chain_ik::{Method, Status};
use crate::kinematics::soft_reach::SoftReach;
use crate::session::pops::Spike;
use crate::session::session::Session;
use crate::session::solver_run::SolverRun;

/// A number of the scene, as text; `None` while the scene does not have it.
type Figure = fn(&Session) -> Option<String>;

/// All figures by their names in the texts.
const FIGURES: [(&str, Figure); 26] = [
    ("elbow_to_hand", elbow_to_hand),
    ("hand", hand),
    ("upper", |session| Some(length(session, session.arm().bones.upper()))),
    ("lower", |session| Some(length(session, session.arm().bones.lower()))),
    ("distance", |session| Some(length(session, session.pose().distance))),
    ("elbow_angle", |session| Some(degrees(session.pose().elbow_angle()))),
    ("twist", |session| Some(degrees(session.arm().twist))),
    ("farthest", |session| Some(length(session, session.arm().reach_limits().outer))),
    ("nearest", |session| Some(length(session, session.arm().reach_limits().inner))),
    ("gap", |session| Some(length(session, gap(session)))),
    ("cursor_percent", cursor_percent),
    ("softness", softness),
    ("race", |session| Some(factor(race(session.arm())))),
    ("hard_race", |session| Some(factor(race(&hard(session.arm()))))),
    ("holonomy", |session| Some(degrees(session.transport_path().holonomy()))),
    ("shoulder_moved", shoulder_moved),
    ("fk_bow", |session| bow(session, 0.0)),
    ("ik_bow", |session| bow(session, 1.0)),
    ("angles", |session| Some(angles(session).to_string())),
    ("spare", |session| Some(angles(session).saturating_sub(3).to_string())),
    ("first", |session| fewest_iterations(session).map(|(method, _)| method.title().to_owned())),
    ("fewest", |session| fewest_iterations(session).map(|(_, count)| count.to_string())),
    ("last", |session| most_iterations(session).map(|(method, _)| method.title().to_owned())),
    ("most", |session| most_iterations(session).map(|(_, count)| count.to_string())),
    ("missed", |session| missed(session).map(|(name, _)| name)),
    ("miss", |session| missed(session).map(|(_, miss)| miss)),
];

/// Number of joint angles of the skeleton.
fn angles(session: &Session) -> usize {
    3 * session.skeleton().joints().len()
}

/// The text with the scene's numbers in place of their names in braces. A sentence with a number
/// that the scene does not have yet is left out.
pub fn filled(text: &str, session: &Session) -> String {
    let sentences = text.split_inclusive(". ").filter_map(|sentence| fill(sentence, session));
    sentences.collect::<String>().trim_end().to_owned()
}

fn fill(sentence: &str, session: &Session) -> Option<String> {
    let mut parts = sentence.split('{');
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once('}')?;
        filled += &figure(name, session)?;
        filled += rest;
    }
    Some(filled)
}

fn figure(name: &str, session: &Session) -> Option<String> {
    FIGURES.into_iter().find(|(known, _)| *known == name)?.1(session)
}

fn length(session: &Session, length: f32) -> String {
    session.arm().format_length(length)
}

fn degrees(angle: f32) -> String {
    format!("{:.0}°", angle.to_degrees() + 0.0)
}

/// A factor with two significant digits below 10, in whole numbers above.
fn factor(factor: f32) -> String {
    if factor < 9.95 { format!("{factor:.1}") } else { format!("{factor:.0}") }
}

/// The highest ratio of the elbow's move to the hand's in a pop.
fn elbow_to_hand(session: &Session) -> Option<String> {
    let spikes = session.pops().spikes();
    let highest = spikes.iter().map(|Spike { ratio, .. }| *ratio).reduce(f32::max)?;
    Some(factor(highest))
}

fn hand(session: &Session) -> Option<String> {
    let [x, y, z] = session.pose().hand.to_array().map(|value| length(session, value));
    Some(format!("({x}, {y}, {z})"))
}

fn gap(session: &Session) -> f32 {
    session.pose().hand.distance(session.arm().cursor_in_root())
}

fn cursor_percent(session: &Session) -> Option<String> {
    let arm = session.arm();
    let part = arm.cursor_in_root().length() / arm.bones.outer_limit();
    Some(format!("{:.1} %", 100.0 * part))
}

fn softness(session: &Session) -> Option<String> {
    let softness = session.arm().soft_reach.softness();
    (softness > 0.0).then(|| format!("{softness:.2}"))
}

/// The arm with hard limits.
fn hard(arm: &Arm) -> Arm {
    Arm { soft_reach: SoftReach::default(), ..*arm }
}

/// Distance that the elbow moves while the Cursor moves outwards, as a multiple of the Cursor's.
fn race(arm: &Arm) -> f32 {
    const STEP: f32 = 5e-4;
    let cursor = arm.cursor_in_root();
    let mut moved = *arm;
    moved.set_cursor(cursor * (1.0 + STEP));
    arm.pose().elbow.distance(moved.pose().elbow) / (STEP * cursor.length())
}

fn shoulder_moved(session: &Session) -> Option<String> {
    let start = session.tour()?.start();
    Some(length(session, session.arm().root.distance(start.arm.root)))
}

/// Largest distance of the hand's path from the straight line between its first key and its middle
/// one, at an influence of IK.
fn bow(session: &Session, influence: f32) -> Option<String> {
    const POINTS: u32 = 24;
    let document = session.document();
    let (from, to) = (document.timeline.start, 0.5 * document.timeline.end);
    let hand = |time: f64| {
        let Document { mut arm, .. } = document.evaluate(time);
        arm.influence = influence;
        arm.root + arm.pose().hand
    };
    let (first, last) = (hand(from), hand(to));
    let along = (last - first).try_normalize()?;
    let bows = (1..POINTS).map(|point| {
        let at = from + (to - from) * f64::from(point) / f64::from(POINTS);
        (hand(at) - first).reject_from_normalized(along).length()
    });
    Some(length(session, bows.fold(0.0, f32::max)))
}

/// The solvers of the race that have reached the target, each with its iterations.
fn racers(session: &Session) -> Option<impl Iterator<Item = (Method, u32)> + '_> {
    let race = session.comparison().filter(|race| !race.is_running())?;
    let reports = race.runs().map(SolverRun::report);
    let reached = reports.filter(|report| report.status == Status::Converged);
    Some(reached.map(|report| (report.method, report.iterations)))
}

fn fewest_iterations(session: &Session) -> Option<(Method, u32)> {
    racers(session)?.min_by_key(|(_, iterations)| *iterations)
}

fn most_iterations(session: &Session) -> Option<(Method, u32)> {
    racers(session)?.max_by_key(|(_, iterations)| *iterations)
}

/// Name of the end that misses its target most, and by how much.
fn missed(session: &Session) -> Option<(String, String)> {
    let (index, miss) = session.farthest_target()?;
    let rig = session.skeleton_rig();
    let end = rig.skeleton.joint(rig.end_of(&rig.targets[index]))?;
    (miss > session.solver_tolerance()).then(|| {
        let metres = session.document().metres_per_unit;
        let miss = match metres {
            Some(metres) => format!("{:.0} cm", 100.0 * metres * miss),
            None => format!("{miss:.2}"),
        };
        (format!("the {}", end.name.replace('_', " ")), miss)
    })
}
