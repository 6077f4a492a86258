use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex, PoisonError};

use ab_glyph::Font as _;
use fontdb::{Database, FaceInfo, Family, ID, Source, Stretch, Style, Weight};
use skrifa::MetadataProvider as _;

/// A face of a font installed on this system, for letters that the built-in fonts lack.
#[derive(Clone, Copy, Debug)]
pub struct SystemFace {
    /// Number that identifies the face among all installed ones.
    pub number: u16,
    /// Contents of the font file, kept until the program ends.
    pub data: &'static [u8],
    /// Index of the face in the file.
    pub index: u32,
}

impl SystemFace {
    /// The most preferred face that has a letter; `None` if no installed face has it, or its file
    /// cannot be loaded.
    ///
    /// The first call reads the character maps of all installed fonts, which may take a tenth of a
    /// second; later calls look the letter up in a table. The result depends only on the installed
    /// fonts.
    pub fn find(letter: char) -> Option<Self> {
        static INSTALLED: LazyLock<Mutex<SystemFonts>> = LazyLock::new(|| {
            let mut database = Database::new();
            database.load_system_fonts();
            Mutex::new(SystemFonts::new(database))
        });
        INSTALLED.lock().unwrap_or_else(PoisonError::into_inner).find(letter)
    }
}

/// All faces in order of preference, with a table of their letters.
struct SystemFonts {
    database: Database,
    faces: Vec<ID>,
    /// For each code point, 1 plus the index of the first face that has it, or 0 if no face has it.
    first: Vec<u16>,
    files: HashMap<PathBuf, &'static [u8]>,
    loaded: HashMap<u16, SystemFace>,
    bytes: usize,
}

impl SystemFonts {
    /// Maximum total size of loaded files in bytes. Further files are not loaded and their letters
    /// not shown, so that a text in many scripts does not exhaust memory.
    const MAX_BYTES: usize = 256 << 20;

    fn new(database: Database) -> Self {
        let sans_serif = database.family_name(&Family::SansSerif);
        let mut infos: Vec<_> = database.faces().collect();
        infos.sort_by_cached_key(|info| rank(info, sans_serif));
        let faces: Vec<_> = infos.iter().map(|info| info.id).take(usize::from(u16::MAX)).collect();
        let mut first = vec![0; char::MAX as usize + 1];
        for (number, face) in (1..=u16::MAX).zip(&faces) {
            database.with_face_data(*face, |data, index| claim(&mut first, number, data, index));
        }
        let (files, loaded) = (HashMap::new(), HashMap::new());
        Self { database, faces, first, files, loaded, bytes: 0 }
    }

    fn find(&mut self, letter: char) -> Option<SystemFace> {
        let number = self.first[letter as usize].checked_sub(1)?;
        if let Some(face) = self.loaded.get(&number) {
            return Some(*face);
        }
        let (source, index) = self.database.face_source(self.faces[usize::from(number)])?;
        let face = SystemFace { number, data: self.load(&source)?, index };
        self.loaded.insert(number, face);
        Some(face)
    }

    /// Contents of a font file, which are read once and shared by all faces of the file; `None` if
    /// the file cannot be read or would exceed `MAX_BYTES`.
    fn load(&mut self, source: &Source) -> Option<&'static [u8]> {
        let (path, data) = match source {
            Source::File(path) | Source::SharedFile(path, _) => {
                if let Some(data) = self.files.get(path) {
                    return Some(*data);
                }
                let read = std::fs::read(path);
                let warn = |error: &_| log::warn!("cannot read font {}: {error}", path.display());
                (Some(path), read.inspect_err(warn).ok()?)
            }
            Source::Binary(data) => (None, data.as_ref().as_ref().to_vec()),
        };
        if self.bytes + data.len() > Self::MAX_BYTES {
            log::warn!(
                "font files are limited to {} bytes; some letters are not shown",
                Self::MAX_BYTES
            );
            return None;
        }
        self.bytes += data.len();
        let data: &'static [u8] = data.leak();
        self.files.extend(path.map(|path| (path.clone(), data)));
        Some(data)
    }
}

/// Sort key of a face: upright and regular faces of a sans-serif family come first, and equal ones
/// are sorted by name.
fn rank(info: &FaceInfo, sans_serif: &str) -> impl Ord + use<> {
    let family = info.families.first().map_or("", |(name, _)| name.as_str());
    (
        info.style != Style::Normal,
        info.weight.0.abs_diff(Weight::NORMAL.0),
        info.stretch != Stretch::Normal,
        // The Last Resort font claims every letter but shows only boxes.
        info.post_script_name.contains("LastResort"),
        info.monospaced,
        family != sans_serif,
        !family.contains("Sans"),
        family.to_owned(),
        info.post_script_name.clone(),
        info.index,
    )
}

/// Enters the number of a face into `first` for all letters of the face that no earlier face has.
/// Symbol fonts and faces with bitmaps only are skipped.
fn claim(first: &mut [u16], number: u16, data: &[u8], index: u32) {
    const SAMPLE: usize = 32;
    let Ok(map) = skrifa::FontRef::from_index(data, index).map(|font| font.charmap()) else {
        return;
    };
    let Ok(font) = ab_glyph::FontRef::try_from_slice_and_index(data, index) else {
        return;
    };
    let has_outline = |letter| font.outline(font.glyph_id(letter)).is_some();
    let mut letters = map.mappings().filter_map(|(code, _)| char::from_u32(code));
    if map.is_symbol() || !letters.by_ref().take(SAMPLE).any(has_outline) {
        return;
    }
    for (code, glyph) in map.mappings() {
        if let Some(0) = first.get(code as usize)
            && glyph != skrifa::GlyphId::NOTDEF
        {
            first[code as usize] = number;
        }
    }
}

#[cfg(test)]
mod tests {
    use epaint_default_fonts::{EGUI_ICONS, HACK_REGULAR, UBUNTU_LIGHT, special_emojis};

    use super::*;

    fn fonts(files: &[&[u8]]) -> SystemFonts {
        let mut database = Database::new();
        for file in files {
            database.load_font_data(file.to_vec());
        }
        SystemFonts::new(database)
    }

    #[test]
    fn a_letter_comes_from_a_face_that_has_it() {
        let mut fonts = fonts(&[HACK_REGULAR, EGUI_ICONS, UBUNTU_LIGHT]);
        for (letter, file) in [
            ('a', HACK_REGULAR), // the other face is light
            ('─', HACK_REGULAR),
            ('ƕ', UBUNTU_LIGHT),
            (special_emojis::GITHUB, EGUI_ICONS),
        ] {
            let face = fonts.find(letter).expect("a face");
            assert!(face.data == file && face.index == 0, "{letter}");
            let again = fonts.find(letter).expect("a face");
            assert_eq!((again.number, again.data.as_ptr()), (face.number, face.data.as_ptr()));
        }
        assert!(fonts.find('左').is_none());
        assert!(fonts.find(char::MAX).is_none());
    }

    #[test]
    fn the_order_of_the_files_does_not_matter() {
        let files = [HACK_REGULAR, EGUI_ICONS, UBUNTU_LIGHT];
        let mut turned = files;
        turned.rotate_left(1);
        let (mut one, mut other) = (fonts(&files), fonts(&turned));
        for letter in '\0'..='\u{2fff}' {
            let data = |fonts: &mut SystemFonts| fonts.find(letter).map(|face| face.data.len());
            assert_eq!(data(&mut one), data(&mut other), "{letter:?}");
        }
    }

    #[test]
    fn no_fonts_and_files_that_are_none_have_no_letters() {
        assert!(fonts(&[]).find('a').is_none());
        assert!(fonts(&[b"no font", &UBUNTU_LIGHT[..2000]]).find('a').is_none());
    }

    #[test]
    fn a_file_that_is_gone_has_no_letters() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.ttf");
        std::fs::write(&path, UBUNTU_LIGHT).expect("written");
        let mut database = Database::new();
        database.load_font_file(&path).expect("a font");
        let mut fonts = SystemFonts::new(database);
        drop(folder);
        assert!(fonts.find('a').is_none());
    }
}
