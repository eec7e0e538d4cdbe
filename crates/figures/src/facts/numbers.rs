//! Numbers of a page that follow from others on it, recomputed from its HTML alone.
//!
//! A printed number stands for all numbers that are written so. What is computed of such spans has a span too; a
//! number is right if both have a number in common, without any other tolerance.

mod formulas;
mod rules;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use gyrocal_testkit::workspace;
use rayon::prelude::*;
use serde::Deserialize;

use super::lines::{Line, of_page};
use super::values::leading;
use super::{Answer, PRINTED, answers};
use crate::before::moves::matches;
use crate::harness::{Context, Error, Figure};
use rules::{RULES, SAME};

/// Numbers from the least to the largest.
type Span = [f64; 2];

/// A number that follows from others.
struct Check {
    /// Where it stands.
    place: String,
    shown: Span,
    computed: Span,
}

/// Those that a rule finds.
#[derive(Default)]
struct Checks(Vec<Check>);

/// A table of a page.
struct Table {
    title: String,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// One answer on a page.
struct Part {
    lines: Vec<Line>,
    tables: Vec<Table>,
}

/// Answers whose pages the facts do not have.
#[derive(Deserialize)]
struct Further {
    further: Vec<FurtherAnswer>,
}

#[derive(Deserialize)]
struct FurtherAnswer {
    make: Vec<String>,
    run: String,
}

/// Kinds of answers of the small version, the first of each.
const SMALL: [&str; 3] = ["effect 1", "calibration 1", "duffing 1"];

/// The figures of the numbers of pages; the first that are wrong are printed before them. With names, only these
/// answers are made.
///
/// # Errors
/// If an answer cannot be made, or a rule applies to no page.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let (small, named) = (context.is_small(), &context.named);
    let mut answers = answers(&workspace().join("tests/data/facts"), small)?;
    let Further { further } = toml::from_str(include_str!("numbers/further.toml"))?;
    answers.extend(
        further
            .into_iter()
            .map(|FurtherAnswer { make, run }| Answer {
                key: format!("further {}", run.split(" -").next().unwrap_or_default()),
                make,
                run,
            }),
    );
    answers.retain(|one| match named.is_empty() {
        true => !small || SMALL.contains(&&*one.key),
        false => named.contains(&one.key),
    });
    let checked = answers.par_iter().map(|one| {
        let of_answer = |error| format!("{}: {error}", one.key);
        let (_, _, page) = one.told().map_err(of_answer)?;
        Ok((&*one.key, checked(&page)))
    });
    let checked: Vec<_> = checked.collect::<Result<_, Error>>()?;
    let mut of_rules = rules()
        .map(|rule| (rule, [0; 2]))
        .collect::<BTreeMap<_, _>>();
    let mut pages = 0;
    for (key, all) in &checked {
        pages += usize::from(!all.is_empty());
        for (rule, check) in all {
            let [right, wrong] = of_rules.entry(rule).or_default();
            *(if check.holds() { right } else { &mut *wrong }) += 1;
            if !check.holds() && *wrong <= PRINTED {
                println!("{key}: {rule}: {check}");
            }
        }
    }
    let unused = of_rules.iter().filter(|(_, counts)| **counts == [0; 2]);
    let unused: Vec<&str> = unused.map(|(name, _)| *name).collect();
    if !small && named.is_empty() && !unused.is_empty() {
        return Err(format!("rules that apply to no page: {}", unused.join("; ")).into());
    }
    let [right, wrong] = [0, 1].map(|place| of_rules.values().map(|one| one[place]).sum::<usize>());
    Ok(vec![
        Figure {
            target: "all within their digits".to_owned(),
            measured: format!("{right} of {} within their digits", right + wrong),
            holds: Some(wrong == 0 && right > 0),
            ..Figure::note("numbers of a page recomputed from the page", String::new()).over(
                pages,
                "pages of the answers of the part facts, and further ones",
            )
        },
        Figure::note(
            "rules that recompute numbers of these pages",
            format!("{} of {}", of_rules.len() - unused.len(), of_rules.len()),
        ),
    ])
}

/// The names of all rules.
fn rules() -> impl Iterator<Item = &'static str> {
    let same = SAME.lines().filter(|line| !line.starts_with("  "));
    RULES.iter().map(|rule| rule.0).chain(same)
}

/// The numbers of a page that follow from others, each with its rule.
fn checked(page: &str) -> Vec<(&'static str, Check)> {
    let mut all = Vec::new();
    for part in page.split("<article").map(Part::new) {
        for (name, rule) in RULES {
            let mut checks = Checks::default();
            rule(&part, &mut checks);
            all.extend(checks.0.into_iter().map(|check| (name, check)));
        }
        // Rule, pattern, and the numbers of its quantity.
        let (mut name, mut first) = ("", None::<Vec<Span>>);
        for line in SAME.lines() {
            let Some(pattern) = line.strip_prefix("  ") else {
                (name, first) = (line, None);
                continue;
            };
            let scaled = pattern.strip_prefix("1e6 ");
            let factor = if scaled.is_some() { 1e6 } else { 1.0 };
            let found = part.found(&scaled.unwrap_or(pattern).replace('|', "\t"));
            let found = found
                .concat()
                .into_iter()
                .map(|span| span.map(|end| end * factor));
            let found: Vec<Span> = found.collect();
            match &first {
                None => first = Some(found).filter(|found| !found.is_empty()),
                Some(first) => all.extend(found.into_iter().zip(first).map(|(shown, computed)| {
                    let place = pattern.to_owned();
                    (
                        name,
                        Check {
                            place,
                            shown,
                            computed: *computed,
                        },
                    )
                })),
            }
        }
    }
    all
}

impl Check {
    fn holds(&self) -> bool {
        self.shown[0] <= self.computed[1] && self.computed[0] <= self.shown[1]
    }
}

impl core::fmt::Display for Check {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let ([a, b], [c, d]) = (self.shown, self.computed);
        write!(
            f,
            "{}: {a:e} to {b:e} shown, {c:e} to {d:e} computed",
            self.place
        )
    }
}

/// What a function that rises or falls in each of its arguments makes of spans; `None` where it is not defined.
fn over(inputs: &[Option<Span>], by: impl Fn(&[f64]) -> f64) -> Option<Span> {
    let inputs: Vec<Span> = inputs.iter().copied().collect::<Option<_>>()?;
    let mut found = [f64::INFINITY, f64::NEG_INFINITY];
    for corner in 0..1_usize << inputs.len() {
        let of = |(place, span): (usize, &Span)| span[(corner >> place) & 1];
        let value = by(&inputs.iter().enumerate().map(of).collect::<Vec<_>>());
        if value.is_nan() {
            return None;
        }
        found = [found[0].min(value), found[1].max(value)];
    }
    Some(found)
}

impl Table {
    /// The first column of one of these heads (`a|b`).
    fn column(&self, heads: &str) -> Option<usize> {
        let mut heads = heads
            .split('|')
            .map(|head| head.split('#').next().unwrap_or(head));
        heads.find_map(|head| self.heads.iter().position(|own| matches(head, own)))
    }

    /// The number in a column of a row, the second for `head#1`.
    fn number(&self, row: &[String], head: &str) -> Option<Span> {
        let (head, place) = head.rsplit_once('#').unwrap_or((head, "0"));
        let cell = row.get(self.column(head)?)?;
        let pieces = cell.split([' ', '(']);
        let mut numbers = pieces.filter_map(|piece| Some(leading(piece)?.0));
        numbers.nth(place.parse().ok()?)
    }
}

impl Part {
    fn new(html: &str) -> Self {
        let lines = of_page(html);
        let mut tables: Vec<Table> = Vec::new();
        for (place, line) in lines.iter().enumerate() {
            if line.is_head {
                tables.push(Table {
                    title: lines[place.saturating_sub(1)].text.clone(),
                    heads: line.cells.clone(),
                    rows: Vec::new(),
                });
            } else if let Some(table) = tables.last_mut()
                && line.cells.len() == table.heads.len()
            {
                table.rows.push(line.cells.clone());
            }
        }
        Self { lines, tables }
    }

    /// The number in a column of the row of a label, in the first table that has both, and that table.
    fn elsewhere(&self, label: &str, head: &str) -> Option<(&Table, Span)> {
        self.tables.iter().find_map(|table| {
            let mut rows = table.rows.iter();
            let row = rows.find(|row| name_of(row) == label)?;
            Some((table, table.number(row, head)?))
        })
    }

    /// Tables that have a column.
    fn with<'a>(&'a self, head: &'a str) -> impl Iterator<Item = &'a Table> {
        let tables = self.tables.iter();
        tables.filter(move |table| table.column(head).is_some())
    }

    /// The rows of tables that have a column.
    fn rows<'a>(&'a self, head: &'a str) -> impl Iterator<Item = (&'a Table, &'a Vec<String>)> {
        self.with(head)
            .flat_map(|table| table.rows.iter().map(move |row| (table, row)))
    }

    /// The first number that a pattern finds.
    fn first(&self, pattern: &str) -> Option<Span> {
        self.found(pattern).concat().first().copied()
    }

    /// A count that a pattern finds.
    fn count(&self, pattern: &str) -> Option<f64> {
        self.first(pattern).map(|[low, high]| (low + high) / 2.0)
    }

    /// The numbers of each line that is as a pattern says: `#` is a number, `*` any text without a comma.
    fn found(&self, pattern: &str) -> Vec<Vec<Span>> {
        let lines = self.lines.iter();
        let found = lines.flat_map(|line| {
            line.text
                .split('\n')
                .filter_map(|text| captured(text, pattern))
        });
        found.collect()
    }
}

impl Checks {
    /// A number and what it is computed to be, if both are on the page.
    fn is(&mut self, place: &str, shown: Option<Span>, computed: Option<Span>) {
        if let (Some(shown), Some(computed)) = (shown, computed) {
            let place = place.to_owned();
            self.0.push(Check {
                place,
                shown,
                computed,
            });
        }
    }

    /// The numbers of a column, computed from those of others: of the same row where the table has them, else of
    /// the row of the same label in another table.
    fn columns(&mut self, part: &Part, to: &str, from: &[&str], by: fn(&[f64]) -> f64) {
        for (table, row) in part.rows(to) {
            let inputs = from.iter().map(|head| {
                let own = table.number(row, head);
                own.or_else(|| Some(part.elsewhere(name_of(row), head)?.1))
            });
            let computed = over(&inputs.collect::<Vec<_>>(), by);
            self.is(
                &format!("{}, {to}", name_of(row)),
                table.number(row, to),
                computed,
            );
        }
    }

    /// The numbers of a column in all but the first table that has it.
    fn again(&mut self, part: &Part, head: &str) {
        for (table, row) in part.rows(head) {
            let first = part.elsewhere(name_of(row), head);
            let first = first.filter(|(first, _)| !core::ptr::eq(*first, table));
            self.is(
                name_of(row),
                table.number(row, head),
                first.map(|found| found.1),
            );
        }
    }

    /// The last number of each line that is as a pattern says, computed from those before it.
    fn last(&mut self, part: &Part, pattern: &str, by: fn(&[f64]) -> f64) {
        for all in part.found(pattern) {
            let all: Vec<_> = all.into_iter().map(Some).collect();
            let (inputs, shown) = all.split_at(all.len() - 1);
            self.is(pattern, shown[0], over(inputs, by));
        }
    }
}

/// What a row is of.
fn name_of(row: &[String]) -> &str {
    let name = row.first().map_or("", String::as_str);
    name.split(" [").next().unwrap_or_default()
}

/// The numbers in a text where it is as a pattern says.
fn captured(text: &str, pattern: &str) -> Option<Vec<Span>> {
    let mut places = text.char_indices().map(|(place, _)| place);
    places.find_map(|place| begins(&text[place..], pattern))
}

/// The numbers in a text that begins as a pattern says.
fn begins(text: &str, pattern: &str) -> Option<Vec<Span>> {
    let Some(mut place) = pattern.find(['#', '*']) else {
        return text.starts_with(pattern).then(Vec::new);
    };
    let rest = text.strip_prefix(&pattern[..place])?;
    let is_number = pattern[place..].starts_with('#');
    place += 1;
    if is_number {
        let (span, rest) = leading(rest)?;
        let mut all = begins(rest, &pattern[place..])?;
        all.insert(0, span);
        return Some(all);
    }
    let within = rest.split(',').next().unwrap_or_default();
    let mut places = within.char_indices().map(|(place, _)| place);
    places.find_map(|from| begins(&rest[from..], &pattern[place..]))
}
