/// The parts of the program that are shown beside the view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// The position of the hand.
    pub hand: bool,
    /// The Socket twist.
    pub twist: bool,
    /// The switches of the guides.
    pub guides: bool,
    /// The triangle of shoulder, elbow and hand.
    pub triangle: bool,
}

impl Parts {
    /// Parses names separated by commas, such as "view,hand,twist". The view is always there; other
    /// names are passed over.
    pub fn parse(names: &str) -> Self {
        let has = |name| names.split(',').any(|it| it.trim() == name);
        Self {
            hand: has("hand"),
            twist: has("twist"),
            guides: has("guides"),
            triangle: has("triangle"),
        }
    }

    /// True if any of the controls is shown.
    pub(super) fn has_controls(self) -> bool {
        self.hand || self.twist || self.guides
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_named_in_a_list() {
        let parts = Parts::parse("view, twist,guides,rocket");
        assert_eq!(parts, Parts { twist: true, guides: true, ..Parts::default() });
        assert_eq!(Parts::parse(""), Parts::default());
    }
}
