use std::fmt;

/// Motion that BVH cannot hold.
pub enum BvhNote<'a> {
    /// The skeleton's transform has uneven scale, shear or zero scale.
    Uneven,
    /// The bones without children with these names change their length or direction.
    Ends(&'a [&'a str]),
}

impl fmt::Display for BvhNote<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uneven => f.write_str(
                "the skeleton is scaled unevenly, sheared or flattened, and BVH has rotations \
                 only: the nearest rotations are written; the joints' positions are exact",
            ),
            Self::Ends(names) => {
                /// Maximum number of names that are listed. Further bones are only counted.
                const MOST: usize = 10;
                let named: Vec<_> =
                    names.iter().take(MOST).map(|name| format!("{name:?}")).collect();
                write!(f, "the last bone of {}", named.join(", "))?;
                if let Some(more) = names.len().checked_sub(MOST).filter(|more| *more > 0) {
                    write!(f, " and {more} more joints")?;
                }
                f.write_str(
                    " changes in time, but BVH has constant end sites: that of the first frame is \
                     written",
                )
            }
        }
    }
}
