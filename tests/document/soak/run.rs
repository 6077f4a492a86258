//! Runs many actions, and reports the one that breaks an invariant.

use std::fmt::Write as _;
use std::time::Instant;

use ik_arm::document::Document;
use ik_arm::session::Action;

use crate::common::Random;
use crate::soak::actions::Actions;
use crate::soak::kinds::{KINDS, Kind, kind};
use crate::soak::watch::{Care, Watch};

pub struct Run {
    pub seed: u64,
    pub actions: usize,
    /// Mean number of actions between two expensive checks.
    pub every: Every,
    /// True if progress is printed.
    pub is_told: bool,
}

#[derive(Clone, Copy)]
pub struct Every {
    pub step: usize,
    pub saving: usize,
    pub scene: usize,
    pub walk: usize,
}

impl Every {
    pub const RARE: Self = Self { step: 20, saving: 50, scene: 50, walk: 500 };
    pub const EACH: Self = Self { step: 1, saving: 1, scene: 1, walk: 1 };

    fn care(self, random: &mut Random) -> Care {
        let mut is_due = |every: usize| random.below(every) == 0;
        Care {
            step: is_due(self.step),
            saving: is_due(self.saving),
            scene: is_due(self.scene),
            walk: is_due(self.walk),
        }
    }
}

/// Numbers of actions of each kind: made, and applied instead of asked about.
pub struct Counts(Vec<Count>);

#[derive(Clone, Copy, Default)]
pub struct Count {
    pub made: usize,
    pub done: usize,
}

impl Run {
    /// # Panics
    ///
    /// If an invariant breaks: with the seed, the actions that led there and the invariant.
    pub fn run(&self) -> Counts {
        let mut made = Actions::new(self.seed);
        let mut cares = Random(!self.seed);
        let mut watch = Watch::new(Document::default());
        let mut counts = vec![Count::default(); KINDS.len()];
        // Since the document was opened.
        let mut recent: Vec<(Action, Care)> = Vec::new();
        let started = Instant::now();
        for index in 0..self.actions {
            let action = made.next(&watch.session);
            let care = self.every.care(&mut cares);
            let began = watch.expected.began.clone();
            recent.push((action.clone(), care));
            match watch.apply(&action, care) {
                Ok(is_done) => {
                    let count = &mut counts[kind(&action)];
                    count.made += 1;
                    count.done += usize::from(is_done);
                }
                Err(broken) => self.fail(index, &broken.0, &began, &recent),
            }
            if watch.expected.age == 0 {
                recent.clear();
            }
            if self.is_told && (index + 1) % 50_000 == 0 {
                eprintln!("{} actions in {:.0} s", index + 1, started.elapsed().as_secs_f64());
            }
        }
        Counts(counts)
    }

    fn fail(&self, index: usize, broken: &str, began: &Document, all: &[(Action, Care)]) -> ! {
        const LAST: usize = 20;
        let mut text = format!("seed {}, action {index}: {broken}\n", self.seed);
        let _ = writeln!(text, "The last actions:");
        for (action, _) in &all[all.len().saturating_sub(LAST)..] {
            let _ = writeln!(text, "  {}", shortened(action));
        }
        let least = smaller(began, all, broken);
        let _ = writeln!(text, "{} of {} actions break it:", least.len(), all.len());
        for (action, _) in least.iter().rev().take(3 * LAST).rev() {
            let _ = writeln!(text, "  {}", shortened(action));
        }
        let path = format!("{}/soak-{}.json", env!("CARGO_TARGET_TMPDIR"), self.seed);
        let written = ik_arm::io::to_json(began).map(|json| std::fs::write(&path, json));
        let _ = writeln!(text, "They begin with {path} ({written:?})");
        panic!("{text}");
    }
}

impl Counts {
    /// Name by name, the fewest first.
    pub fn table(&self) -> String {
        let mut rows: Vec<_> = KINDS.iter().zip(&self.0).collect();
        rows.sort_by_key(|(_, count)| count.done);
        let row = |(kind, Count { made, done }): (&Kind, &Count)| {
            format!("{:>22} {made:>8} made {done:>8} done\n", kind.name)
        };
        rows.into_iter().map(row).collect()
    }

    /// The smallest count and its kind.
    pub fn least(&self, of: fn(&Count) -> usize) -> (usize, &'static str) {
        let counts = KINDS.iter().zip(&self.0).map(|(kind, count)| (of(count), kind.name));
        counts.min().unwrap_or_default()
    }
}

/// Minimizes a failing sequence by leaving out chunks as long as the same invariant breaks.
fn smaller(began: &Document, all: &[(Action, Care)], broken: &str) -> Vec<(Action, Care)> {
    let started = Instant::now();
    let same = |other: &str| invariant(other) == invariant(broken);
    let breaks = |actions: &[(Action, Care)]| {
        let mut watch = Watch::new(began.clone());
        let broken = actions.iter().find_map(|(action, care)| watch.apply(action, *care).err());
        broken.is_some_and(|broken| same(&broken.0))
    };
    let mut least = all.to_vec();
    if let Some((_, care)) = least.last_mut() {
        *care = Care::FULL;
    }
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let mut chunk = least.len() / 2;
    while breaks(&least) && chunk > 0 && started.elapsed().as_secs() < 60 {
        let mut at = 0;
        while at + chunk < least.len() {
            let mut fewer = least.clone();
            fewer.drain(at..at + chunk);
            if breaks(&fewer) { least = fewer } else { at += chunk }
        }
        chunk /= 2;
    }
    std::panic::set_hook(hook);
    least
}

/// The description without its numbers.
fn invariant(broken: &str) -> String {
    broken.split(':').next().unwrap_or_default().chars().filter(|c| c.is_alphabetic()).collect()
}

fn shortened(action: &Action) -> String {
    const MOST: usize = 240;
    let text = format!("{action:?}");
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text,
    }
}
