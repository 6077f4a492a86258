use super::dialog::{BakeJob, Dialog};
use super::keys::KeysEdit;
use super::outcome::{Consequence, Effect, Outcome};
use super::session::Session;
use crate::document::{Bake, Baked};

/// Starts and ends bakes, which run on a thread of their own.
#[derive(Clone, Debug, PartialEq)]
pub enum BakeAction {
    /// Starts a bake; the bake dialog shows its progress.
    Start(Bake),
    /// A bake has started.
    Started(BakeJob),
    /// A bake has ended, with its result or an error. The result of a bake whose dialog was closed is
    /// dropped.
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
