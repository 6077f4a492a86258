//! Version 1 of the format. It differs from version 2 only in names.

use crate::io::translation::Translation;

/// Names of fields and values that version 2 changed. Each row has the name of the enclosing field
/// (as in version 2, empty at the top level), then the old name and the new name.
const RENAMED: [(&str, &str, &str); 21] = [
    ("", "slither", "follow_path"),
    ("", "keys", "channels"),
    ("", "display", "overlays"),
    ("arm", "elbow_spin", "twist"),
    ("arm", "swivel", "twist_reference"),
    ("arm", "softening", "soft_reach"),
    ("arm", "weight", "influence"),
    ("arm", "wrist", "hand_orientation"),
    ("twist_reference", "reference", "kind"),
    ("twist_reference", "carried", "transported"),
    ("space", "lower", "lower_limb"),
    ("channels", "layer", "overlay"),
    ("channels", "knots", "keys"),
    ("channel", "elbow_spin", "twist"),
    ("channel", "weight", "influence"),
    ("channel", "wrist", "hand_orientation"),
    ("channel", "layer", "overlay"),
    ("overlay", "globe", "singularity_globe"),
    ("overlay", "references", "twist_references"),
    ("overlays", "globe", "singularity_globe"),
    ("overlays", "references", "twist_references"),
];

/// Returns the name in version 2 of a field or value that version 1 calls `name`. `around` is the
/// enclosing field. `None` if both versions use the same name.
pub fn renamed(around: &str, name: &str) -> Option<&'static str> {
    let is_this = |row: &&(&str, &str, &str)| row.0 == around && row.1 == name;
    RENAMED.iter().find(is_this).map(|(_, _, new)| *new)
}

/// Translates a text of version 1 to the names of version 2. The text must be valid JSON.
pub fn translated(text: &str) -> Translation {
    let mut translation = Translation::default();
    // `around` has, for each open object or array, the field whose value it is. `field` is the
    // field of the next value.
    let mut around: Vec<String> = Vec::new();
    let mut field = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(['"', '{', '[', '}', ']']) {
        let (before, token) = rest.split_at(start);
        translation.keep(before);
        let length = if token.starts_with('"') { string_length(token) } else { 1 };
        let (token, after) = token.split_at(length);
        rest = after;
        match token {
            "{" | "[" => around.push(field.clone()),
            "}" | "]" => field = around.pop().unwrap_or_default(),
            string => {
                let name: String = serde_json::from_str(string).unwrap_or_default();
                let is_key = after.trim_start().starts_with(':');
                let parent = if is_key { around.last() } else { Some(&field) };
                let new = renamed(parent.map_or("", String::as_str), &name);
                if is_key {
                    field = new.map_or(name, str::to_owned);
                }
                if let Some(new) = new {
                    translation.replace(&format!("{new:?}"), text.len() - after.len());
                    continue;
                }
            }
        }
        translation.keep(token);
    }
    translation.keep(rest);
    translation
}

/// Length in bytes of the JSON string at the start of `text`, including the quotes.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate().skip(1) {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = true,
            b'"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_renamed_where_they_stand_and_nothing_else() {
        let text = r#"{"display": ["globe"], "keys": [{"channel":"layer","layer":"references"},
            {"channel":"weight","knots":[[0, 1]]}], "arm": {"weight": 1, "sw\u0069vel": {"carried":1}},
            "targets": [{"weight": 2, "name": "wrist {\"arm\": [\\"}], "slither": {}}"#;
        let expected = r#"{"overlays": ["singularity_globe"], "channels": [{"channel":"overlay","overlay":"twist_references"},
            {"channel":"influence","keys":[[0, 1]]}], "arm": {"influence": 1, "twist_reference": {"transported":1}},
            "targets": [{"weight": 2, "name": "wrist {\"arm\": [\\"}], "follow_path": {}}"#;
        let translation = translated(text);
        assert_eq!(translation.text, expected);
        for word in ["[{\"channel\"", "[[0, 1]]", "1, \"", "2, \"name\"", "{}}"] {
            let byte = translation.text.find(word).expect("there");
            assert_eq!(text[translation.byte_before(byte)..].find(word), Some(0), "{word}");
        }
    }
}
