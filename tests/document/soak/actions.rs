//! Choice of the next action: bursts of one sort, with tame or wild values, in sessions of bounded
//! size.

use ik_arm::document::Channel;
use ik_arm::session::{Action, FileAction, JointEdit, KeysEdit, Session};

use ik_arm::kinematics::skeleton::JointId;

use crate::common::Random;
use crate::soak::kinds::{KINDS, Kind, Sort};
use crate::soak::values::Values;

pub struct Actions {
    random: Random,
    /// Sort of most actions, and how many more of them follow.
    sort: Sort,
    burst: usize,
    /// Fraction of wild values, and for how many more actions.
    wild: f32,
    stretch: usize,
    clock: f64,
    made: usize,
}

impl Actions {
    const MOST_JOINTS: usize = 28;
    const MOST_KEYS: usize = 300;
    /// Skeletons with more joints than this are soon replaced.
    const HUGE: usize = 500;

    pub fn new(seed: u64) -> Self {
        let random = Random(seed);
        Self { random, sort: Sort::Arm, burst: 0, wild: 0.0, stretch: 0, clock: 0.0, made: 0 }
    }

    pub fn next(&mut self, session: &Session) -> Action {
        self.made += 1;
        if self.stretch == 0 {
            self.stretch = 100 + self.random.below(400);
            self.wild = [0.0, 0.0, 0.003, 0.1][self.random.below(4)];
            return self.anew(session);
        }
        self.stretch -= 1;
        if self.burst == 0 {
            self.burst = 5 + self.random.below(60);
            self.sort = Sort::ALL[self.random.below(Sort::ALL.len())];
        }
        self.burst -= 1;
        if let Some(smaller) = self.made_smaller(session) {
            return smaller;
        }
        let kind = self.kind(session);
        (kind.make)(&mut self.values(session))
    }

    fn values<'a>(&'a mut self, session: &'a Session) -> Values<'a> {
        let Self { random, wild, clock, .. } = self;
        Values { random, session, wild: *wild, clock }
    }

    /// Opens another document, so that wild values do not persist.
    fn anew(&mut self, session: &Session) -> Action {
        let mut values = self.values(session);
        let (document, file) = (Box::new(values.document()), values.file());
        FileAction::Discard(Box::new(FileAction::Opened { document, file, contents: None })).into()
    }

    fn made_smaller(&mut self, session: &Session) -> Option<Action> {
        let joints = session.skeleton().joints().len();
        let keys = &session.document().keys;
        if joints > Self::HUGE && self.random.chance(0.1) {
            return Some(self.anew(session));
        }
        if joints > Self::MOST_JOINTS && joints <= Self::HUGE && self.random.chance(0.2) {
            return Some(
                JointEdit::DeleteJoints(vec![JointId::new(1 + self.random.below(joints - 1))])
                    .into(),
            );
        }
        if keys.count() > Self::MOST_KEYS && self.random.chance(0.2) {
            let place = self.random.below(keys.tracks().count());
            let channel: Option<Channel> = keys.tracks().nth(place).map(|(channel, _)| channel);
            return Some(KeysEdit::ClearChannels(channel.into_iter().collect()).into());
        }
        None
    }

    fn kind(&mut self, session: &Session) -> &'static Kind {
        const OFTEN: u32 = 8;
        /// Now and then each kind has its turn, so that every kind occurs.
        const TURN: usize = 10;
        if self.made.is_multiple_of(TURN) {
            return &KINDS[self.made / TURN % KINDS.len()];
        }
        let (sort, is_dragging) = (self.sort, session.history().drag().is_some());
        let weight = |kind: &Kind| {
            let is_meant = kind.sort == sort || is_dragging && kind.sort == Sort::Drag;
            kind.weight * if is_meant { OFTEN } else { 1 }
        };
        let all: u32 = KINDS.iter().map(weight).sum();
        let mut left = self.random.below(all as usize) as u32;
        for kind in KINDS {
            if left < weight(kind) {
                return kind;
            }
            left -= weight(kind);
        }
        &KINDS[0]
    }
}
