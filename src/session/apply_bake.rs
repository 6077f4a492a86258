use super::bake_action::{BakeAction, BakeJob};
use super::dialog::Dialog;
use super::edit_action::EditAction;
use super::effect::Effect;
use super::session::Session;
use crate::document::{Bake, Baked};

/// Bakes.
impl Session {
    /// The bake dialog for the document, with default settings.
    pub fn bake_dialog(&self) -> Dialog {
        Dialog::Bake { settings: Bake::of_timeline(self.document()), job: None }
    }

    pub(super) fn apply_bake(&mut self, action: BakeAction) -> Option<Effect> {
        match action {
            BakeAction::Start(settings) => return self.start_bake(settings),
            BakeAction::Started(started) => {
                if let Some(Dialog::Bake { settings, job: None }) = self.shell.dialog() {
                    let settings = *settings;
                    self.shell.open_dialog(Dialog::Bake { settings, job: Some(started) });
                } else {
                    started.progress.cancel();
                }
            }
            BakeAction::Ended(job, result) => {
                if self.is_baking(&job) {
                    self.shell.take_dialog();
                    self.end_bake(result);
                }
            }
        }
        None
    }

    fn start_bake(&mut self, settings: Bake) -> Option<Effect> {
        if let Err(error) = settings.check(self.document()) {
            self.fail(error.to_string());
            return None;
        }
        self.open_dialog(Dialog::Bake { settings, job: None });
        Some(Effect::Bake(settings))
    }

    /// Cancels a running bake and closes its dialog.
    pub(super) fn cancel_bake(&mut self) {
        if matches!(self.shell.dialog(), Some(Dialog::Bake { .. })) {
            self.close_dialog();
        }
    }

    fn is_baking(&self, job: &BakeJob) -> bool {
        matches!(self.shell.dialog(), Some(Dialog::Bake { job: Some(own), .. }) if own == job)
    }

    fn end_bake(&mut self, result: Result<Box<Baked>, String>) {
        match result {
            Ok(baked) => {
                let message = describe(&baked);
                self.apply_edit(EditAction::Bake(baked));
                self.say(message);
            }
            Err(error) => self.fail(format!("not baked: {error}")),
        }
    }

    pub(super) fn replace_by_bake(&mut self, baked: &Baked) {
        self.discard_unkeyed_edits();
        // Also if the bake changes nothing, the discarded edits are no longer shown.
        self.refresh();
        self.edit_keys(|document| {
            document.keys = baked.document.keys.clone();
            let paths = &baked.document.skeleton_rig.follow_paths;
            document.skeleton_rig.follow_paths.clone_from(paths);
        });
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
