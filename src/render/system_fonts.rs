use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

use egui::epaint::text::{Blob, FallbackRequest, FontInsert, FontProvider};
use egui::{FontData, FontFamily};
use fontdb::{Database, FaceInfo, Family, ID, Source, Stretch, Style, Weight};
use skrifa::MetadataProvider as _;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;
use skrifa::outline::pen::PathElement;

/// Finds fonts installed on this system, for letters that the built-in fonts lack.
///
/// The first search reads the character maps of all installed fonts, which may take a tenth of a
/// second; later ones look the letter up in a table. Once a font is found, it serves for all of its
/// letters, also where another font is preferred: pictures depend on the letters drawn before.
pub fn system_fonts() -> Arc<dyn FontProvider> {
    Arc::new(|request: &FallbackRequest<'_>| installed().find(request.cluster.chars().next()?))
}

/// The family of the most preferred installed font that has a letter; `None` if no installed font
/// has it. Only [`FamilyFonts`] knows these families.
pub(super) fn family_of(letter: char) -> Option<FontFamily> {
    installed().number(letter).map(|number| FontFamily::Name(number.to_string().into()))
}

/// Gives each family of [`family_of`] its font. What is drawn depends only on the text and on the
/// installed fonts.
pub(super) struct FamilyFonts;

impl FontProvider for FamilyFonts {
    fn fonts_for_family(&self, family: &FontFamily) -> Vec<FontInsert> {
        let FontFamily::Name(name) = family else { return Vec::new() };
        let number = name.parse::<usize>().ok();
        number.and_then(|number| installed().face(number)).into_iter().collect()
    }
}

fn installed() -> MutexGuard<'static, SystemFonts> {
    static INSTALLED: LazyLock<Mutex<SystemFonts>> = LazyLock::new(|| {
        let mut database = Database::new();
        database.load_system_fonts();
        Mutex::new(SystemFonts::new(database))
    });
    INSTALLED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// All faces in order of preference, with a table of their letters.
struct SystemFonts {
    database: Database,
    faces: Vec<ID>,
    /// For each code point, 1 plus the index of the first face that has it, or 0 if no face has it.
    first: Vec<u16>,
    files: HashMap<PathBuf, Blob>,
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
        Self { database, faces, first, files: HashMap::new(), bytes: 0 }
    }

    /// The most preferred face that has a letter; `None` if no installed face has it, or its file
    /// cannot be loaded.
    fn find(&mut self, letter: char) -> Option<FontInsert> {
        self.face(self.number(letter)?)
    }

    /// Index of the most preferred face that has a letter; `None` if no installed face has it.
    fn number(&self, letter: char) -> Option<usize> {
        self.first[letter as usize].checked_sub(1).map(usize::from)
    }

    /// The face with an index; `None` without such a face, or if its file cannot be loaded.
    fn face(&mut self, number: usize) -> Option<FontInsert> {
        let (source, index) = self.database.face_source(*self.faces.get(number)?)?;
        let data = self.load(source)?;
        // Epaint panics at the font of a family that cannot be parsed.
        skrifa::FontRef::from_index(data.as_ref().as_ref(), index).ok()?;
        Some(FontInsert::new(&format!("system {number}"), FontData::from_blob(data, index), vec![]))
    }

    /// Contents of a font file, which are read once and shared by all faces of the file; `None` if
    /// the file cannot be read or would exceed `MAX_BYTES`.
    fn load(&mut self, source: Source) -> Option<Blob> {
        let path = match source {
            Source::File(path) | Source::SharedFile(path, _) => path,
            Source::Binary(data) => return Some(data),
        };
        if let Some(data) = self.files.get(&path) {
            return Some(Arc::clone(data));
        }
        let warn = |error: &_| log::warn!("cannot read font {}: {error}", path.display());
        let data = std::fs::read(&path).inspect_err(warn).ok()?;
        if self.bytes + data.len() > Self::MAX_BYTES {
            log::warn!(
                "font files are limited to {} bytes; some letters are not shown",
                Self::MAX_BYTES
            );
            return None;
        }
        self.bytes += data.len();
        let data: Blob = Arc::new(data);
        self.files.insert(path, Arc::clone(&data));
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
    let Ok(font) = skrifa::FontRef::from_index(data, index) else {
        return;
    };
    let (map, outlines) = (font.charmap(), font.outline_glyphs());
    let has_outline = |(_, glyph)| {
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        let mut path: Vec<PathElement> = Vec::new();
        let outline = outlines.get(glyph);
        outline.is_some_and(|it| it.draw(settings, &mut path).is_ok() && !path.is_empty())
    };
    if map.is_symbol() || !map.mappings().take(SAMPLE).any(has_outline) {
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
    use egui::FontDefinitions;

    use super::*;

    const HACK: &str = "Hack";
    const ICONS: &str = "egui-icons";
    const UBUNTU: &str = "Ubuntu-Light";
    /// A letter that only the icons have.
    const GITHUB: char = '\u{e624}';

    /// A font that comes with egui.
    fn built_in(name: &str) -> Arc<FontData> {
        Arc::clone(&FontDefinitions::default().font_data[name])
    }

    fn fonts(files: [Arc<FontData>; 3]) -> SystemFonts {
        let mut database = Database::new();
        for file in files {
            database.load_font_source(Source::Binary(Arc::clone(&file.font)));
        }
        SystemFonts::new(database)
    }

    #[test]
    fn a_letter_comes_from_a_face_that_has_it() {
        let mut fonts = fonts([HACK, ICONS, UBUNTU].map(built_in));
        for (letter, file) in [
            ('a', HACK), // the other face is light
            ('─', HACK),
            ('ƕ', UBUNTU),
            (GITHUB, ICONS),
        ] {
            let found = fonts.find(letter).expect("a face");
            assert!(found.data.bytes() == built_in(file).bytes(), "{letter}");
            assert_eq!(found.data.index, 0);
            assert_eq!(fonts.find(letter).expect("a face").name, found.name);
        }
        assert!(fonts.find('左').is_none());
        assert!(fonts.find(char::MAX).is_none());
    }

    #[test]
    fn the_order_of_the_files_does_not_matter() {
        let mut one = fonts([HACK, ICONS, UBUNTU].map(built_in));
        let mut other = fonts([ICONS, UBUNTU, HACK].map(built_in));
        for letter in '\0'..='\u{2fff}' {
            let size = |fonts: &mut SystemFonts| fonts.find(letter).map(|it| it.data.bytes().len());
            assert_eq!(size(&mut one), size(&mut other), "{letter:?}");
        }
    }

    #[test]
    fn no_fonts_and_files_that_are_none_have_no_letters() {
        assert!(SystemFonts::new(Database::new()).find('a').is_none());
        let none = Arc::new(FontData::from_static(b"no font"));
        let half = Arc::new(FontData::from_owned(built_in(UBUNTU).bytes()[..2000].to_vec()));
        assert!(fonts([none.clone(), half, none]).find('a').is_none());
    }

    #[test]
    fn a_file_that_is_gone_has_no_letters() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.ttf");
        std::fs::write(&path, built_in(UBUNTU).bytes()).expect("written");
        let mut database = Database::new();
        database.load_font_file(&path).expect("a font");
        let mut fonts = SystemFonts::new(database);
        drop(folder);
        assert!(fonts.find('a').is_none());
    }
}
