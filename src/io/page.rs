//! Files of a page in a browser, in place of those of a disk: the files that the user gave to the page,
//! and downloads.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::io::{self, Cursor, Read, Take, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use js_sys::{Array, Uint8Array};
use wasm_bindgen::JsCast as _;
use web_sys::{Blob, HtmlAnchorElement, Url};

use super::error::WriteError;

/// Bytes of the files by their names. A file that was given again replaces the earlier one.
static FILES: Mutex<BTreeMap<PathBuf, Arc<[u8]>>> = Mutex::new(BTreeMap::new());

fn files() -> MutexGuard<'static, BTreeMap<PathBuf, Arc<[u8]>>> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps a file that the user gave to the page, to be opened by its name.
pub fn keep(name: &Path, bytes: Vec<u8>) {
    files().insert(name.to_owned(), bytes.into());
}

/// Opens a file for reading.
///
/// # Errors
///
/// Fails if the user has not given the file to the page.
pub fn open_regular(path: &Path) -> io::Result<Take<Cursor<Arc<[u8]>>>> {
    let bytes = files().get(path).cloned().ok_or_else(|| {
        io::Error::new(io::ErrorKind::NotFound, "drop it on the page together with the first file")
    })?;
    let length = bytes.len() as u64;
    Ok(Cursor::new(bytes).take(length))
}

/// The name of a file, which serves as its path.
pub fn absolute(path: &Path) -> Option<PathBuf> {
    Some(path.to_owned())
}

/// The same path: there are no links.
pub fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    Ok(path.to_owned())
}

/// The length of a file, by which a change of its content is recognized.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp {
    length: usize,
}

impl FileStamp {
    /// The stamp of a file as it is now; `None` if there is no such file.
    pub fn of(path: &Path) -> Option<Self> {
        Some(Self { length: files().get(path)?.len() })
    }
}

/// Downloads a file, and keeps it as if the user had given it to the page.
///
/// # Errors
///
/// Fails if the browser refuses the download.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    download(&name, bytes).map_err(|refused| WriteError::Write {
        path: path.display().to_string(),
        source: io::Error::other(format!("the browser refuses the download: {refused:?}")),
    })?;
    keep(path, bytes.to_vec());
    Ok(())
}

fn download(name: &str, bytes: &[u8]) -> Result<(), wasm_bindgen::JsValue> {
    let parts = Array::of1(&Uint8Array::from(bytes));
    let address = Url::create_object_url_with_blob(&Blob::new_with_u8_array_sequence(&parts)?)?;
    let document = web_sys::window().and_then(|window| window.document());
    let Some(document) = document else { return Ok(()) };
    let link: HtmlAnchorElement = document.create_element("a")?.unchecked_into();
    link.set_href(&address);
    link.set_download(name);
    link.click();
    Url::revoke_object_url(&address)
}

/// A file that is written piece by piece: until it is finished, nothing is downloaded.
#[derive(Debug)]
pub struct NewFile {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl NewFile {
    /// Begins a file.
    ///
    /// # Errors
    ///
    /// Never; a disk may refuse it.
    pub fn at(path: &Path) -> Result<Self, WriteError> {
        Ok(Self { path: path.to_owned(), bytes: Vec::new() })
    }

    /// Downloads the file.
    ///
    /// # Errors
    ///
    /// Fails if the browser refuses the download.
    pub fn finish(self) -> Result<(), WriteError> {
        write(&self.path, &self.bytes)
    }
}

impl Write for NewFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Files that are downloaded all together or not at all.
#[derive(Debug)]
pub struct FileBatch {
    folder: PathBuf,
    files: Mutex<Vec<(OsString, Vec<u8>)>>,
}

impl FileBatch {
    /// Returns a batch without files.
    ///
    /// # Errors
    ///
    /// Never; a disk may refuse it.
    pub fn beside(path: &Path) -> Result<Self, WriteError> {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Self { folder, files: Mutex::default() })
    }

    /// Adds a file.
    ///
    /// # Errors
    ///
    /// Never; a disk may refuse it.
    pub fn add(&self, name: &OsStr, bytes: &[u8]) -> Result<(), WriteError> {
        let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        files.push((name.to_owned(), bytes.to_vec()));
        Ok(())
    }

    /// Downloads all files.
    ///
    /// # Errors
    ///
    /// Fails if the browser refuses a download.
    pub fn finish(self) -> Result<(), WriteError> {
        let files = self.files.into_inner().unwrap_or_else(PoisonError::into_inner);
        files.iter().try_for_each(|(name, bytes)| write(&self.folder.join(name), bytes))
    }
}
