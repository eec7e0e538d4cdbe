//! Comparison of two results, key by key.

use core::fmt;
use std::collections::BTreeMap;

use serde_json::{Map, Value};

/// Tolerance of a number, over its standard deviation where the result has it, else over the number itself: what
/// nobody sees, and far above what last bits of another machine make of a fit.
const SAME: f64 = 1e-6;

/// Relative difference that the rounding of both numbers to the digits that are kept may make.
const DIGITS: f64 = 1e-11;

/// Difference below which numbers are equal: ten units of the last place of sums of numbers of about 1, so that
/// what is zero but for rounding is zero. Probabilities are compared by their logarithms and do not have it.
const ZERO: f64 = 2e-15;

/// Arrays of as many numbers at most are vectors of one unit, or rows of matrices: their components have the
/// rounding errors of the largest. Longer ones are series.
const VECTOR: usize = 32;

/// Keys whose standard deviation is the key `sigma` beside them.
const OF_SIGMA: [&str; 3] = ["estimate", "shift", "sigma"];

/// Keys that tell the elements of an array apart. The order of such elements is that of numbers in them, which
/// are compared.
const NAMES: [&str; 3] = ["effect", "name", "record"];

/// Values at one path that differ.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    /// Keys from the command on, with `[]` for the place in an array.
    pub(super) path: String,
    count: usize,
    /// The largest difference over its tolerance; infinite of what is no number.
    largest: f64,
    /// That one in words.
    text: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path, self.text)?;
        if self.largest.is_finite() {
            write!(f, ", {:.1e} times the tolerance", self.largest)?;
        }
        match self.count {
            1 => Ok(()),
            count => write!(f, "; {count} in all"),
        }
    }
}

/// Number of values that two results have at the same places, and the paths where they differ, largest first.
pub(super) fn compared(before: &Value, now: &Value) -> (usize, Vec<Difference>) {
    let mut found = Found::default();
    found.either("", Some(before), Some(now), None);
    let mut differences: Vec<Difference> = found.differences.into_values().collect();
    differences.sort_by(|one, other| other.largest.total_cmp(&one.largest));
    (found.values, differences)
}

#[derive(Default)]
struct Found {
    values: usize,
    differences: BTreeMap<String, Difference>,
}

impl Found {
    fn differs(&mut self, path: &str, over: f64, text: String) {
        let new = || Difference {
            path: path.to_owned(),
            count: 0,
            largest: f64::NEG_INFINITY,
            text: String::new(),
        };
        let one = self.differences.entry(path.to_owned()).or_insert_with(new);
        one.count += 1;
        if over > one.largest {
            (one.largest, one.text) = (over, text);
        }
    }

    fn other(&mut self, path: &str, one: &Value, what: &str) {
        self.differs(path, f64::INFINITY, format!("{} {what}", short(one)));
    }

    /// Compares what may be missing in one of both. `scale` is what the tolerance of a number is relative to, if
    /// it is not the number.
    fn either(
        &mut self,
        path: &str,
        before: Option<&Value>,
        now: Option<&Value>,
        scale: Option<f64>,
    ) {
        match (before, now) {
            (Some(Value::Object(before)), Some(Value::Object(now))) => {
                self.objects(path, before, now)
            }
            (Some(Value::Array(before)), Some(Value::Array(now))) => self.arrays(path, before, now),
            (Some(before), Some(now)) => {
                self.values += 1;
                let over = over_tolerance(path, before, now, scale);
                if over > 1.0 {
                    let text = format!("{} became {}", short(before), short(now));
                    self.differs(path, over, text);
                }
            }
            (Some(one), None) => self.other(path, one, "is missing"),
            (None, Some(one)) => self.other(path, one, "is new"),
            (None, None) => (),
        }
    }

    fn objects(&mut self, path: &str, before: &Map<String, Value>, now: &Map<String, Value>) {
        let new = now.keys().filter(|key| !before.contains_key(*key));
        let sigma = before.get("sigma").and_then(Value::as_f64);
        for key in before.keys().chain(new) {
            let path = format!("{path}{}{key}", if path.is_empty() { "" } else { "." });
            let scale = sigma.filter(|_| OF_SIGMA.contains(&key.as_str()));
            self.either(&path, before.get(key), now.get(key), scale);
        }
    }

    fn arrays(&mut self, path: &str, before: &[Value], now: &[Value]) {
        let path = format!("{path}[]");
        let mut names = NAMES.iter();
        if let Some((before, now)) =
            names.find_map(|key| Some((named(key, before)?, named(key, now)?)))
        {
            let new = now.keys().filter(|name| !before.contains_key(*name));
            for name in before.keys().chain(new) {
                let [before, now] = [&before, &now].map(|of| of.get(name).copied());
                self.either(&path, before, now, None);
            }
            return;
        }
        let numbers = before.iter().filter_map(Value::as_f64);
        let largest = numbers.fold(0.0, |largest: f64, one| largest.max(one.abs()));
        let scale = (before.len() <= VECTOR).then_some(largest);
        for place in 0..before.len().max(now.len()) {
            self.either(&path, before.get(place), now.get(place), scale);
        }
    }
}

/// Elements by the text of a key; `None` if that does not tell them apart.
fn named<'a>(key: &str, array: &'a [Value]) -> Option<BTreeMap<&'a str, &'a Value>> {
    let named = array.iter().map(|one| Some((one.get(key)?.as_str()?, one)));
    let named: BTreeMap<&str, &Value> = named.collect::<Option<_>>()?;
    (named.len() == array.len()).then_some(named)
}

/// Difference of two values over its tolerance; infinite of what is no number, and of counts.
fn over_tolerance(path: &str, before: &Value, now: &Value, scale: Option<f64>) -> f64 {
    let (Some(a), Some(b)) = (before.as_f64(), now.as_f64()) else {
        return if before == now { 0.0 } else { f64::INFINITY };
    };
    if a == b || !before.is_f64() && !now.is_f64() {
        return if a == b { 0.0 } else { f64::INFINITY };
    }
    if path.ends_with("p_value") {
        // Of z² / 2, of which a p-value is about the exponential; that of zero is infinite.
        let [a, b] = [a, b].map(f64::ln);
        return match a.is_finite() && b.is_finite() {
            true => (a - b).abs() / (SAME * a.abs().max(1.0)),
            false => f64::INFINITY,
        };
    }
    let tolerance = SAME * scale.unwrap_or(a.abs());
    (a - b).abs() / tolerance.max(DIGITS * a.abs()).max(ZERO)
}

/// The beginning of a value.
fn short(value: &Value) -> String {
    const LETTERS: usize = 60;
    let text = value.to_string();
    match text.char_indices().nth(LETTERS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
