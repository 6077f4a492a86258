use std::path::{Path, PathBuf};

use super::export::ExportJob;
use super::file_action::FileAction;
use super::file_contents::FileContents;
use crate::io::{FileStamp, Upwards};

/// The document's file, recent files, the running export and pending requests.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Files {
    file: Option<PathBuf>,
    /// The stamp of `file` when it was last opened or saved; `None` if there was no such file.
    stamp: Option<FileStamp>,
    recent: Vec<PathBuf>,
    export_folder: Option<PathBuf>,
    job: Option<ExportJob>,
    /// Whether an earlier run's unsaved document was opened or declined.
    recovery_settled: bool,
    /// What to say once the file is open that was read.
    remark: Option<String>,
    /// The file that the user chose to open, with its stamp from before it was read.
    opening_stamp: Option<(PathBuf, FileStamp)>,
    /// What else the file of another program has that the document comes from.
    contents: Option<Box<FileContents>>,
    /// Whether z seems to point up in the document's file, and this was not settled yet.
    seems_z_up: bool,
    /// The action to apply once the document is saved; `None` if no action waits.
    after_save: Option<Box<FileAction>>,
}

impl Files {
    /// Maximum number of recent files.
    const MOST_RECENT: usize = 10;

    /// The state after another document was opened: `file` is its file, pending requests are
    /// dropped, and the rest is kept.
    pub fn replaced(&mut self, file: Option<PathBuf>) -> Self {
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

    pub fn contents(&self) -> Option<&FileContents> {
        self.contents.as_deref()
    }

    pub fn set_contents(&mut self, contents: Option<Box<FileContents>>) {
        self.contents = contents;
    }

    pub fn seems_z_up(&self) -> bool {
        self.seems_z_up
    }

    pub fn set_seems_z_up(&mut self, seems: bool) {
        self.seems_z_up = seems;
    }

    /// Takes z as up when other animations of the file are opened.
    pub fn take_z_as_up(&mut self) {
        self.seems_z_up = false;
        if let Some(contents) = &mut self.contents {
            contents.options.up = Some(Upwards::Z);
        }
    }

    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    pub fn recent(&self) -> &[PathBuf] {
        &self.recent
    }

    pub fn export_folder(&self) -> Option<&Path> {
        self.export_folder.as_deref()
    }

    pub fn job(&self) -> Option<&ExportJob> {
        self.job.as_ref()
    }

    pub fn has_settled_recovery(&self) -> bool {
        self.recovery_settled
    }

    /// Makes a file that was just written the document's file.
    pub fn set_saved_file(&mut self, file: PathBuf) {
        self.stamp = FileStamp::of(&file);
        self.file = Some(file);
    }

    /// Whether another program has changed the document's file since it was last opened or saved.
    pub fn has_changed(&self) -> bool {
        let now = self.file.as_deref().and_then(FileStamp::of);
        now.is_some() && now != self.stamp
    }

    pub fn set_recent(&mut self, recent: Vec<PathBuf>) {
        self.recent = recent;
        self.recent.truncate(Self::MOST_RECENT);
    }

    /// Puts a file at the front of the recent files.
    pub fn remember(&mut self, path: PathBuf) {
        let path = std::path::absolute(&path).unwrap_or(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(Self::MOST_RECENT);
    }

    pub fn set_export_folder(&mut self, folder: Option<PathBuf>) {
        self.export_folder = folder;
    }

    /// Remembers the folder of an exported file or picture for the next export.
    pub fn remember_export_folder(&mut self, path: &Path) {
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

    pub fn set_job(&mut self, job: Option<ExportJob>) {
        self.job = job;
    }

    pub fn settle_recovery(&mut self) {
        self.recovery_settled = true;
    }

    pub fn set_remark(&mut self, remark: Option<String>) {
        self.remark = remark;
    }

    pub fn take_remark(&mut self) -> Option<String> {
        self.remark.take()
    }

    pub fn set_opening(&mut self, path: &Path) {
        self.opening_stamp = FileStamp::of(path).map(|stamp| (path.to_owned(), stamp));
    }

    pub fn set_after_save(&mut self, action: Box<FileAction>) {
        self.after_save = Some(action);
    }

    pub fn take_after_save(&mut self) -> Option<Box<FileAction>> {
        self.after_save.take()
    }
}
