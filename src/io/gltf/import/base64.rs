/// Decodes base64 (RFC 4648). The error is the reason why the text is invalid.
pub fn decode(text: &str) -> Result<Vec<u8>, String> {
    let digits = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for (group_index, group) in digits.chunks(4).enumerate() {
        let mut bits = 0_u32;
        for (index, digit) in group.iter().enumerate() {
            let value = value(*digit).ok_or_else(|| {
                let at = 4 * group_index + index + 1;
                format!("data must be base64, got {:?} as character {at}", *digit as char)
            })?;
            bits |= value << (18 - 6 * index);
        }
        if group.len() == 1 {
            return Err("data must be base64, got an end within a byte".to_owned());
        }
        let [_, bytes_of_group @ ..] = bits.to_be_bytes();
        bytes.extend(bytes_of_group.iter().take(group.len() - 1));
    }
    Ok(bytes)
}

fn value(digit: u8) -> Option<u32> {
    Some(u32::from(match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_examples_of_the_standard_are_read() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zg", "f"),
        ] {
            assert_eq!(decode(text).expect(text), bytes.as_bytes(), "{text}");
        }
        assert_eq!(decode("AP+/").expect("digits"), [0, 255, 191]);
    }

    #[test]
    fn other_characters_and_cut_bytes_are_refused() {
        for text in ["Zm9 v", "Z", "Zm9vY", "é===", "Zg=g"] {
            assert!(decode(text).is_err(), "{text}");
        }
    }
}
