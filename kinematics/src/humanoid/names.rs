//! Names of the joints of human-like figures, in the schemes of widely used programs.
//!
//! A name is split into words at punctuation, digits and changes of case. Dropped are the namespace, a
//! first word that more than half of the names share (a character's name), and fillers such as *DEF*
//! and *jnt*; *left*, *right*, *l* and *r* tell the side. The rest must be one of the words below as
//! a whole: so `LeftHandIndex1`, `upperarm_twist_01_l` and `ik_hand_l` are not taken for hands and
//! arms.
//!
//! # Sources
//!
//! Bone names of the VRM 1.0 specification (VRMC_vrm, humanoid) and of VRoid Studio; of Mixamo;
//! of Unreal's Manny; of Unity's `HumanBodyBones`; of Blender's Rigify (metarig and DEF bones) and
//! of MakeHuman; of 3ds Max Biped; of the Acclaim and BVH files of CMU's motion database; of
//! Poser and Daz; of SMPL; of MikuMikuDance.

use std::collections::{HashMap, HashSet};

use super::body::{BodyPart, Humanoid, HumanoidLimb, NotHumanoid};
use crate::skeleton::{JointId, Skeleton};

const UPPER_ARM: &[&str] = &[
    "upperarm",
    "arm",
    "uparm",
    "armupper",
    "humerus",
    "shldr",
    "shldrbend",
    "shoulder",
    "bicep",
    "腕",
];
const LOWER_ARM: &[&str] = &[
    "lowerarm",
    "forearm",
    "lowarm",
    "armlower",
    "elbow",
    "radius",
    "ulna",
    "forearmbend",
    "ひじ",
];
const HAND: &[&str] = &["hand", "wrist", "palm", "手首"];
const UPPER_LEG: &[&str] =
    &["upperleg", "upleg", "legupper", "thigh", "thighbend", "femur", "hip", "leg", "足"];
const LOWER_LEG: &[&str] =
    &["lowerleg", "lowleg", "leglower", "leg", "calf", "shin", "shinbend", "knee", "tibia", "ひざ"];
const FOOT: &[&str] = &["foot", "ankle", "足首"];
const HEAD: &[&str] = &["head", "頭"];

/// Words that say nothing about the part.
const FILLERS: &[&str] =
    &["def", "jnt", "joint", "jt", "bone", "bn", "bind", "skin", "b", "j", "c", "bip"];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// A name without what does not matter.
#[derive(Clone, Debug, PartialEq, Eq)]
struct PlainName {
    side: Option<Side>,
    word: String,
}

/// Recognises a figure by the bones that its file says its joints are, or else by the names of its
/// joints.
pub fn humanoid(skeleton: &Skeleton) -> Result<Humanoid, NotHumanoid> {
    let bones = skeleton.joints().iter().map(|joint| joint.human_bone.as_deref());
    if bones.clone().any(|bone| bone.is_some()) {
        let names = plain_names(bones.map(Option::unwrap_or_default), &[]);
        if let Ok(humanoid) = Found::new(skeleton, &names).and_then(Found::humanoid) {
            return Ok(humanoid);
        }
    }
    by_names(skeleton)
}

fn by_names(skeleton: &Skeleton) -> Result<Humanoid, NotHumanoid> {
    let names = || skeleton.joints().iter().map(|joint| joint.name.as_str());
    let found = Found::new(skeleton, &plain_names(names(), &[]))?;
    let complete = found.humanoid();
    // Rigify's ORG bones are the same skeleton again, above its DEF bones.
    if complete.is_err()
        && let Ok(original) = Found::new(skeleton, &plain_names(names(), &["org"]))
    {
        return original.humanoid().or(complete);
    }
    complete
}

/// The parts with known names.
struct Found {
    head: Option<JointId>,
    /// Left arm, right arm, left leg, right leg.
    limbs: [Option<HumanoidLimb>; 4],
}

impl Found {
    /// Finds parts by the names of all joints.
    fn new(skeleton: &Skeleton, names: &[PlainName]) -> Result<Self, NotHumanoid> {
        let limb = |part, side, words| limb(skeleton, names, part, side, words);
        let (arm, leg) = ([UPPER_ARM, LOWER_ARM, HAND], [UPPER_LEG, LOWER_LEG, FOOT]);
        Ok(Self {
            head: skeleton.ids().find(|joint| names[joint.index()].is(None, HEAD)),
            limbs: [
                limb(BodyPart::LeftArm, Side::Left, arm)?,
                limb(BodyPart::RightArm, Side::Right, arm)?,
                limb(BodyPart::LeftLeg, Side::Left, leg)?,
                limb(BodyPart::RightLeg, Side::Right, leg)?,
            ],
        })
    }

    fn humanoid(self) -> Result<Humanoid, NotHumanoid> {
        const PARTS: [BodyPart; 4] =
            [BodyPart::LeftArm, BodyPart::RightArm, BodyPart::LeftLeg, BodyPart::RightLeg];
        if let [Some(left_arm), Some(right_arm), Some(left_leg), Some(right_leg)] = self.limbs {
            let (arms, legs) = ([left_arm, right_arm], [left_leg, right_leg]);
            return Ok(Humanoid { head: self.head, arms, legs });
        }
        let of = |is_found: bool| {
            let parts = PARTS.into_iter().zip(&self.limbs);
            parts.filter(move |(_, limb)| limb.is_some() == is_found).map(|(part, _)| part)
        };
        let head = self.head.map(|_| BodyPart::Head);
        Err(NotHumanoid::Missing {
            found: of(true).chain(head).collect(),
            missing: of(false).collect(),
        })
    }
}

/// The limb of a side, whose joints have one of the words for its upper joint, lower joint and end;
/// `None` without one.
fn limb(
    skeleton: &Skeleton,
    names: &[PlainName],
    part: BodyPart,
    side: Side,
    [upper_words, lower_words, end_words]: [&[&str]; 3],
) -> Result<Option<HumanoidLimb>, NotHumanoid> {
    let is = |joint: JointId, words: &[&str]| names[joint.index()].is(Some(side), words);
    // The first of several joints in a row with the same name but for a number: segments of a bone.
    let first_segment = |joint: JointId| {
        let word = &names[joint.index()];
        let row = skeleton.ancestors(joint).take_while(|above| names[above.index()] == *word);
        row.last().unwrap_or(joint)
    };
    let above = |joint: JointId, words: &[&str]| {
        let found = skeleton.ancestors(joint).skip(1).find(|above| is(*above, words))?;
        Some(first_segment(found))
    };
    let ends = skeleton.ids().filter(|joint| is(*joint, end_words));
    let mut limbs: Vec<HumanoidLimb> = Vec::new();
    for end in ends {
        let Some(lower) = above(end, lower_words) else { continue };
        let Some(upper) = above(lower, upper_words) else { continue };
        // Of a wrist and the hand below it, the wrist is the end.
        if limbs.iter().any(|limb| skeleton.is_in_subtree(end, limb.end)) {
            continue;
        }
        limbs.push(HumanoidLimb { upper, lower, end });
    }
    match limbs[..] {
        [] => Ok(None),
        [limb] => Ok(Some(limb)),
        [one, other, ..] => {
            let between = [one.end, other.end].map(|end| skeleton[end].name.clone());
            Err(NotHumanoid::Several { part, between })
        }
    }
}

impl PlainName {
    fn is(&self, side: Option<Side>, words: &[&str]) -> bool {
        self.side == side && words.contains(&self.word.as_str())
    }
}

/// The plain names for the names of all joints, of which these words are dropped, too.
fn plain_names<'a>(names: impl Iterator<Item = &'a str>, fillers: &[&str]) -> Vec<PlainName> {
    let words: Vec<Vec<String>> = names.map(words_of).collect();
    let common = common_beginnings(&words);
    let is_filler = |word: &String| {
        let word = word.as_str();
        FILLERS.contains(&word) || fillers.contains(&word) || common.contains(word)
    };
    words.iter().map(|words| plain(words, is_filler)).collect()
}

/// Words with which more than half of the names of several words begin, such as the name of a
/// character.
fn common_beginnings(names: &[Vec<String>]) -> HashSet<String> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let long = || names.iter().filter(|words| words.len() > 1);
    for first in long().filter_map(|words| words.first()) {
        *counts.entry(first).or_default() += 1;
    }
    let most = long().count() / 2;
    let is_common = |(word, count): &(&str, usize)| *count > most && side_of(word).is_none();
    counts.into_iter().filter(is_common).map(|(word, _)| word.to_owned()).collect()
}

fn side_of(word: &str) -> Option<Side> {
    match word {
        "left" | "l" | "左" => Some(Side::Left),
        "right" | "r" | "右" => Some(Side::Right),
        _ => None,
    }
}

fn plain(words: &[String], is_filler: impl Fn(&String) -> bool) -> PlainName {
    let side = words.iter().find_map(|word| side_of(word));
    let is_kept = |word: &&String| side_of(word).is_none() && !is_filler(word);
    let word: String = words.iter().filter(is_kept).map(String::as_str).collect();
    if side.is_some() {
        return PlainName { side, word };
    }
    // Acclaim and Poser write the side in front of the word: lfemur, rShldr.
    let glued = word.strip_prefix('l').map(|rest| (Side::Left, rest));
    let glued = glued.or_else(|| word.strip_prefix('r').map(|rest| (Side::Right, rest)));
    let all = [UPPER_ARM, LOWER_ARM, HAND, UPPER_LEG, LOWER_LEG, FOOT];
    match glued.filter(|(_, rest)| all.iter().any(|words| words.contains(rest))) {
        Some((side, rest)) => PlainName { side: Some(side), word: rest.to_owned() },
        None => PlainName { side: None, word },
    }
}

/// The words of a name in lower case, without namespace and digits.
fn words_of(name: &str) -> Vec<String> {
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let letters: Vec<char> = name.chars().collect();
    let mut words = vec![String::new()];
    for (index, &letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).map(|index| letters[index]);
        let is_next_small = letters.get(index + 1).is_some_and(|next| next.is_lowercase());
        let starts_word = letter.is_uppercase()
            && before.is_some_and(|before| {
                before.is_lowercase() || before.is_uppercase() && is_next_small
            });
        let is_side = |letter| letter == '左' || letter == '右';
        if !letter.is_alphabetic() || starts_word || before.is_some_and(is_side) {
            words.push(String::new());
        }
        if letter.is_alphabetic()
            && let Some(word) = words.last_mut()
        {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}
