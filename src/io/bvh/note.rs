use std::fmt;

/// Content of a document that BVH cannot hold.
pub enum BvhNote<'a> {
    /// The skeleton's transform has uneven scale, shear or zero scale.
    Uneven,
    /// The length of the limb with this name changes over time.
    Length(&'a str),
    /// The offsets of the joints with these names change over time.
    Offsets(&'a [&'a str]),
}

impl fmt::Display for BvhNote<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uneven => f.write_str(
                "the skeleton is scaled unevenly, sheared or flattened, and BVH has rotations \
                 only: the nearest rotations are written",
            ),
            Self::Length(limb) => write!(
                f,
                "the length of the {limb} limb changes, but BVH lengths are constant: that of the \
                 first frame is written"
            ),
            Self::Offsets(joints) => {
                /// Maximum number of names that are listed. Further joints are only counted.
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
                    " {change} in time, but BVH offsets are constant except for a single root: \
                     those of the first frame are written"
                )
            }
        }
    }
}
