//! The browser's storage of this page.

use web_sys::Storage;

use super::link;

const SETTINGS: &str = "ik-arm settings";

/// The storage; `None` if the browser has none for this page, as in a private window, and for a part of
/// another page, which begins anew with each visit.
pub fn storage() -> Option<Storage> {
    if link::parts().is_some() {
        return None;
    }
    web_sys::window()?.local_storage().ok().flatten()
}

/// The settings of the last visit as text; `None` if there are none.
///
/// # Errors
///
/// Never; a disk may refuse them.
pub fn saved_settings() -> Result<Option<String>, String> {
    Ok(storage().and_then(|storage| storage.get_item(SETTINGS).ok().flatten()))
}

/// Where the settings are, for sentences.
pub fn settings_place() -> String {
    "the browser's storage".to_owned()
}

/// Saves the settings.
///
/// # Errors
///
/// If the browser refuses to store them.
pub fn save_settings(text: &str) -> Result<(), Box<dyn std::error::Error>> {
    let Some(storage) = storage() else { return Ok(()) };
    storage.set_item(SETTINGS, text).map_err(|refused| format!("{refused:?}").into())
}
