use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::WriteError;
use super::write::{failed, folder_of};

/// Several files in one folder that are written all or none, by way of a temporary folder beside
/// them.
///
/// Existing files are replaced only at the end, and restored if one of them cannot be replaced.
#[derive(Debug)]
pub struct FileBatch {
    folder: PathBuf,
    /// Holds the new files until the end, then the replaced ones in [`BACKUP`]; deleted with the
    /// batch.
    temporary: TempDir,
    names: Vec<OsString>,
}

/// Subfolder of the files that are replaced.
const BACKUP: &str = "before";

impl FileBatch {
    /// A batch without files, in the folder of a file.
    ///
    /// # Errors
    ///
    /// Fails if the folder cannot be written to.
    pub fn beside(path: &Path) -> Result<Self, WriteError> {
        let folder = folder_of(path)?;
        let temporary = tempfile::Builder::new()
            .prefix(".ik-arm-")
            .tempdir_in(&folder)
            .map_err(|source| failed(path, source))?;
        fs::create_dir(temporary.path().join(BACKUP)).map_err(|source| failed(path, source))?;
        Ok(Self { folder, temporary, names: Vec::new() })
    }

    /// Adds a file. Its name must differ from those of the others.
    ///
    /// # Errors
    ///
    /// Fails if it cannot be written.
    pub fn add(&mut self, name: &OsStr, bytes: &[u8]) -> Result<(), WriteError> {
        let path = self.new_path(name);
        fs::write(path, bytes).map_err(|source| failed(&self.folder.join(name), source))?;
        self.names.push(name.to_owned());
        Ok(())
    }

    /// Moves all files to the folder.
    ///
    /// # Errors
    ///
    /// Fails if one cannot be moved. The folder is then restored as far as possible.
    pub fn finish(self) -> Result<(), WriteError> {
        for (index, name) in self.names.iter().enumerate() {
            if let Err(source) = self.install(name) {
                self.names[..index].iter().rev().for_each(|name| self.restore(name));
                return Err(failed(&self.folder.join(name), source));
            }
        }
        Ok(())
    }

    fn install(&self, name: &OsStr) -> io::Result<()> {
        let (path, backup) = (self.folder.join(name), self.backup_path(name));
        match fs::symlink_metadata(&path) {
            Ok(existing) if existing.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
            Ok(_) => fs::rename(&path, &backup)?,
            Err(_) => {}
        }
        fs::rename(self.new_path(name), &path).inspect_err(|_| {
            let _ = fs::rename(&backup, &path);
        })
    }

    fn restore(&self, name: &OsStr) {
        let path = self.folder.join(name);
        // The error that led here is the one to report.
        let _ = fs::remove_file(&path);
        let _ = fs::rename(self.backup_path(name), &path);
    }

    fn new_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.path().join(name)
    }

    fn backup_path(&self, name: &OsStr) -> PathBuf {
        self.temporary.path().join(BACKUP).join(name)
    }
}
