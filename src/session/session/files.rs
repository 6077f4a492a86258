use glam::Vec3;

use super::Session;
use crate::document::{Document, SkeletonRig};
use crate::io::{Example, ExampleGroup, Link};
use crate::kinematics::skeleton::JointId;
use crate::session::dialog::Dialog;
use crate::session::files::action::{FileAction, PathDialog};
use crate::session::outcome::{Consequence, Effect, Opening, Outcome};
use crate::session::skin;

/// Actions on files.
impl Session {
    /// Applies an action; asks first if the action would lose unsaved changes or end an export.
    pub(super) fn apply_file(&mut self, action: FileAction) -> Option<Effect> {
        if !self.prepare_tour(&action) {
            return None;
        }
        let asked = if action == FileAction::Quit && self.files.is_exporting() {
            Dialog::Exporting
        } else if self.editing.is_unsaved() && action.leaves_document() {
            Dialog::Unsaved { then: Box::new(action) }
        } else {
            return self.apply_confirmed_file(action);
        };
        self.act(Consequence::ShowDialog(Box::new(asked)))
    }

    /// Applies an action without a question.
    pub(super) fn apply_confirmed_file(&mut self, action: FileAction) -> Option<Effect> {
        let outcome = match self.files.apply(action, self.shell.dialog()) {
            Ok(outcome) => outcome,
            Err(FileAction::SkinLocated { path, before, read }) => {
                match skin::located(self, &path, before.as_ref(), *read) {
                    Ok(edit) => {
                        self.act(Consequence::Commit);
                        self.edit(edit);
                        Outcome::say(format!("The skin comes from {}", path.display()))
                    }
                    Err(refused) => refused,
                }
            }
            Err(FileAction::OpenExample(example)) => {
                self.preferences.offers_tour = false;
                open_example(example)
            }
            Err(FileAction::CopyLink) => copy_link(self.document()),
            Err(FileAction::NewFigure) => new_figure(),
            Err(_) => new_empty(),
        };
        let effect = self.act(outcome);
        if matches!(effect, Some(Effect::ChoosePath(_))) {
            self.act(Consequence::SetChoosing(true));
        }
        effect
    }

    /// Replaces the open document; the history starts anew.
    pub(super) fn open(&mut self, opening: Opening) {
        let Opening { mut document, file, contents, seems_z_up } = opening;
        let goes_away = document.goes_away();
        // Files of other programs have no camera: one that frames all of a long way makes the
        // figure tiny.
        if goes_away && contents.is_some() {
            document.camera = document.camera_at_start();
        }
        let playback = self.playback.restarted(&document.timeline);
        *self = Self {
            files: self.files.replaced(file.clone()),
            editing: self.editing.replaced(document.clone()),
            playback,
            ..Self::with_document(self.preferences, document)
        };
        self.view.follow(goes_away);
        self.refresh();
        self.evaluated.reset_pops(self.editing.posed().time());
        self.evaluated.forget_trail();
        if let Some(file) = file {
            self.files.remember(file);
        }
        self.files.set_origin(contents, seems_z_up);
    }

    pub(super) fn open_dialog(&mut self, dialog: Dialog) {
        // Only the dialogs for saving keep the action that waits for the document to be saved.
        let is_saving = match &dialog {
            Dialog::Path(dialog) => matches!(dialog, PathDialog::SaveAs { .. }),
            Dialog::Replace { back, .. } => matches!(back, PathDialog::SaveAs { .. }),
            Dialog::FileChanged { .. } => true,
            _ => false,
        };
        if !is_saving {
            self.files.forget_after_save();
        }
        self.shell.set_choosing(false);
        self.shell.open_dialog(dialog);
    }

    pub(super) fn close_dialog(&mut self) {
        self.shell.set_choosing(false);
        match self.shell.take_dialog() {
            Some(Dialog::Replace { back, .. }) => self.shell.open_dialog(back.into()),
            Some(Dialog::Bake { job: Some(job), .. }) => {
                job.progress.cancel();
                self.act(Outcome::say("Bake cancelled"));
            }
            _ => {
                self.files.forget_after_save();
                self.files.set_remark(None);
            }
        }
    }
}

fn open_example(example: Example) -> Outcome {
    let document = match example.open() {
        Ok(opened) => opened.document,
        Err(error) => return Outcome::fail(error.to_string()),
    };
    let plays = document.is_animated();
    let looks_inside = example.group == ExampleGroup::InsideSolver;
    let opening = Opening { document, ..Opening::default() };
    Outcome::from(Consequence::Open(Box::new(opening)))
        .and(plays.then_some(Consequence::Play))
        .and(looks_inside.then_some(Consequence::LookInside))
        .and(Outcome::say(example.sentence))
}

fn copy_link(document: &Document) -> Outcome {
    match Link::to(document) {
        Ok(parts) => {
            Outcome::say("Link copied: it carries the whole document").and(Effect::CopyLink(parts))
        }
        Err(error) => Outcome::fail(format!("No link: {error}")),
    }
}

/// Opens the figure of the example "Human" as a new document.
fn new_figure() -> Outcome {
    let figure = Example::find("human").map(Example::open);
    match figure {
        Some(Ok(opened)) => {
            let opening = Opening { document: opened.document, ..Opening::default() };
            Consequence::Open(Box::new(opening)).into()
        }
        Some(Err(error)) => Outcome::fail(error.to_string()),
        None => Outcome::default(),
    }
}

fn new_empty() -> Outcome {
    let document = Document::new(SkeletonRig::default());
    let opening = Opening { document, ..Opening::default() };
    // A sphere that a skeleton of one or two units fits into.
    Outcome::from(Consequence::Open(Box::new(opening)))
        .and(Consequence::Select(vec![JointId::new(0)]))
        .and(Consequence::Frame(Vec3::Y * 0.5, 1.0))
}
