//! Fonts of a page: it has none of the system, so the built-in font with the most letters serves for
//! all that the others lack.

use std::sync::Arc;

use egui::epaint::text::{FallbackRequest, FontInsert, FontProvider};
use egui::{FontDefinitions, FontFamily};

/// Gives letters that the panels' fonts lack the font with the most letters.
pub fn system_fonts() -> Arc<dyn FontProvider> {
    let most = FontDefinitions::default().font_data.remove("Hack");
    Arc::new(move |_: &FallbackRequest<'_>| {
        Some(FontInsert::new("Hack of the page", (**most.as_ref()?).clone(), vec![]))
    })
}

/// No family.
pub(super) fn family_of(_: char) -> Option<FontFamily> {
    None
}

/// Has no families.
pub(super) struct FamilyFonts;

impl FontProvider for FamilyFonts {
    fn fonts_for_family(&self, _: &FontFamily) -> Vec<FontInsert> {
        Vec::new()
    }
}
