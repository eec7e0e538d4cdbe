//! The name of the Rust module that a build derives from a model file.

use std::path::Path;

use crate::error::Error;

/// Keywords of Rust in lower case, those that are reserved for later included.
const KEYWORDS: [&str; 51] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// The name of the module of a model file: the name of the file up to its first dot.
///
/// # Errors
///
/// [`Error::ModuleName`] unless that is lower-case words of letters and digits, joined by single
/// `_`, the first of which begins with a letter, and no keyword of Rust: the same rule by which
/// the build accepts the file.
pub fn module_name(path: &Path) -> Result<String, Error> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let name = file.split('.').next().unwrap_or_default();
    if is_module_name(name) {
        Ok(name.to_owned())
    } else {
        Err(Error::ModuleName {
            path: path.to_owned(),
            found: name.to_owned(),
        })
    }
}

fn is_module_name(name: &str) -> bool {
    let is_plain = |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit();
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name
            .split('_')
            .all(|word| !word.is_empty() && word.chars().all(is_plain))
        && !KEYWORDS.contains(&name)
}
