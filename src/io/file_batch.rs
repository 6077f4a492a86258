use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::WriteError;
use super::temporary_file::{REPLACED, TemporaryFolder};
use super::write::{check_writable, failed, folder_of, take_over};

/// Files of one folder that are written all together or not at all. They are first written to a
/// temporary folder inside that folder.
///
/// Only [`FileBatch::finish`] replaces existing files. It restores them if one of them cannot be
/// replaced.
#[derive(Debug)]
pub struct FileBatch {
    folder: PathBuf,
    /// Temporary folder of the new files, with the subfolder [`REPLACED`] for the files that they
    /// replace. Deleted when the batch is dropped.
    temporary: TemporaryFolder,
    names: Mutex<Vec<OsString>>,
}

impl FileBatch {
    /// Returns a batch without files, for the folder that contains the file `path`.
    ///
    /// # Errors
    ///
    /// Fails if the folder cannot be written to.
    pub fn beside(path: &Path) -> Result<Self, WriteError> {
        let folder = folder_of(path)?;
        let temporary = TemporaryFolder::new(&folder).map_err(|source| failed(path, source))?;
        Ok(Self { folder, temporary, names: Mutex::default() })
    }

    /// Adds a file. Its name must differ from the names of the other files in the batch. Several
    /// threads can add files at once.
    ///
    /// # Errors
    ///
    /// Fails if the file cannot be written.
    pub fn add(&self, name: &OsStr, bytes: &[u8]) -> Result<(), WriteError> {
        let path = self.new_path(name);
        fs::write(path, bytes).map_err(|source| failed(&self.folder.join(name), source))?;
        self.names.lock().unwrap_or_else(PoisonError::into_inner).push(name.to_owned());
        Ok(())
    }

    /// Moves all files from the temporary folder to their final folder.
    ///
    /// # Errors
    ///
    /// Fails if a file cannot be moved. The final folder is then restored as far as possible.
    pub fn finish(self) -> Result<(), WriteError> {
        let names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        for (index, name) in names.iter().enumerate() {
            if let Err(source) = self.install(name) {
                names[..index].iter().rev().for_each(|name| self.restore(name));
                return Err(failed(&self.folder.join(name), source));
            }
        }
        Ok(())
    }

    fn install(&self, name: &OsStr) -> io::Result<()> {
        let (path, backup) = (self.folder.join(name), self.backup_path(name));
        match fs::symlink_metadata(&path) {
            Ok(existing) if existing.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(existing) => {
                if existing.is_file() {
                    check_writable(&path, &existing)?;
                    take_over(&fs::File::open(self.new_path(name))?, &existing)?;
                }
                fs::rename(&path, &backup)?;
            }
            Err(_) => {}
        }
        fs::rename(self.new_path(name), &path).inspect_err(|_| {
            let _ = fs::rename(&backup, &path);
        })
    }

    fn restore(&self, name: &OsStr) {
        let path = self.folder.join(name);
        // Errors are ignored, because the caller already has an error to report.
        let _ = fs::remove_file(&path);
        let _ = fs::rename(self.backup_path(name), &path);
    }

    fn new_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.folder.path().join(name)
    }

    fn backup_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.folder.path().join(REPLACED).join(name)
    }
}
