use std::path::{Path, PathBuf};

use super::action::{Export, ExportJob, FileAction, FileContents, PathDialog};
use crate::document::Document;
use crate::io::{FileStamp, Upwards};
use crate::session::dialog::Dialog;
use crate::session::outcome::{Consequence, Effect, Opening, Outcome};

/// The document's file, recent files, the running export and pending requests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Files {
    file: Option<PathBuf>,
    /// The stamp of `file` when it was last opened or saved; `None` if there was no such file.
    stamp: Option<FileStamp>,
    recent: Vec<PathBuf>,
    export_folder: Option<PathBuf>,
    job: Option<ExportJob>,
    /// True if an earlier run's unsaved document was opened or declined.
    recovery_settled: bool,
    /// The message once the file that was read is open.
    remark: Option<String>,
    /// The file that the user chose to open, with its stamp from before it was read.
    opening_stamp: Option<(PathBuf, FileStamp)>,
    /// Further contents of the other program's file from which the document comes.
    contents: Option<Box<FileContents>>,
    /// True if z seems to point up in the document's file, and this was not settled yet.
    seems_z_up: bool,
    /// The action to apply once the document is saved; `None` if no action waits.
    after_save: Option<Box<FileAction>>,
}

impl Files {
    /// Maximum number of recent files.
    const MOST_RECENT: usize = 10;

    /// The state after another document was opened: `file` is its file, pending requests are
    /// dropped, and the rest is kept.
    pub(in crate::session) fn replaced(&mut self, file: Option<PathBuf>) -> Self {
        let opening = self.opening_stamp.take().filter(|(path, _)| file.as_ref() == Some(path));
        let stamp = opening.map(|(_, stamp)| stamp);
        let stamp = stamp.or_else(|| FileStamp::of(file.as_deref()?));
        Self {
            file,
            stamp,
            recent: std::mem::take(&mut self.recent),
            export_folder: self.export_folder.take(),
            job: self.job.take(),
            recovery_settled: self.recovery_settled,
            remark: None,
            opening_stamp: None,
            contents: None,
            seems_z_up: false,
            after_save: None,
        }
    }

    /// The skeletons and animations of the file of another program that the document comes from.
    pub fn contents(&self) -> Option<&FileContents> {
        self.contents.as_deref()
    }

    /// True if z seems to point up in the file of the document, which was not turned yet.
    pub fn seems_z_up(&self) -> bool {
        self.seems_z_up
    }

    /// Takes z as up when other animations of the file are opened.
    pub(in crate::session) fn take_z_as_up(&mut self) {
        self.seems_z_up = false;
        if let Some(contents) = &mut self.contents {
            contents.options.up = Some(Upwards::Z);
        }
    }

    /// The file that the document was opened from or saved to; `None` for a new or imported
    /// document.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Files that were opened or saved, the most recent first.
    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    /// The folder of the last export or picture; `None` before the first.
    pub fn export_folder(&self) -> Option<&Path> {
        self.export_folder.as_deref()
    }

    /// The running export; `None` if there is none.
    pub fn job(&self) -> Option<&ExportJob> {
        self.job.as_ref()
    }

    /// True if the unsaved document of an earlier run was opened or declined.
    pub fn has_settled_recovery(&self) -> bool {
        self.recovery_settled
    }

    /// True if another program has changed the document's file since it was last opened or saved.
    pub fn has_changed(&self) -> bool {
        let now = self.file.as_deref().and_then(FileStamp::of);
        now.is_some() && now != self.stamp
    }

    pub(in crate::session) fn restore(
        &mut self,
        recent: Vec<PathBuf>,
        export_folder: Option<PathBuf>,
    ) {
        (self.recent, self.export_folder) = (recent, export_folder);
        self.recent.truncate(Self::MOST_RECENT);
    }

    /// Puts a file at the front of the recent files.
    pub(in crate::session) fn remember(&mut self, path: PathBuf) {
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(Self::MOST_RECENT);
    }

    /// Remembers the folder of an exported file or picture for the next export.
    pub(in crate::session) fn remember_export_folder(&mut self, path: &Path) {
        let full = std::path::absolute(path).ok();
        if let Some(folder) = full.as_deref().and_then(Path::parent) {
            self.export_folder = Some(folder.to_owned());
        }
    }

    /// The file that the document comes from: its own, or that of another program.
    pub fn origin(&self) -> Option<&Path> {
        let imported = self.contents.as_ref().map(|contents| contents.path.as_path());
        self.file().or(imported)
    }

    /// Folder of the file that the document comes from; without one, of the most recent file.
    pub fn document_folder(&self) -> Option<&Path> {
        let last = self.origin().or(self.recent.first().map(PathBuf::as_path))?;
        last.parent().filter(|folder| folder.is_absolute())
    }

    pub(in crate::session) fn set_remark(&mut self, remark: Option<String>) {
        self.remark = remark;
    }

    /// Name of the document: its file's, or without the extension that of the file of another
    /// program that it was imported from; `None` for a new document.
    pub fn name(&self) -> Option<String> {
        let own = self.file().and_then(Path::file_name);
        let imported = || self.origin().and_then(Path::file_stem);
        Some(own.or_else(imported)?.to_string_lossy().into_owned())
    }

    /// The dialog that asks where to save the document.
    pub fn save_as_dialog(&self) -> PathDialog {
        PathDialog::SaveAs { path: format!("{}.json", self.file_stem()), problem: None }
    }

    /// The dialog that asks where to save a picture of the viewport.
    pub fn save_picture_dialog(&self) -> PathDialog {
        PathDialog::SavePicture { path: format!("{}.png", self.file_stem()) }
    }

    /// The dialog for an export of the document, with default settings.
    pub fn export_dialog(&self, document: &Document) -> PathDialog {
        const SIZE: (u32, u32) = (1280, 800);
        PathDialog::Export(Export {
            path: format!("{}.glb", self.file_stem()).into(),
            frame_rate: document.timeline.frame_rate,
            size: SIZE,
        })
    }

    /// Name for files of the document, without an extension.
    fn file_stem(&self) -> String {
        let stem = self.origin().and_then(Path::file_stem);
        stem.map_or("ik-arm".into(), |stem| stem.to_string_lossy()).into_owned()
    }

    /// Replaces the contents that the file of another program has, and whether z seems to point up.
    pub(in crate::session) fn set_origin(
        &mut self,
        contents: Option<Box<FileContents>>,
        seems_z_up: bool,
    ) {
        (self.contents, self.seems_z_up) = (contents, seems_z_up);
    }

    /// Drops the action that waits for the document to be saved.
    pub(in crate::session) fn forget_after_save(&mut self) {
        self.after_save = None;
    }

    /// True if an export runs and is not cancelled.
    pub(in crate::session) fn is_exporting(&self) -> bool {
        self.job.as_ref().is_some_and(|job| !job.progress.is_cancelled())
    }

    /// Resolves a path typed into `dialog`. A relative path of an export or a picture is in the
    /// folder of the last export or picture; any other is in the document's folder.
    pub fn full_path(&self, dialog: &PathDialog, typed: &Path) -> PathBuf {
        let in_folder = |folder: &Path| folder.join(typed);
        let full = match dialog {
            PathDialog::Export(_) | PathDialog::SavePicture { .. } => {
                // The folder of the last export may be gone, or was never there.
                let exported = self.export_folder().filter(|folder| folder.is_dir());
                exported.or(self.document_folder()).map(in_folder)
            }
            PathDialog::SaveAs { .. } => self.document_folder().map(in_folder),
            // A file that exists relative to the current folder takes precedence.
            PathDialog::Open { .. } | PathDialog::LocateSkin { .. } if !typed.exists() => {
                self.document_folder().map(in_folder)
            }
            PathDialog::Open { .. } | PathDialog::LocateSkin { .. } => None,
        };
        full.unwrap_or_else(|| typed.to_owned())
    }

    /// The folder in which a path typed into `dialog` lies, also before anything is typed.
    pub fn folder_of(&self, dialog: &PathDialog) -> PathBuf {
        let typed = dialog.path();
        let any = Path::new("untitled");
        let typed = if typed.as_os_str().is_empty() { any } else { typed };
        let full = self.full_path(dialog, typed);
        let full = std::path::absolute(&full).unwrap_or(full);
        full.parent().map(Path::to_owned).unwrap_or_default()
    }
}

/// Actions on files.
impl Files {
    /// Applies an action; `dialog` is the open one. Actions for which the document, the skeleton or
    /// an example is needed are returned.
    pub(in crate::session) fn apply(
        &mut self,
        action: FileAction,
        dialog: Option<&Dialog>,
    ) -> Result<Outcome, FileAction> {
        Ok(match action {
            FileAction::SavePicture(path) => {
                self.remember_export_folder(path.as_ref());
                closed()
                    .and(Consequence::SetChoosing(false))
                    .and(Outcome::say(format!("Saving {path} …")))
                    .and(Effect::SavePicture(path))
            }
            FileAction::Export(export) => self.export(export),
            FileAction::ExportStarted(job) => self.set_job(Some(job)),
            FileAction::CancelExport => self.cancel_export(),
            FileAction::StopExportAndQuit => closed()
                .and(self.cancel_export())
                .and(Consequence::File(Box::new(FileAction::Quit))),
            FileAction::ExportEnded(how) => {
                let asks = dialog == Some(&Dialog::Exporting);
                self.set_job(None)
                    .and(asks.then_some(Consequence::TakeDialog))
                    .and(how.map_or_else(Outcome::fail, Outcome::say))
            }
            FileAction::AskPath(asked) => {
                self.after_save = None;
                Effect::ChoosePath(asked).into()
            }
            FileAction::ChoosePath => match dialog {
                Some(Dialog::Path(asked)) => Effect::ChoosePath(asked.clone()).into(),
                _ => Outcome::default(),
            },
            FileAction::ChoseNothing => {
                self.after_save = None;
                Outcome::from(Consequence::SetChoosing(false))
                    .and(Outcome::say("No file was chosen"))
            }
            FileAction::NoSystemDialog(asked) => ask_in_program(asked, dialog),
            FileAction::Open { path, options } => {
                let is_asked = matches!(dialog, Some(Dialog::Path(PathDialog::Open { .. })));
                self.opening_stamp = FileStamp::of(&path).map(|stamp| (path.clone(), stamp));
                Outcome::from(Consequence::SetChoosing(false))
                    .and((!is_asked).then_some(Consequence::TakeDialog))
                    .and(Effect::Open { path, options })
            }
            FileAction::Opened { document, file, contents } => {
                let remark = self.remark.take().map(Outcome::say);
                let asks = contents.clone().filter(|it| it.asks()).map(Dialog::ChooseContents);
                let seems_z_up = file.is_none() && document.looks_z_up();
                let opening = Opening { document: *document, file, contents, seems_z_up };
                Outcome::from(Consequence::Open(Box::new(opening)))
                    .and(remark)
                    .and(asks.map(|dialog| Consequence::OpenDialog(Box::new(dialog))))
            }
            FileAction::NotOpened { path, why } => not_opened(&path, why, dialog),
            FileAction::LocateSkin(path) => {
                closed().and(Consequence::SetChoosing(false)).and(Effect::LocateSkin(path))
            }
            FileAction::Save => {
                self.after_save = None;
                self.save()
            }
            FileAction::SaveAs(path) => closed()
                .and(Consequence::SetChoosing(false))
                .and(Consequence::EndGlide)
                .and(Effect::Save(path)),
            FileAction::Saved(path) => self.saved(path),
            FileAction::NotSaved { path, why } => {
                self.after_save = None;
                let asked = PathDialog::SaveAs {
                    path: path.display().to_string(),
                    problem: Some(why.clone()),
                };
                Outcome::fail(format!("not saved: {why}"))
                    .and(Consequence::OpenDialog(Box::new(asked.into())))
            }
            FileAction::SaveAnd(then) => {
                self.after_save = Some(then);
                closed().and(self.save())
            }
            FileAction::Discard(then) => closed().and(Consequence::ConfirmedFile(then)),
            FileAction::Recover { document, file } => {
                self.recovery_settled = true;
                let opening = Opening { document: *document, file, ..Opening::default() };
                Outcome::from(Consequence::Open(Box::new(opening)))
                    .and(Consequence::MarkSaved(false))
                    .and(Outcome::say("The unsaved document is open; save it"))
            }
            FileAction::DeclineRecovery => {
                self.recovery_settled = true;
                closed()
            }
            FileAction::DeclineTurn => {
                self.seems_z_up = false;
                Outcome::default()
            }
            FileAction::New => Consequence::Open(Box::default()).into(),
            FileAction::Quit => Effect::Quit.into(),
            action @ (FileAction::SkinLocated { .. }
            | FileAction::OpenExample(_)
            | FileAction::CopyLink
            | FileAction::NewFigure
            | FileAction::NewEmpty) => return Err(action),
        })
    }

    fn export(&mut self, export: Export) -> Outcome {
        if self.job.is_some() {
            return Outcome::say("Another export is running; cancel it or wait");
        }
        self.remember_export_folder(&export.path);
        closed().and(Effect::Export(export))
    }

    fn cancel_export(&self) -> Outcome {
        let Some(job) = &self.job else { return Outcome::default() };
        job.progress.cancel();
        Outcome::say("Cancelling the export …")
    }

    fn set_job(&mut self, job: Option<ExportJob>) -> Outcome {
        self.job = job;
        Outcome::default()
    }

    /// Saves the document to its file, or asks for a path if the document has no file. Asks first
    /// if another program has changed the file.
    fn save(&self) -> Outcome {
        let settled = Outcome::from(Consequence::EndGlide);
        match self.file.clone() {
            None => settled.and(Effect::ChoosePath(self.save_as_dialog())),
            Some(path) if self.has_changed() => {
                settled.and(Consequence::OpenDialog(Box::new(Dialog::FileChanged { path })))
            }
            Some(path) => settled.and(Effect::Save(path)),
        }
    }

    /// Counts the document as saved and applies the action that waited for that.
    fn saved(&mut self, path: PathBuf) -> Outcome {
        let said = Outcome::say(format!("Saved {}", path.display()));
        self.remember(path.clone());
        self.stamp = FileStamp::of(&path);
        self.file = Some(path);
        said.and(Consequence::Commit)
            .and(Consequence::MarkSaved(true))
            .and(self.after_save.take().map(Consequence::File))
    }
}

fn closed() -> Outcome {
    Consequence::TakeDialog.into()
}

/// Opens the program's own dialog, because the system has no file dialog. If a dialog of the
/// program is open already, asks to type the path there.
fn ask_in_program(asked: PathDialog, dialog: Option<&Dialog>) -> Outcome {
    if dialog.is_some() {
        Outcome::from(Consequence::SetChoosing(false))
            .and(Outcome::fail("the system has no file dialog: type the path"))
    } else {
        Consequence::OpenDialog(Box::new(asked.into())).into()
    }
}

/// Reports the error. Unless another dialog is open, shows the error and the path in the program's
/// Open dialog.
fn not_opened(path: &Path, why: String, dialog: Option<&Dialog>) -> Outcome {
    let said = Outcome::fail(format!("not opened: {why}"));
    if !dialog.is_none_or(|it| matches!(it, Dialog::Path(PathDialog::Open { .. }))) {
        return said;
    }
    let asked = PathDialog::Open { path: path.display().to_string(), problem: Some(why) };
    said.and(Consequence::OpenDialog(Box::new(asked.into())))
}
