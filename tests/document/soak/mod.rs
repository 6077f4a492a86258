//! A session under many random actions, checked after each.

mod actions;
mod kinds;
mod past;
mod pictured;
mod posed;
mod run;
mod sound;
mod values;
mod watch;

use run::{Every, Run};

/// Description of a broken invariant.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken(pub String);

/// Fails with the description of the invariant unless it holds.
macro_rules! hold {
    ($holds:expr, $($words:tt)*) => {
        let holds: bool = $holds;
        if !holds {
            return Err($crate::soak::Broken(format!($($words)*)));
        }
    };
}
use hold;

#[test]
fn a_session_stays_valid_under_two_thousand_random_actions() {
    let run = Run { seed: 1, actions: 2_000, every: Every::RARE, is_told: false };
    let (least, name) = run.run().least(|count| count.made);
    assert!(least > 0, "{name} was never made");
}

#[test]
fn a_session_stays_valid_when_all_is_checked_after_every_action() {
    let run = Run { seed: 2, actions: 150, every: Every::EACH, is_told: false };
    run.run();
}

/// `IK_ARM_SOAK_ACTIONS` actions from the seed `IK_ARM_SOAK_SEED`; all checks after each of the
/// last 2 %.
#[test]
#[ignore = "takes a quarter of an hour: scripts/soak.sh"]
fn a_session_stays_valid_under_a_million_random_actions() {
    let said = |name: &str| std::env::var(name).ok().and_then(|number| number.parse().ok());
    let actions = said("IK_ARM_SOAK_ACTIONS").unwrap_or(1_000_000);
    let seed = said("IK_ARM_SOAK_SEED").unwrap_or(1) as u64;
    let each = Run { seed: !seed, actions: actions / 50, every: Every::EACH, is_told: true };
    let rare = Run { seed, actions, every: Every::RARE, is_told: true };
    each.run();
    let counts = rare.run();
    eprintln!("{}", counts.table());
    let (least, name) = counts.least(|count| count.done);
    assert!(least >= actions / 2000, "{name} was done only {least} times");
}
