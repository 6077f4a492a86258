//! The name of the program that has written a file, `asset.generator`.

const NAME: &str = "ik-arm ";

/// The name that this program writes.
pub fn this_program() -> String {
    format!("{NAME}{}", env!("CARGO_PKG_VERSION"))
}

/// Whether this is the name that any version of this program writes.
pub fn is_this_program(generator: &str) -> bool {
    generator.starts_with(NAME)
}
