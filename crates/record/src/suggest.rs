//! The nearest of some known names to a mistyped one.

/// The known name that takes the fewest single-character edits, if few enough to be a slip.
pub(crate) fn nearest<'a>(typed: &str, known: &[&'a str]) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    known
        .iter()
        .map(|name| (edits(&typed, name), *name))
        .min()
        .filter(|(edits, name)| *edits <= name.len().max(typed.len()) / 2)
        .map(|(_, name)| name)
}

/// The known names that take the fewest single-character edits, the fewest first.
#[must_use]
pub fn nearest_few<'a>(typed: &str, known: &[&'a str], count: usize) -> Vec<&'a str> {
    let typed = typed.to_lowercase();
    let mut all: Vec<(usize, &str)> = known
        .iter()
        .map(|name| (edits(&typed, name), *name))
        .collect();
    all.sort();
    all.into_iter().take(count).map(|(_, name)| name).collect()
}

/// A list of names for a message: `a`, `b` or `c`.
pub(crate) fn any_of(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [one] => format!("`{one}`"),
        [head @ .., last] => {
            let head: Vec<String> = head.iter().map(|name| format!("`{name}`")).collect();
            format!("{} or `{last}`", head.join(", "))
        }
    }
}

/// Levenshtein distance: the fewest insertions, deletions and substitutions.
fn edits(from: &str, to: &str) -> usize {
    let to: Vec<char> = to.chars().collect();
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (above, letter) in from.chars().enumerate() {
        let mut diagonal = above;
        let mut left = above + 1;
        row[0] = left;
        for (column, other) in to.iter().enumerate() {
            let substituted = diagonal + usize::from(letter != *other);
            diagonal = row[column + 1];
            left = substituted.min(diagonal + 1).min(left + 1);
            row[column + 1] = left;
        }
    }
    row[to.len()]
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used)]
mod tests {
    use super::*;

    #[test]
    fn edits_are_counted() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("abc", ""), 3);
        assert_eq!(edits("same", "same"), 0);
    }

    #[test]
    fn a_slip_finds_its_name_and_nonsense_finds_none() {
        let known = ["latitude_deg", "local_gravity_m_per_s2"];
        assert_eq!(nearest("lattitude_deg", &known), Some("latitude_deg"));
        assert_eq!(nearest("Latitude_Deg", &known), Some("latitude_deg"));
        assert_eq!(nearest("qqqq", &known), None);
    }
}
