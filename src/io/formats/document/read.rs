use super::file::DocumentFields;
use super::header::{Header, VERSION};
use super::version_1;
use crate::document::RigKind;
use crate::io::error::OpenError;
use crate::io::json::FieldWarnings;
use crate::io::json::JsonObject;
use crate::io::json::JsonPath;
use crate::io::open_options::OpenOptions;
use crate::io::opened::Opened;
use crate::io::skin_file::load_skin;
use crate::io::source::Source;

/// Reads a document of any supported version.
pub fn read(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    match source.parse::<JsonObject<Header>>(|_| {}) {
        Ok(JsonObject(header)) => match header.version().map_err(|error| source.error(&error))? {
            1 => {
                let translation = version_1::translated(source.text());
                read_fields(&source.translated(translation), options)
            }
            _ => read_fields(source, options),
        },
        // The header is invalid. Reading all fields fails, too, and its error names the exact
        // field.
        Err(_) => read_fields(source, options),
    }
}

fn read_fields(source: &Source, options: &OpenOptions) -> Result<Opened, OpenError> {
    let mut warnings = FieldWarnings::default();
    let JsonObject(fields) = source.parse::<JsonObject<DocumentFields>>(|field| {
        let reason = unknown(&field);
        warnings.push(field, reason);
    })?;
    let has_camera = fields.has_camera();
    let mut document = fields.document(&mut warnings).map_err(|error| source.error(&error))?;
    if !has_camera && !options.without_camera && document.rig == RigKind::Skeleton {
        document.camera = document.framing_camera();
    }
    load_skin(&mut document, source.folder(), &mut warnings);
    Ok(Opened {
        order: document.skeleton().ids().collect(),
        document,
        warnings: source.warnings(&warnings),
        skeletons: Vec::new(),
        animations: Vec::new(),
        animation: None,
    })
}

fn unknown(field: &JsonPath) -> String {
    let mut keys = field.keys().rev();
    let (name, parent) = (keys.next().unwrap_or_default(), keys.next().unwrap_or_default());
    match version_1::renamed(parent, name) {
        Some(new) => format!("unknown field, ignored; version {VERSION} calls it `{new}`"),
        None => "unknown field, ignored".to_owned(),
    }
}
