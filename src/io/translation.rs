/// A text in which some words are replaced, and the positions of these words in the original text.
#[derive(Debug, Default)]
pub struct Translation {
    pub text: String,
    /// For each replaced word, the byte at which it ends in `text` and in the original text.
    ends: Vec<(usize, usize)>,
}

impl Translation {
    /// Appends a part of the original text unchanged.
    pub fn keep(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Appends `new` in place of a word that ends at byte `end` of the original text.
    pub fn replace(&mut self, new: &str, end: usize) {
        self.text.push_str(new);
        self.ends.push((self.text.len(), end));
    }

    /// Returns the byte of the original text that corresponds to a byte of `text`, which must not
    /// be within a replaced word.
    pub fn byte_before(&self, byte: usize) -> usize {
        let replaced = self.ends.partition_point(|(end, _)| *end <= byte);
        let (end, end_before) = replaced.checked_sub(1).map_or((0, 0), |last| self.ends[last]);
        byte - end + end_before
    }
}
