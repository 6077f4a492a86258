use glam::Vec3;

use super::action::{Export, FileAction, PathDialog};
use crate::document::{Document, RigKind};
use crate::io::{Example, ExampleGroup};
use crate::kinematics::skeleton::JointId;
use crate::session::dialog::Dialog;
use crate::session::outcome::{Consequence, Effect, Opening, Outcome};
use crate::session::session::Session;
use crate::session::skin;

/// Actions on files.
impl Session {
    /// Applies an action; asks first if the action would lose unsaved changes or end an export.
    pub(in crate::session) fn apply_file(&mut self, action: FileAction) -> Option<Effect> {
        if !self.prepare_tour(&action) {
            return None;
        }
        let asked = if action == FileAction::Quit && self.files().is_exporting() {
            Dialog::Exporting
        } else if self.history().is_unsaved() && action.leaves_document() {
            Dialog::Unsaved { then: Box::new(action) }
        } else {
            return self.apply_confirmed_file(action);
        };
        self.act(Consequence::ShowDialog(Box::new(asked)))
    }

    /// Applies an action without a question.
    pub(in crate::session) fn apply_confirmed_file(
        &mut self,
        action: FileAction,
    ) -> Option<Effect> {
        let outcome = match self.apply_to_files(action) {
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
            Err(FileAction::OpenExample(example)) => open_example(example),
            Err(_) => new_skeleton(),
        };
        let effect = self.act(outcome);
        if matches!(effect, Some(Effect::ChoosePath(_))) {
            self.act(Consequence::SetChoosing(true));
        }
        effect
    }

    /// The dialog for an export of the document, with default settings.
    pub fn export_dialog(&self) -> PathDialog {
        const SIZE: (u32, u32) = (1280, 800);
        PathDialog::Export(Export {
            path: format!("{}.glb", self.files().file_stem()).into(),
            frame_rate: self.document().timeline.frame_rate,
            size: SIZE,
        })
    }
}

fn open_example(example: Example) -> Outcome {
    let document = match example.open() {
        Ok(opened) => opened.document,
        Err(error) => return Outcome::fail(error.to_string()),
    };
    let plays = document.follows_path() && document.is_animated();
    let looks_inside = example.group == ExampleGroup::InsideSolver;
    let opening = Opening { document, ..Opening::default() };
    Outcome::from(Consequence::Open(Box::new(opening)))
        .and(plays.then_some(Consequence::Play))
        .and(looks_inside.then_some(Consequence::LookInside))
        .and(Outcome::say(example.sentence))
}

fn new_skeleton() -> Outcome {
    let document = Document { rig: RigKind::Skeleton, ..Document::default() };
    let opening = Opening { document, ..Opening::default() };
    // A sphere that a skeleton of one or two units fits into.
    Outcome::from(Consequence::Open(Box::new(opening)))
        .and(Consequence::Select(vec![JointId::new(0)]))
        .and(Consequence::Frame(Vec3::Y * 0.5, 1.0))
}
