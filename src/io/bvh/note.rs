use std::fmt;

/// What a motion has and BVH cannot say.
pub enum Note<'a> {
    /// The skeleton's transform stretches, shears or flattens.
    Uneven,
    /// The length of a limb changes.
    Length(&'a str),
    /// The offsets of these joints change.
    Offsets(&'a [&'a str]),
}

impl fmt::Display for Note<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uneven => f.write_str(
                "the skeleton is scaled unevenly, sheared or flattened, and BVH only turns: the \
                 joints are turned as nearly as turns can be",
            ),
            Self::Length(limb) => write!(
                f,
                "the length of the {limb} limb changes, which BVH cannot say: that of the first \
                 frame is written"
            ),
            Self::Offsets(joints) => {
                /// More names than so many help nobody.
                const MOST: usize = 10;
                let named: Vec<_> =
                    joints.iter().take(MOST).map(|name| format!("{name:?}")).collect();
                let offsets = if joints.len() == 1 { "offset" } else { "offsets" };
                write!(f, "the {offsets} of {}", named.join(", "))?;
                if let Some(more) = joints.len().checked_sub(MOST).filter(|more| *more > 0) {
                    write!(f, " and {more} more joints")?;
                }
                let change = if joints.len() == 1 { "changes" } else { "change" };
                write!(
                    f,
                    " {change} in time, which BVH can say of a single root only: what is at the first \
                     frame is written"
                )
            }
        }
    }
}
