//! Damage to files, and the errors that it leads to.

use ik_arm::io::OpenError;

use super::Random;

/// Text of an error, checked to be of a readable length.
pub fn message(error: OpenError) -> String {
    let message = error.to_string();
    assert!((1..1000).contains(&message.chars().count()), "{message}");
    message
}

/// Copies of a file that are cut short or have other bytes or values.
pub fn mutations(text: &str, random: &mut Random, count: usize) -> Vec<Vec<u8>> {
    (0..count).map(|_| mutated(text, random)).collect()
}

/// Copies of a text with one of its lines replaced by one of these words.
pub fn wrong_lines(text: &str, words: &[&str], random: &mut Random, count: usize) -> Vec<Vec<u8>> {
    let mut lines: Vec<&str> = text.lines().collect();
    let mut wrong = || {
        let at = random.below(lines.len());
        let right = std::mem::replace(&mut lines[at], random.one_of(words));
        let wrong = lines.join("\n").into_bytes();
        lines[at] = right;
        wrong
    };
    (0..count).map(|_| wrong()).collect()
}

fn mutated(text: &str, random: &mut Random) -> Vec<u8> {
    const VALUES: [&str; 16] = [
        "null",
        "true",
        "-1",
        "1e39",
        "0",
        "4294967295",
        "1e-400",
        "\"\"",
        "[]",
        "{}",
        "[[]]",
        "3.4e38",
        "-0.0",
        "[0,0,0]",
        "18446744073709551616",
        "\"\\ud800\"",
    ];
    let mut bytes = text.as_bytes().to_vec();
    let at = |random: &mut Random| random.below(text.len());
    match random.below(4) {
        0 => bytes.truncate(at(random)),
        1 => {
            for _ in 0..=random.below(3) {
                let index = at(random);
                bytes[index] = random.next() as u8;
            }
        }
        2 => {
            let index = at(random);
            bytes[index] = random.one_of(b"0123456789-+.eE,:[]{}\"\\ \n");
        }
        _ => {
            let is_value = |byte: &u8| b":[,".contains(byte);
            let start = at(random);
            let Some(start) = bytes[start..].iter().position(is_value).map(|n| n + start + 1)
            else {
                return bytes;
            };
            let is_end = |byte: &u8| b",]}\n".contains(byte);
            let end = bytes[start..].iter().position(is_end).map_or(bytes.len(), |n| n + start);
            bytes.splice(start..end, random.one_of(&VALUES).bytes());
        }
    }
    bytes
}
