use std::collections::{HashMap, HashSet};

/// Makes names unique: of equal names, the first stays, and the others get a number as suffix.
pub fn distinct(names: &[String]) -> Vec<String> {
    let mut taken: HashSet<&str> = HashSet::new();
    let is_first: Vec<bool> = names.iter().map(|name| taken.insert(name)).collect();
    let mut taken: HashSet<String> = names.iter().cloned().collect();
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    let mut numbered = |name: &str, number: &mut usize| loop {
        *number += 1;
        let candidate = format!("{name}_{number}");
        if taken.insert(candidate.clone()) {
            return candidate;
        }
    };
    let pairs = names.iter().zip(is_first);
    pairs
        .map(|(stem, is_first)| match is_first {
            true => stem.clone(),
            false => numbered(stem, numbers.entry(stem).or_insert(1)),
        })
        .collect()
}

/// Converts a name to one word of a BVH file: trims it, and replaces space, control characters and
/// braces by `_`.
pub fn word(name: &str) -> String {
    let is_plain = |c: char| !(c.is_whitespace() || c.is_control() || "{}".contains(c));
    name.trim().chars().map(|c| if is_plain(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_there_twice_get_numbers_that_are_free() {
        let names = ["a", "a", "a_2", "b", "a", "a_2"].map(str::to_owned);
        assert_eq!(distinct(&names), ["a", "a_3", "a_2", "b", "a_4", "a_2_2"]);
    }

    #[test]
    fn a_word_has_no_space_and_no_brace() {
        assert_eq!(word(" left arm\t{1}"), "left_arm__1_");
    }
}
