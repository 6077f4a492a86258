use std::collections::BTreeSet;

use glam::Vec3;

use crate::document::{Bake, Baked, Channel, Document, Keys, Quantity, Target, Timeline};
use crate::kinematics::spline::{Interpolation, Knot, Slopes};
use crate::session::dialog::{BakeJob, Dialog};
use crate::session::outcome::{Consequence, Effect, Outcome};
use crate::session::parts::{Clipboard, Key};
use crate::session::session::Session;

/// A change of the keys or of the timeline.
#[derive(Clone, Debug, PartialEq)]
pub enum KeysEdit {
    /// Keys channels at the playhead with their shown values.
    Key(Vec<Channel>),
    /// Deletes keys.
    DeleteKeys(Vec<Key>),
    /// Deletes all keys of channels.
    ClearChannels(Vec<Channel>),
    /// Moves keys in time and in value.
    MoveKeys {
        /// The keys to move, each with the time that it had before the transaction.
        keys: Vec<Key>,
        /// Shift in seconds; positive is later.
        by: f64,
        /// Change of the values. The result is kept within the values that a channel can have.
        raise: Vec3,
    },
    /// Sets the curve from each key to the next one of its channel.
    SetInterpolation(Vec<Key>, Interpolation),
    /// Sets the slopes of curves at keys, per second; `None` for those that the neighbours give.
    SetSlopes(Vec<Key>, Option<Slopes<Vec3>>),
    /// Pastes the copied keys at the playhead.
    PasteKeys,
    /// Replaces the motion by targets and path by the keys of a bake.
    Bake(Box<Baked>),
    /// Sets start, end and frame rate of the timeline.
    SetTimeline(Timeline),
}

impl KeysEdit {
    /// Label of the edit's undo step.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Key(channels) => match channels[..] {
                [Channel::Target(_)] => "Key target",
                [Channel::TargetTwist(_)] => "Key Socket twist",
                [..] => "Set keys",
            },
            Self::DeleteKeys(_) | Self::ClearChannels(_) => "Delete keys",
            Self::MoveKeys { .. } => "Move keys",
            Self::SetInterpolation(..) => "Set interpolation",
            Self::SetSlopes(..) => "Set tangents",
            Self::PasteKeys => "Paste keys",
            Self::Bake(_) => "Bake to keys",
            Self::SetTimeline(_) => "Change timeline",
        }
    }

    pub(super) fn apply(self, session: &mut Session) -> Outcome {
        let shown = session.shown();
        match self {
            Self::Key(channels) => key(session, &channels),
            Self::DeleteKeys(keys) => {
                Outcome::change(shown, |document| document.keys.remove_all(&keys))
            }
            Self::ClearChannels(channels) => Outcome::change(shown, |document| {
                channels.iter().for_each(|channel| document.keys.clear(*channel));
            }),
            Self::MoveKeys { keys, by, raise } => move_keys(session, &keys, by, raise),
            Self::SetInterpolation(keys, interpolation) => {
                change_keys(shown, &keys, |_, key| Knot { interpolation, ..key })
            }
            Self::SetSlopes(keys, slopes) => change_keys(shown, &keys, |channel, key| {
                let slopes = slopes.map(|Slopes { arriving, leaving }| Slopes {
                    arriving: of_width(channel, arriving),
                    leaving: of_width(channel, leaving),
                });
                Knot { slopes, ..key }
            }),
            Self::PasteKeys => paste_keys(session),
            Self::Bake(baked) => bake(session, &baked),
            Self::SetTimeline(timeline) if timeline.is_valid() => {
                Outcome::change(shown, |document| document.timeline = timeline)
            }
            Self::SetTimeline(_) => Outcome::fail(format!(
                "A timeline must start before it ends, within a day of 0, and have {} to {} frames \
                 per second",
                Timeline::MIN_FRAME_RATE,
                Timeline::MAX_FRAME_RATE
            )),
        }
    }
}

/// Keys channels at the playhead with their shown values.
pub(super) fn key(session: &mut Session, channels: &[Channel]) -> Outcome {
    let time = session.playback().time();
    let are_overridden = channels.iter().any(|channel| session.history().is_overridden(*channel));
    let keys = session.document().keys.clone();
    session.act(Consequence::ForgetUnkeyed(channels.to_vec()));
    let keyed = Outcome::change(session.shown(), |document| {
        channels.iter().for_each(|channel| document.key(*channel, time));
    });
    session.act(keyed);
    // If the keys had these values already, nothing was written.
    let is_same = are_overridden && keys == session.document().keys;
    Outcome::from(is_same.then_some(Consequence::Refresh)).and(Outcome::say(match channels {
        [] => "There is nothing to key".to_owned(),
        _ if session.playback().is_auto_key_news() => {
            format!("Keyed at {time:.2} s. Auto-key is on: every edit sets keys")
        }
        _ => format!("Keyed at {time:.2} s"),
    }))
}

/// Moves `keys`, given with their times before the transaction, by `by` seconds, and adds `raise`
/// to their values. Replaces other keys at the new times.
fn move_keys(session: &Session, keys: &[Key], by: f64, raise: Vec3) -> Outcome {
    let farthest = Timeline::MAX_TIME;
    let by = if by.is_finite() { by.clamp(-farthest, farthest) } else { 0.0 };
    let raise = if raise.is_finite() { raise } else { Vec3::ZERO };
    let before = session.history().shown_before().keys.clone();
    let timeline = session.document().timeline;
    let moved: Clipboard = keys
        .iter()
        .filter_map(|(channel, time)| {
            let key = before.key(*channel, *time)?;
            let time = moved_to(timeline, *time, by);
            let value = raised(*channel, key.value, raise);
            Some((*channel, Knot { time, value, ..key }))
        })
        .collect();
    let mut after = before.clone();
    after.remove_all(keys);
    insert(&mut after, &moved);
    // The next move of this drag starts from the same keys.
    Outcome::from(Consequence::SelectKeys(names(&moved)))
        .and(Outcome::change(session.shown(), |document| document.keys = after))
        .and(Consequence::RestartKeysFrom(Box::new(before)))
}

fn change_keys(
    shown: &Document,
    keys: &[Key],
    change: impl Fn(Channel, Knot<Vec3>) -> Knot<Vec3>,
) -> Outcome {
    Outcome::change(shown, |document| {
        for (channel, time) in keys {
            if let Some(key) = document.keys.key(*channel, *time) {
                document.keys.insert_key(*channel, change(*channel, key));
            }
        }
    })
}

/// Pastes the copied keys at the playhead, except those of missing joints.
fn paste_keys(session: &Session) -> Outcome {
    let (shown, timeline) = (session.shown(), session.document().timeline);
    let copies = session.selection().clipboard().iter();
    let pasted: Clipboard = copies
        .filter(|(channel, _)| channel.value(shown).is_some())
        .map(|(channel, key)| {
            (
                *channel,
                Knot { time: moved_to(timeline, session.playback().time(), key.time), ..*key },
            )
        })
        .collect();
    Outcome::from(Consequence::SelectKeys(names(&pasted)))
        .and(Outcome::change(shown, |document| insert(&mut document.keys, &pasted)))
}

/// Replaces the motion by targets and path by the keys of a bake.
fn bake(session: &mut Session, baked: &Baked) -> Outcome {
    // Also if the bake changes nothing, the discarded edits are no longer shown.
    session.act(Outcome::from(Consequence::DiscardUnkeyed).and(Consequence::Refresh));
    Outcome::change(session.shown(), |document| {
        document.keys = baked.document.keys.clone();
        let paths = &baked.document.rig.follow_paths;
        document.rig.follow_paths.clone_from(paths);
    })
}

/// The time of a key after a move by `by`, in seconds. A move from one frame to another ends
/// exactly on the frame.
fn moved_to(timeline: Timeline, time: f64, by: f64) -> f64 {
    let (from, to) = (timeline.snapped(time), timeline.snapped(time + by));
    let is_on_frame = |time: f64, frame: f64| (time - frame).abs() < 1e-9;
    if is_on_frame(time, from) && is_on_frame(time + by, to) { to } else { time + by }
}

fn names(keys: &Clipboard) -> Vec<Key> {
    keys.iter().map(|(channel, key)| (*channel, key.time)).collect()
}

fn insert(keys: &mut Keys, all: &Clipboard) {
    for (channel, key) in all {
        keys.insert_key(*channel, *key);
    }
}

/// The sum of a key's value and `by`, within the values that the channel can have.
fn raised(channel: Channel, value: Vec3, by: Vec3) -> Vec3 {
    /// Smallest part of a length that a move of its key leaves.
    const LEAST: f32 = 1e-3;
    let sum = (value + of_width(channel, by)).clamp(Vec3::MIN, Vec3::MAX);
    match channel.quantity() {
        Quantity::Switch => value,
        Quantity::Fraction => sum.clamp(Vec3::ZERO, Vec3::X),
        Quantity::Length => sum.max(value * LEAST),
        Quantity::Point
        | Quantity::Angle
        | Quantity::Number
        | Quantity::Numbers
        | Quantity::Rotation => sum,
    }
}

/// The vector without the components that values of the channel do not have.
fn of_width(channel: Channel, vector: Vec3) -> Vec3 {
    let mut components = vector.to_array();
    components.iter_mut().skip(channel.quantity().width()).for_each(|it| *it = 0.0);
    Vec3::from_array(components)
}

/// Channels for the keys.
impl KeysEdit {
    /// Channels that the shortcut K keys: those selected in the timeline, if any, else those of the
    /// selected joints. Without a selection, for a rig that is one limb the channels that pose it
    /// and those with unkeyed edits, for any other all channels.
    pub fn channels_to_key(session: &Session) -> Vec<Channel> {
        let (shown, selection) = (session.shown(), session.selection());
        let is_there = |channel: &Channel| channel.value(shown).is_some();
        if !selection.channels().is_empty() {
            return selection.channels().iter().copied().filter(is_there).collect();
        }
        let rig = &shown.rig;
        match (rig.sole_limb(), selection.joints()) {
            (Some(limb), []) => {
                let overridden = session.history().overridden_channels().filter(is_there);
                let all: BTreeSet<_> =
                    posing_channels(shown, limb).into_iter().chain(overridden).collect();
                all.into_iter().collect()
            }
            (None, []) => Self::all_channels(shown),
            (_, selected) => {
                let ends = selected.iter().filter_map(|it| rig.target_of_end(*it));
                let targeted: Vec<_> = ends.map(|index| rig.targets[index].joint).collect();
                let is_selected = |channel: &Channel| match channel.target() {
                    Some(joint) => targeted.contains(&joint),
                    None => channel.joint().is_some_and(|it| selected.contains(&it)),
                };
                Channel::of_rig(shown).into_iter().filter(is_selected).collect()
            }
        }
    }

    /// Channels that affect the pose, and those of [`Self::keyed_channels`].
    pub fn all_channels(shown: &Document) -> Vec<Channel> {
        let of_rig = Channel::of_rig(shown).into_iter();
        let all: BTreeSet<Channel> = of_rig.chain(Self::keyed_channels(shown)).collect();
        all.into_iter().collect()
    }

    /// All channels with keys, except points of targets that are not in use.
    pub fn keyed_channels(shown: &Document) -> impl Iterator<Item = Channel> {
        let keyed = shown.keys.tracks().map(|(channel, _)| channel);
        keyed.filter(|channel| !channel.is_idle(&shown.rig))
    }
}

/// Channels that pose a limb: those of IK if its influence is above 0, and those of FK if that
/// influence is below 1. The switch of the pin is among them if it is on or has keys.
fn posing_channels(document: &Document, target: &Target) -> Vec<Channel> {
    let (rig, joint) = (&document.rig, target.joint);
    let is_keyed =
        |channel: &Channel| *channel == Channel::Pinned(joint) && document.keys.has(*channel);
    let of_ik = Channel::of_ik(target).into_iter().filter(|_| target.influence > 0.0);
    let of_ik = of_ik.filter(|channel| channel.shapes(target) || is_keyed(channel));
    let of_fk = Channel::of_fk(rig, target).into_iter().filter(|_| target.influence < 1.0);
    let stretch = Channel::Stretch(joint);
    of_ik.chain(of_fk.filter(|it| *it != stretch || it.shapes(target))).collect()
}

/// Starts and ends bakes, which run on a thread of their own.
#[derive(Clone, Debug, PartialEq)]
pub enum BakeAction {
    /// Starts a bake; the bake dialog shows its progress.
    Start(Bake),
    /// A bake has started.
    Started(BakeJob),
    /// A bake has ended, with its result or an error. The result of a bake whose dialog was closed
    /// is dropped.
    Ended(BakeJob, Result<Box<Baked>, String>),
}

impl BakeAction {
    pub(super) fn apply(self, session: &mut Session) -> Outcome {
        match (self, session.shell().dialog()) {
            (Self::Start(settings), _) => start(session, settings),
            (Self::Started(job), Some(Dialog::Bake { settings, job: None })) => {
                let dialog = Dialog::Bake { settings: *settings, job: Some(job) };
                Consequence::ShowDialog(Box::new(dialog)).into()
            }
            (Self::Started(job), _) => {
                job.progress.cancel();
                Outcome::default()
            }
            (Self::Ended(job, result), Some(Dialog::Bake { job: Some(own), .. }))
                if *own == job =>
            {
                session.act(Consequence::TakeDialog);
                match result {
                    Ok(baked) => {
                        let message = describe(&baked);
                        session.edit(KeysEdit::Bake(baked));
                        Outcome::say(message)
                    }
                    Err(error) => Outcome::fail(format!("not baked: {error}")),
                }
            }
            (Self::Ended(..), _) => Outcome::default(),
        }
    }
}

fn start(session: &Session, settings: Bake) -> Outcome {
    match settings.check(session.document()) {
        Ok(()) => {
            let dialog = Dialog::Bake { settings, job: None };
            Outcome::from(Consequence::OpenDialog(Box::new(dialog))).and(Effect::Bake(settings))
        }
        Err(error) => Outcome::fail(error.to_string()),
    }
}

/// The number of keys, and what is not kept.
fn describe(Baked { keys_at_frames, keys, shortened, .. }: &Baked) -> String {
    let kept = format!("Baked: {keys} of {keys_at_frames} keys left");
    match shortened.len() {
        0 => kept,
        1 => format!("{kept}; the stretch of one bone has no keys"),
        bones => format!("{kept}; the stretch of {bones} bones has no keys"),
    }
}
