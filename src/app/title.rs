use crate::session::Session;

/// Name of the program, as in the window's title.
pub const TITLE: &str = "ik-arm";

/// Title of the window: the document's name, an asterisk for unsaved changes, and the program; during the
/// tour, the step or the title of the last card.
pub fn title(session: &Session) -> String {
    if let Some(tour) = session.tour() {
        return match tour.step() {
            Some(_) => format!("Tour, step {} – {TITLE}", tour.number() + 1),
            None => format!("Tour, {} – {TITLE}", tour.title()),
        };
    }
    let unsaved = if session.is_unsaved() { "*" } else { "" };
    match session.document_name() {
        Some(name) => format!("{name}{unsaved} – {TITLE}"),
        None if session.is_unsaved() => format!("untitled* – {TITLE}"),
        None => TITLE.to_owned(),
    }
}
