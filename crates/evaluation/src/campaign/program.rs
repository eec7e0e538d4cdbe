//! Identity of the program that made a result.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

/// A hash of the running program, to distinguish results of different builds where they depend on
/// all of the code. `unknown` if the program cannot read itself.
#[must_use]
pub fn program() -> String {
    let Ok(bytes) = std::env::current_exe().and_then(std::fs::read) else {
        return "unknown".to_owned();
    };
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::program;

    #[test]
    fn a_program_is_itself() {
        assert_eq!(program(), program());
        // Sixteen hexadecimal digits: it could be read.
        assert_eq!(program().len(), 16);
    }
}
