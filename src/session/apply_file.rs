use std::path::{Path, PathBuf};

use glam::Vec3;

use super::dialog::Dialog;
use super::effect::Effect;
use super::export::{Export, ExportJob};
use super::file_action::FileAction;
use super::file_contents::FileContents;
use super::path_dialog::PathDialog;
use super::playback_action::PlaybackAction;
use super::session::{ASPECT, Session};
use super::solver_action::SolverAction;
use crate::document::{Document, RigKind};
use crate::io::{Example, Group, new_document};
use crate::kinematics::skeleton::JointId;

/// Opening, saving and exporting files.
impl Session {
    /// The file that the document was opened from or saved to; `None` for a new or imported
    /// document.
    pub fn file(&self) -> Option<&Path> {
        self.files.file()
    }

    /// Name of the document: its file's, or without the extension that of the file of another program
    /// that it was imported from; `None` for a new document.
    pub fn document_name(&self) -> Option<String> {
        let own = self.files.file().and_then(Path::file_name);
        let imported = || self.files.origin().and_then(Path::file_stem);
        Some(own.or_else(imported)?.to_string_lossy().into_owned())
    }

    /// Whether another program has changed the document's file since it was last opened or saved.
    pub fn has_changed_file(&self) -> bool {
        self.files.has_changed()
    }

    /// Files that were opened or saved, the most recent first.
    pub fn recent(&self) -> &[PathBuf] {
        self.files.recent()
    }

    /// Sets the recent files, as saved by an earlier run of the program.
    pub fn set_recent(&mut self, recent: Vec<PathBuf>) {
        self.files.set_recent(recent);
    }

    /// Opens the unsaved document of an earlier run of the program.
    pub(super) fn recover(&mut self, document: Document, file: Option<PathBuf>) {
        self.replace_document(document, file);
        self.editing.mark_unsaved();
        self.files.settle_recovery();
        self.say("The unsaved document is open; save it");
    }

    /// Sets the text for the status bar once the file is open that was read: with unsaved changes,
    /// that is after a question.
    pub fn remark_when_opened(&mut self, remark: Option<String>) {
        self.files.set_remark(remark);
    }

    /// The skeletons and animations of the file of another program that the document comes from.
    pub fn contents(&self) -> Option<&FileContents> {
        self.files.contents()
    }

    /// Whether the unsaved document of an earlier run was opened or declined.
    pub fn has_settled_recovery(&self) -> bool {
        self.files.has_settled_recovery()
    }

    /// Whether z seems to point up in the file of the document, which was not turned yet.
    pub fn seems_z_up(&self) -> bool {
        self.files.seems_z_up()
    }

    pub(super) fn replace_document(&mut self, document: Document, file: Option<PathBuf>) {
        let playback = self.playback.restarted(&document.timeline);
        *self = Self {
            files: self.files.replaced(file.clone()),
            editing: self.editing.replaced(document.clone()),
            playback,
            ..Self::with_document(self.preferences, document)
        };
        self.refresh();
        self.evaluated.reset_pops(self.editing.posed());
        self.forget_trail();
        if let Some(file) = file {
            self.files.remember(file);
        }
    }

    /// Returns the effect that saves the document to its file, or that asks for a path if the
    /// document has no file. Asks first if another program has changed the file.
    pub(super) fn save(&mut self) -> Option<Effect> {
        self.end_glide();
        let Some(path) = self.files.file().map(Path::to_owned) else {
            return Some(Effect::ChoosePath(self.save_as_dialog()));
        };
        if self.has_changed_file() {
            self.open_dialog(Dialog::FileChanged { path });
            return None;
        }
        Some(Effect::Save(path))
    }

    /// Marks the document as saved and applies the action that waited for the save.
    pub(super) fn finish_save(&mut self, path: PathBuf) -> Option<Effect> {
        self.say(format!("Saved {}", path.display()));
        self.commit_edit();
        self.editing.mark_saved();
        self.files.remember(path.clone());
        self.files.set_saved_file(path);
        self.files.take_after_save().and_then(|then: Box<FileAction>| self.apply_file(*then))
    }

    /// Reports the error and asks for another path.
    pub(super) fn fail_save(&mut self, path: &Path, why: &str) {
        self.fail(format!("not saved: {why}"));
        let (path, problem) = (path.display().to_string(), Some(why.to_owned()));
        self.open_dialog(PathDialog::SaveAs { path, problem }.into());
        self.files.take_after_save();
    }

    /// Reports the error. Unless another dialog is open, shows the error and the path in the
    /// program's Open dialog.
    pub(super) fn fail_open(&mut self, path: &Path, why: &str) {
        self.fail(format!("not opened: {why}"));
        if self
            .shell
            .dialog()
            .is_none_or(|dialog| matches!(dialog, Dialog::Path(PathDialog::Open { .. })))
        {
            let (path, problem) = (path.display().to_string(), Some(why.to_owned()));
            self.open_dialog(PathDialog::Open { path, problem }.into());
        }
    }

    /// Applies an action; asks first if the action would lose unsaved changes or end an export.
    pub(super) fn apply_file(&mut self, action: FileAction) -> Option<Effect> {
        if !self.prepare_tour(&action) {
            return None;
        }
        if action == FileAction::Quit && self.is_exporting() {
            self.shell.open_dialog(Dialog::Exporting);
            return None;
        }
        if self.is_unsaved() && action.leaves_document() {
            self.shell.open_dialog(Dialog::Unsaved { then: Box::new(action) });
            return None;
        }
        self.apply_confirmed_file(action)
    }

    fn apply_confirmed_file(&mut self, action: FileAction) -> Option<Effect> {
        let effect = self.file_effect(action);
        if matches!(effect, Some(Effect::ChoosePath(_))) {
            self.shell.set_choosing(true);
        }
        effect
    }

    fn file_effect(&mut self, action: FileAction) -> Option<Effect> {
        match action {
            FileAction::SavePicture(path) => {
                self.shell.take_dialog();
                self.shell.set_choosing(false);
                self.files.remember_export_folder(path.as_ref());
                self.say(format!("Saving {path} …"));
                return Some(Effect::SavePicture(path));
            }
            FileAction::Export(export) => return self.export(export),
            FileAction::ExportStarted(job) => self.files.set_job(Some(job)),
            FileAction::CancelExport => self.cancel_export(),
            FileAction::StopExportAndQuit => return self.stop_export_and_quit(),
            FileAction::ExportEnded(how) => {
                self.files.set_job(None);
                if self.shell.dialog() == Some(&Dialog::Exporting) {
                    self.shell.take_dialog();
                }
                match how {
                    Ok(done) => self.say(done),
                    Err(why) => self.fail(why),
                }
            }
            FileAction::AskPath(dialog) => {
                self.files.take_after_save();
                return Some(Effect::ChoosePath(dialog));
            }
            FileAction::ChoosePath => {
                return self.shell.path_dialog().cloned().map(Effect::ChoosePath);
            }
            FileAction::ChoseNothing => {
                self.files.take_after_save();
                self.shell.set_choosing(false);
                self.say("No file was chosen");
            }
            FileAction::NoSystemDialog(dialog) => self.ask_in_program(dialog),
            FileAction::Open { path, options } => {
                self.shell.set_choosing(false);
                if !matches!(self.shell.path_dialog(), Some(PathDialog::Open { .. })) {
                    self.shell.take_dialog();
                }
                self.files.set_opening(&path);
                return Some(Effect::Open { path, options });
            }
            FileAction::Opened { document, file, contents } => {
                let seems_z_up = file.is_none() && document.looks_z_up();
                let remark = self.files.take_remark();
                self.replace_document(*document, file);
                self.files.set_contents(contents.clone());
                self.files.set_seems_z_up(seems_z_up);
                remark.into_iter().for_each(|remark| self.say(remark));
                if let Some(contents) = contents.filter(|it| it.asks()) {
                    self.open_dialog(Dialog::ChooseContents(contents));
                }
            }
            FileAction::NotOpened { path, why } => self.fail_open(&path, &why),
            FileAction::LocateSkin(path) => {
                self.shell.take_dialog();
                self.shell.set_choosing(false);
                return Some(Effect::LocateSkin(path));
            }
            FileAction::SkinLocated { path, before, read } => {
                self.take_located_skin(&path, before.as_ref(), *read);
            }
            FileAction::Save => {
                self.files.take_after_save();
                return self.save();
            }
            FileAction::SaveAs(path) => {
                self.shell.take_dialog();
                self.shell.set_choosing(false);
                self.end_glide();
                return Some(Effect::Save(path));
            }
            FileAction::Saved(path) => return self.finish_save(path),
            FileAction::NotSaved { path, why } => self.fail_save(&path, &why),
            FileAction::SaveAnd(then) => {
                self.shell.take_dialog();
                self.files.set_after_save(then);
                return self.save();
            }
            FileAction::Discard(then) => {
                self.shell.take_dialog();
                return self.apply_confirmed_file(*then);
            }
            FileAction::Recover { document, file } => self.recover(*document, file),
            FileAction::DeclineRecovery => {
                self.shell.take_dialog();
                self.files.settle_recovery();
            }
            FileAction::DeclineTurn => self.files.set_seems_z_up(false),
            FileAction::OpenExample(example) => self.open_example(example),
            FileAction::New => self.replace_document(new_document(), None),
            FileAction::NewSkeleton => self.new_skeleton(),
            FileAction::Quit => return Some(Effect::Quit),
        }
        None
    }

    fn open_example(&mut self, example: Example) {
        match example.open() {
            Ok(opened) => {
                let plays = opened.document.follows_path() && opened.document.is_animated();
                self.replace_document(opened.document, None);
                if plays {
                    self.apply_playback(PlaybackAction::Play(true));
                }
                if example.group == Group::InsideSolver {
                    self.apply_solver(SolverAction::Step);
                    self.apply_solver(SolverAction::ShowPart { iteration: 1, part: Some(0) });
                }
                self.say(example.sentence);
            }
            Err(error) => self.fail(error.to_string()),
        }
    }

    fn new_skeleton(&mut self) {
        let document = Document { rig: RigKind::Skeleton, ..Document::default() };
        self.replace_document(document, None);
        self.select(vec![JointId::new(0)]);
        // Frames a sphere that a skeleton of one or two units fits into.
        self.set_camera(self.settled_camera().framing(Vec3::Y * 0.5, 1.0, ASPECT));
    }

    /// The running export; `None` if there is none.
    pub fn export_job(&self) -> Option<&ExportJob> {
        self.files.job()
    }

    /// The dialog that asks where to save the document.
    pub fn save_as_dialog(&self) -> PathDialog {
        PathDialog::SaveAs { path: format!("{}.json", self.file_stem()), problem: None }
    }

    /// The dialog that asks where to save a picture of the viewport.
    pub fn save_picture_dialog(&self) -> PathDialog {
        PathDialog::SavePicture { path: format!("{}.png", self.file_stem()) }
    }

    /// Name for files of the document, without an extension.
    fn file_stem(&self) -> String {
        let stem = self.files.origin().and_then(Path::file_stem);
        stem.map_or("ik-arm".into(), |stem| stem.to_string_lossy()).into_owned()
    }

    /// The dialog for an export of the document, with default settings.
    pub fn export_dialog(&self) -> PathDialog {
        const SIZE: (u32, u32) = (1280, 800);
        PathDialog::Export(Export {
            path: format!("{}.glb", self.file_stem()).into(),
            frame_rate: self.document().timeline.frame_rate,
            size: SIZE,
        })
    }

    pub(super) fn export(&mut self, export: Export) -> Option<Effect> {
        if self.files.job().is_some() {
            self.say("Another export is running; cancel it or wait");
            return None;
        }
        self.shell.take_dialog();
        self.files.remember_export_folder(&export.path);
        Some(Effect::Export(export))
    }

    /// Whether an export runs and is not cancelled.
    pub(super) fn is_exporting(&self) -> bool {
        self.files.job().is_some_and(|job| !job.progress.is_cancelled())
    }

    /// Cancels the export and quits.
    pub(super) fn stop_export_and_quit(&mut self) -> Option<Effect> {
        self.shell.take_dialog();
        self.cancel_export();
        self.apply_file(FileAction::Quit)
    }

    pub(super) fn cancel_export(&mut self) {
        if let Some(job) = self.files.job() {
            job.progress.cancel();
            self.say("Cancelling the export …");
        }
    }
}
