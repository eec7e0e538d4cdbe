//! Names: fit for Rust, and in its cases.

/// Whether a name is fit for a Rust module, function or variable: `theta_x`, words of lower-case
/// letters and digits joined by `_`, no keyword of Rust. Programs, and so the files that variants
/// are derived from, are called by such names.
#[must_use]
pub fn is_snake_case(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_lowercase())
        && name.split('_').all(|word| {
            !word.is_empty()
                && word
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        })
        && name != "gen"
        && syn::parse_str::<syn::Ident>(name).is_ok()
}

/// `Platform`: letters and digits from an upper-case letter on.
pub(super) fn is_pascal_case(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_uppercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric())
        && syn::parse_str::<syn::Ident>(name).is_ok()
}

/// `theta_x` to `ThetaX`.
pub(crate) fn pascal_case(snake: &str) -> String {
    snake
        .split('_')
        .flat_map(|word| {
            let mut letters = word.chars();
            letters
                .next()
                .map(|first| first.to_ascii_uppercase())
                .into_iter()
                .chain(letters)
        })
        .collect()
}

/// `theta_x` to `THETA_X`.
pub(crate) fn screaming_case(snake: &str) -> String {
    snake.to_ascii_uppercase()
}
