//! Live numbers of the scene in the texts of the tour.

use glam::Vec3;

use crate::document::{LengthFormat, Track};
use crate::kinematics::chain_ik::{Method, Status};
use crate::kinematics::ik::{Ik, IkState};
use crate::kinematics::pop::ElbowStep;
use crate::kinematics::soft_reach::SoftReach;
use crate::rig::{LimbFrames, LimbPart};
use crate::session::limb::ShownLimb;
use crate::session::pops::{PopSampleKind, Spike};
use crate::session::session::Session;
use crate::session::solver::run::SolverRun;
use crate::session::solver::status::farthest_target;

/// A number of the scene, as text; `None` while the scene does not have it.
type Figure = fn(&Session) -> Option<String>;

/// All figures by their names in the texts.
const FIGURES: [(&str, Figure); 33] = [
    ("elbow_to_hand", |session| Some(factor(highest_spike(session)?.ratio))),
    ("elbow_step", |session| Some(whole(elbow_step(session)?))),
    ("hand_step", |session| Some(whole(elbow_step(session)? / highest_spike(session)?.ratio))),
    ("hand", hand),
    ("upper", |session| Some(length(session, limb(session)?.bones().upper()))),
    ("lower", |session| Some(length(session, limb(session)?.bones().lower()))),
    ("distance", |session| Some(length(session, limb(session)?.pose().distance))),
    ("elbow_angle", |session| Some(degrees(limb(session)?.pose().elbow_angle()))),
    ("twist", |session| Some(degrees(limb(session)?.posed.twist))),
    ("farthest", |session| Some(length(session, limb(session)?.limits.outer))),
    ("nearest", |session| Some(length(session, limb(session)?.limits.inner))),
    ("gap", |session| Some(length(session, gap(limb(session)?)))),
    ("sum", |session| Some(length(session, limb(session)?.bones().outer_limit()))),
    ("cursor_at_start", cursor_at_start),
    ("softness", softness),
    ("race", |session| Some(factor(race(limb(session)?.posed.ik, cursor_of_start(session)?)))),
    ("hard_race", |session| Some(factor(race(hard(limb(session)?), cursor_of_start(session)?)))),
    ("soft_gap", soft_gap),
    ("holonomy", |session| Some(degrees(session.evaluated().transport_path()?.holonomy()))),
    ("shoulder_moved", shoulder_moved),
    ("fk_bow", |session| bow(session, 0.0)),
    ("ik_bow", |session| bow(session, 1.0)),
    ("angles", |session| Some(angles(session).to_string())),
    ("spare", |session| Some(angles(session).saturating_sub(3).to_string())),
    ("first", |session| fewest_iterations(session).map(|(method, _)| method.title().to_owned())),
    ("fewest", |session| fewest_iterations(session).map(|(_, count)| count.to_string())),
    ("last", |session| most_iterations(session).map(|(method, _)| method.title().to_owned())),
    ("most", |session| most_iterations(session).map(|(_, count)| count.to_string())),
    ("two_bone_miss", two_bone_miss),
    ("missed", |session| missed(session).map(|(name, _)| name)),
    ("miss", |session| missed(session).map(|(_, miss)| miss)),
    ("chest_moved", |session| joint_moved(session, "chest")),
    ("pelvis_moved", |session| joint_moved(session, "pelvis")),
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
    limb(session).map_or(String::new(), |limb| LengthFormat::of_limb(limb.bones()).show(length))
}

fn degrees(angle: f32) -> String {
    format!("{:.0}°", angle.to_degrees() + 0.0)
}

/// A factor with two significant digits below 10, in whole numbers above.
fn factor(factor: f32) -> String {
    if factor < 9.95 { format!("{factor:.1}") } else { format!("{factor:.0}") }
}

/// A length to whole units.
fn whole(length: f32) -> String {
    format!("{length:.0}")
}

/// The pop with the highest ratio of the elbow's move to the hand's.
fn highest_spike(session: &Session) -> Option<Spike> {
    session
        .evaluated()
        .pops()
        .spikes()
        .into_iter()
        .max_by(|one, other| one.ratio.total_cmp(&other.ratio))
}

/// Distance that the elbow moved in the highest pop.
fn elbow_step(session: &Session) -> Option<f32> {
    let sample = session.evaluated().pops().samples().nth(highest_spike(session)?.at)?;
    match sample.kind {
        PopSampleKind::Step(ElbowStep { turn, bend, swing, .. }) => {
            Some((turn + bend + swing).length())
        }
        PopSampleKind::Change(_) => None,
    }
}

fn hand(session: &Session) -> Option<String> {
    let [x, y, z] = limb(session)?.pose().hand.to_array().map(|value| length(session, value));
    Some(format!("({x}, {y}, {z})"))
}

/// The shown limb.
fn limb(session: &Session) -> Option<&LimbFrames> {
    session.limb().map(|limb| &limb.frames)
}

fn gap(limb: &LimbFrames) -> f32 {
    limb.pose().hand.distance(limb.posed.cursor)
}

/// The first limb as the step began.
fn start(session: &Session) -> Option<LimbFrames> {
    let start = session.tour()?.start();
    ShownLimb::frames(&start.at(start.timeline.start), None)
}

/// The Cursor as the step began, in Root space.
fn cursor_of_start(session: &Session) -> Option<Vec3> {
    Some(start(session)?.posed.cursor)
}

fn cursor_at_start(session: &Session) -> Option<String> {
    Some(length(session, cursor_of_start(session)?.length()))
}

/// Distance of the hand from the Cursor as the step began, with the present soft limits.
fn soft_gap(session: &Session) -> Option<String> {
    let (ik, cursor) = (limb(session)?.posed.ik, cursor_of_start(session)?);
    let hand = ik.solve(cursor, 0.0, IkState::default()).pose.hand;
    Some(length(session, hand.distance(cursor)))
}

fn softness(session: &Session) -> Option<String> {
    let softness = limb(session)?.posed.ik.soft_reach.softness();
    (softness > 0.0).then(|| format!("{softness:.2}"))
}

/// The solver of a limb with hard limits.
fn hard(limb: &LimbFrames) -> Ik {
    Ik { soft_reach: SoftReach::default(), ..limb.posed.ik }
}

/// Distance that the elbow moves while the Cursor moves outwards by 1.
fn race(ik: Ik, cursor: Vec3) -> f32 {
    let elbow = |cursor| ik.solve(cursor, 0.0, IkState::default()).pose.elbow;
    elbow(cursor).distance(elbow(cursor + cursor.normalize_or_zero()))
}

fn shoulder_moved(session: &Session) -> Option<String> {
    let [from, to] = [start(session)?, *limb(session)?].map(|limb| limb.origin(LimbPart::Root));
    Some(length(session, from.distance(to)))
}

/// Largest distance of the hand's path from the straight line between its first key and its middle
/// one, at an influence of IK.
fn bow(session: &Session, influence: f32) -> Option<String> {
    const POINTS: u32 = 24;
    let document = session.document();
    let (from, to) = (document.timeline.start, 0.5 * document.timeline.end);
    let track = Track::new(document);
    let target = session.limb()?.target;
    let index = document.rig.target(target)?;
    let hand = |time: f64| {
        let mut blended = track.at(time).into_document();
        blended.rig.targets[index].influence = influence;
        track.pose(blended, time).skeleton().tip(target)
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
    let race = session.solvers().comparison().filter(|race| !race.is_running())?;
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

/// Distance of the solver two-bone from the target at the end of the race.
fn two_bone_miss(session: &Session) -> Option<String> {
    let race = session.solvers().comparison().filter(|race| !race.is_running())?;
    let report = race.runs().map(SolverRun::report).find(|it| it.method == Method::TwoBone)?;
    Some(distance(session, report.error))
}

/// A distance in a skeleton's scene, in metres or centimetres.
fn distance(session: &Session, distance: f32) -> String {
    match distance * session.document().metres_per_unit() {
        metres if metres < 0.995 => format!("{:.0} cm", 100.0 * metres),
        metres => format!("{metres:.1} m"),
    }
}

/// How far the base of a joint has moved since the step began.
fn joint_moved(session: &Session, name: &str) -> Option<String> {
    let document = session.tour()?.start();
    let before = document.at(document.timeline.start);
    let joint = before.skeleton().find(name)?;
    let moved = session.posed().skeleton().base(joint).distance(before.skeleton().base(joint));
    Some(distance(session, moved))
}

/// Name of the end that misses its target most, and by how much.
fn missed(session: &Session) -> Option<(String, String)> {
    let (index, miss) = farthest_target(session.posed())?;
    let rig = session.rig();
    let end = rig.skeleton.joint(rig.end_of(&rig.targets[index]))?;
    (miss > session.rig().tolerance())
        .then(|| (format!("the {}", end.name.replace('_', " ")), distance(session, miss)))
}
