use std::collections::HashMap;

/// Names in use, each with the number to try as the suffix of the next equal name.
#[derive(Default)]
pub struct UniqueNames(HashMap<String, usize>);

impl<const N: usize> From<[&str; N]> for UniqueNames {
    fn from(taken: [&str; N]) -> Self {
        Self(taken.map(|name| (name.to_owned(), FIRST)).into())
    }
}

const FIRST: usize = 2;

impl UniqueNames {
    /// Returns `name`, with a number as suffix if it is in use already. The result is then in use.
    pub fn free(&mut self, name: &str) -> String {
        let mut free = name.to_owned();
        let mut number = self.0.get(name).copied();
        while let Some(next) = number.filter(|_| self.0.contains_key(&free)) {
            free = format!("{name}_{next}");
            number = Some(next + 1);
        }
        if let Some(number) = number {
            self.0.insert(name.to_owned(), number);
        }
        self.0.insert(free.clone(), FIRST);
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_free() {
        let mut names = UniqueNames::from(["a", "a_3"]);
        let all = ["a", "b", "a", "a_2", "b", "a"].map(|name| names.free(name));
        assert_eq!(all, ["a_2", "b", "a_4", "a_2_2", "b_2", "a_5"]);
    }
}
