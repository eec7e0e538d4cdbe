//! Names that are similar to a mistyped one.

/// At most `count` of the known names, by increasing number of single-character edits from the
/// typed one: insertions, deletions, substitutions and transpositions (Damerau-Levenshtein
/// distance). Of equally near names, permutations of the typed one come first, then the order of
/// `known` counts. Known names are lower case; the case of the typed one does not matter.
#[must_use]
pub fn nearest_names<'a>(typed: &str, known: &[&'a str], count: usize) -> Vec<&'a str> {
    let ranked = ranked(typed, known);
    ranked
        .into_iter()
        .take(count)
        .map(|(_, name)| name)
        .collect()
}

/// Names among the nearest ones that are similar enough for a typing error: at most a third of the
/// letters are edited.
#[must_use]
pub fn similar_names<'a>(typed: &str, known: &[&'a str], count: usize) -> Vec<&'a str> {
    let typed_letters = typed.chars().take(COMPARED_CHARS).count();
    let is_slip = |edits: usize, name: &str| 3 * edits <= typed_letters.max(name.chars().count());
    let ranked = ranked(typed, known).into_iter().take(count);
    ranked
        .filter(|(edits, name)| is_slip(*edits, name))
        .map(|(_, name)| name)
        .collect()
}

/// A list of names for a message: `a`, `b` or `c`.
#[must_use]
pub fn any_of(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [one] => format!("`{one}`"),
        [head @ .., last] => {
            let head: Vec<String> = head.iter().map(|name| format!("`{name}`")).collect();
            format!("{} or `{last}`", head.join(", "))
        }
    }
}

/// Letters of a typed name that are compared: the distance takes their number times that of a known
/// name.
const COMPARED_CHARS: usize = 64;

/// All known names with their distance, the nearest first.
fn ranked<'a>(typed: &str, known: &[&'a str]) -> Vec<(usize, &'a str)> {
    let typed: String = typed.chars().take(COMPARED_CHARS).collect();
    let typed = typed.to_lowercase();
    let letters = sorted_letters(&typed);
    let mut ranked: Vec<(usize, bool, &str)> = known
        .iter()
        .map(|name| {
            let edits = strsim::damerau_levenshtein(&typed, name);
            (edits, sorted_letters(name) != letters, *name)
        })
        .collect();
    ranked.sort_by_key(|(edits, other_letters, _)| (*edits, *other_letters));
    ranked
        .into_iter()
        .map(|(edits, _, name)| (edits, name))
        .collect()
}

fn sorted_letters(name: &str) -> Vec<char> {
    let mut letters: Vec<char> = name.chars().collect();
    letters.sort_unstable();
    letters
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_finds_its_name_and_nonsense_finds_none() {
        let known = ["latitude_deg", "local_gravity_m_per_s2"];
        for typed in ["lattitude_deg", "Latitude_Deg", "latitude", "altitude_deg"] {
            assert_eq!(similar_names(typed, &known, 1), ["latitude_deg"], "{typed}");
        }
        assert!(similar_names("qqqq", &known, 1).is_empty());
    }

    #[test]
    fn the_nearest_come_first_and_permutations_before_others() {
        let known = ["gyro_y.g_z", "gyro_y.g_yz", "gyro_x.ramp"];
        assert_eq!(nearest_names("gyro_y.g_zy", &known, 1), ["gyro_y.g_yz"]);
        assert_eq!(
            nearest_names("gyro_y.gz", &known, 2),
            ["gyro_y.g_z", "gyro_y.g_yz"]
        );
        assert_eq!(nearest_names("x", &known, 9).len(), 3);
    }
}
