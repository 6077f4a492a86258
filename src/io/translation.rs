/// A text with some of its words replaced, and where each was in the text before.
#[derive(Debug, Default)]
pub struct Translation {
    pub text: String,
    /// The ends of all replaced words, in bytes: in `text` and in the text before.
    ends: Vec<(usize, usize)>,
}

impl Translation {
    /// Appends what stays as it is.
    pub fn keep(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Appends `new` instead of a word that ends at byte `end` of the text before.
    pub fn replace(&mut self, new: &str, end: usize) {
        self.text.push_str(new);
        self.ends.push((self.text.len(), end));
    }

    /// The byte of the text before that a byte of `text` comes from, not within a replaced word.
    pub fn byte_before(&self, byte: usize) -> usize {
        let replaced = self.ends.partition_point(|(end, _)| *end <= byte);
        let (end, end_before) = replaced.checked_sub(1).map_or((0, 0), |last| self.ends[last]);
        byte - end + end_before
    }
}
