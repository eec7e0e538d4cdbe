//! TOML tables, read key by key with located errors.

mod facts;

use std::collections::BTreeSet;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

use crate::bound::Bound;
use crate::error::{Error, InputErrorKind};
use crate::source::{SourceText, quoted};
use crate::suggest::{any_of, similar_names};

/// One table of a TOML file, with the keys that it may have.
#[derive(Debug)]
pub struct Table<'a> {
    source: &'a SourceText,
    name: String,
    entries: &'a DeTable<'a>,
    span: Range<usize>,
}

/// A text in a TOML file.
#[derive(Debug)]
pub(crate) struct Text<'a> {
    source: &'a SourceText,
    /// The text.
    pub(crate) text: &'a str,
    span: Range<usize>,
}

impl Text<'_> {
    /// An error at the place of the text.
    pub(crate) fn error(
        &self,
        kind: InputErrorKind,
        expected: &str,
        advice: impl Into<String>,
    ) -> Error {
        let found = quoted(self.text);
        self.source
            .error(kind, self.span.clone(), found, expected, advice)
    }
}

impl<'a> Table<'a> {
    /// The root table of a file, which may have the keys `known`.
    pub(crate) fn root(
        source: &'a SourceText,
        entries: &'a DeTable<'a>,
        known: &[&str],
    ) -> Result<Self, Error> {
        let table = Self {
            source,
            name: String::new(),
            entries,
            span: 0..0,
        };
        table.refuse_unknown(known)?;
        Ok(table)
    }

    /// A table inside this one, which may have the keys `known`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is absent, is no table, or has an unknown key.
    pub fn table(&self, key: &str, known: &[&str]) -> Result<Table<'a>, Error> {
        self.optional_table(key, known)?
            .ok_or_else(|| self.missing(&format!("the table `[{key}]`"), known))
    }

    /// A table inside this one that may be absent.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is no table or has an unknown key.
    pub fn optional_table(&self, key: &str, known: &[&str]) -> Result<Option<Table<'a>>, Error> {
        let table = self.free_table(key)?;
        if let Some(table) = &table {
            table.refuse_unknown(known)?;
        }
        Ok(table)
    }

    /// A table inside this one with any keys.
    fn free_table(&self, key: &str) -> Result<Option<Table<'a>>, Error> {
        let Some((key_span, value)) = self.entry(key) else {
            return Ok(None);
        };
        let Some(entries) = value.get_ref().as_table() else {
            return Err(self.wrong_type(value, &format!("a table `[{key}]`")));
        };
        Ok(Some(Table {
            source: self.source,
            name: key.to_owned(),
            entries,
            span: key_span,
        }))
    }

    /// A number.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is absent, no number, or out of bounds.
    pub fn number(&self, key: &str, bound: Bound) -> Result<f64, Error> {
        self.optional_number(key, bound)?
            .ok_or_else(|| self.missing(&format!("`{key} = ` {}", bound.describe()), &[]))
    }

    /// A number that may be absent.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is no number or out of bounds.
    pub fn optional_number(&self, key: &str, bound: Bound) -> Result<Option<f64>, Error> {
        self.read(key, |value| self.as_number(value, bound))
    }

    /// Three numbers, for x, y and z.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if they are absent, not three, no numbers, or out of bounds.
    pub fn three_numbers(&self, key: &str, bound: Bound) -> Result<[f64; 3], Error> {
        self.optional_three_numbers(key, bound)?
            .ok_or_else(|| self.missing(&format!("`{key} = [x, y, z]`"), &[]))
    }

    /// Three numbers, for x, y and z, or nothing.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if what is there is not three numbers, or out of bounds.
    pub fn optional_three_numbers(
        &self,
        key: &str,
        bound: Bound,
    ) -> Result<Option<[f64; 3]>, Error> {
        self.read(key, |value| self.as_three(value, bound))
    }

    /// Two numbers, or nothing.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if what is there is not two numbers, or out of bounds.
    pub fn optional_two_numbers(&self, key: &str, bound: Bound) -> Result<Option<[f64; 2]>, Error> {
        self.read(key, |value| {
            self.numbers(value, bound, "two numbers `[from, to]`")
        })
    }

    /// Three numbers, or one that stands for all three, or nothing.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if what is there is neither, or out of bounds.
    pub fn optional_one_or_three(
        &self,
        key: &str,
        bound: Bound,
    ) -> Result<Option<[f64; 3]>, Error> {
        self.read(key, |value| match value.get_ref().is_array() {
            true => self.as_three(value, bound),
            false => self.as_number(value, bound).map(|one| [one; 3]),
        })
    }

    /// Pairs of numbers `[[a, b], …]` that may be absent.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if what is there is something else, or if an `a` is not less than its `b`.
    pub fn optional_intervals(&self, key: &str, bound: Bound) -> Result<Vec<[f64; 2]>, Error> {
        const EXPECTED: &str = "intervals `[[from, to], …]` with from less than to";
        let interval = |value: &Spanned<DeValue<'_>>| match self.numbers(value, bound, EXPECTED)? {
            [from, to] if from < to => Ok([from, to]),
            _ => Err(self.value_error(InputErrorKind::OutOfRange, value, EXPECTED, "")),
        };
        let intervals = self.read(key, |value| {
            let intervals = value.get_ref().as_array();
            let intervals = intervals.ok_or_else(|| self.wrong_type(value, EXPECTED))?;
            intervals.iter().map(interval).collect()
        });
        Ok(intervals?.unwrap_or_default())
    }

    /// A whole number from 0, as seeds are.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is absent or anything else.
    pub fn whole_number(&self, key: &str) -> Result<u64, Error> {
        const EXPECTED: &str = "a whole number from 0 to 9223372036854775807";
        let Some((_, value)) = self.entry(key) else {
            return Err(self.missing(&format!("`{key} = ` {EXPECTED}"), &[]));
        };
        value
            .get_ref()
            .as_integer()
            .and_then(whole)
            .and_then(|integer| u64::try_from(integer).ok())
            .ok_or_else(|| self.wrong_type(value, EXPECTED))
    }

    /// Texts in a list that is not empty, each with its place.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the list is absent, empty or anything else.
    pub(crate) fn texts(&self, key: &str, expected: &str) -> Result<Vec<Text<'a>>, Error> {
        let Some((_, value)) = self.entry(key) else {
            return Err(self.missing(&format!("`{key} = ` {expected}"), &[]));
        };
        let items = value.get_ref().as_array().filter(|items| !items.is_empty());
        let items = items.ok_or_else(|| self.wrong_type(value, expected))?;
        items.iter().map(|item| self.text(item, expected)).collect()
    }

    /// A text that may be absent, with its place.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if what is there is no text.
    pub(crate) fn optional_text(
        &self,
        key: &str,
        expected: &str,
    ) -> Result<Option<Text<'a>>, Error> {
        self.read(key, |value| self.text(value, expected))
    }

    /// Whether the value of a key is this word.
    #[must_use]
    pub fn is_word(&self, key: &str, word: &str) -> bool {
        self.entry(key)
            .is_some_and(|(_, value)| value.get_ref().as_str() == Some(word))
    }

    /// An error at the value of a key, or at the table's head if the key is absent.
    #[must_use]
    pub fn error_at(&self, key: &str, kind: InputErrorKind, expected: &str, advice: &str) -> Error {
        match self.entry(key) {
            Some((_, value)) => self.value_error(kind, value, expected, advice),
            None => self.missing(&format!("`{key}`: {expected}"), &[]),
        }
    }

    fn entry(&self, key: &str) -> Option<(Range<usize>, &'a Spanned<DeValue<'a>>)> {
        self.entries
            .iter()
            .find(|(name, _)| name.get_ref() == key)
            .map(|(name, value)| (name.span(), value))
    }

    /// What is read of the value of a key; nothing where it is absent.
    fn read<T>(
        &self,
        key: &str,
        read: impl FnOnce(&'a Spanned<DeValue<'a>>) -> Result<T, Error>,
    ) -> Result<Option<T>, Error> {
        self.entry(key).map(|(_, value)| read(value)).transpose()
    }

    fn refuse_unknown(&self, known: &[&str]) -> Result<(), Error> {
        let unknown = self
            .entries
            .iter()
            .filter(|(name, _)| !known.contains(&name.get_ref().as_ref()))
            .min_by_key(|(name, _)| name.span().start);
        let Some((name, _)) = unknown else {
            return Ok(());
        };
        let absent: BTreeSet<&str> = known
            .iter()
            .copied()
            .filter(|key| self.entry(key).is_none())
            .collect();
        let absent: Vec<&str> = absent.into_iter().collect();
        let advice = match similar_names(name.get_ref(), &absent, 1)[..] {
            [near, ..] => format!("did you mean `{near}`?"),
            [] => "remove it, or see the format in the documentation".to_owned(),
        };
        Err(self.source.error(
            InputErrorKind::UnknownKey,
            name.span(),
            format!("the unknown key {}{}", quoted(name.get_ref()), self.place()),
            any_of(known),
            advice,
        ))
    }

    fn place(&self) -> String {
        if self.name.is_empty() {
            String::new()
        } else {
            format!(" in `[{}]`", self.name)
        }
    }

    fn missing(&self, expected: &str, keys: &[&str]) -> Error {
        let found = if self.name.is_empty() {
            "a file without it".to_owned()
        } else {
            format!("`[{}]` without it", self.name)
        };
        let advice = if keys.is_empty() {
            "add the line".to_owned()
        } else {
            format!("add the table with {}", any_of(keys))
        };
        self.source.error(
            InputErrorKind::MissingKey,
            self.span.clone(),
            found,
            expected,
            advice,
        )
    }

    fn as_three(&self, value: &Spanned<DeValue<'_>>, bound: Bound) -> Result<[f64; 3], Error> {
        self.numbers(value, bound, "three numbers `[x, y, z]`")
    }

    fn numbers<const N: usize>(
        &self,
        value: &Spanned<DeValue<'_>>,
        bound: Bound,
        expected: &str,
    ) -> Result<[f64; N], Error> {
        let items = value.get_ref().as_array().map_or(&[][..], |all| &all[..]);
        if items.len() != N {
            return Err(self.wrong_type(value, expected));
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = self.as_number(item, bound)?;
        }
        Ok(numbers)
    }

    fn text(&self, value: &'a Spanned<DeValue<'a>>, expected: &str) -> Result<Text<'a>, Error> {
        let text = value.get_ref().as_str();
        Ok(Text {
            source: self.source,
            text: text.ok_or_else(|| self.wrong_type(value, expected))?,
            span: value.span(),
        })
    }

    fn as_number(&self, value: &Spanned<DeValue<'_>>, bound: Bound) -> Result<f64, Error> {
        let number = match value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => whole(integer).map(|integer| integer as f64),
            _ => None,
        };
        let kind = match number {
            Some(number) if bound.holds(number) => return Ok(number),
            Some(_) => InputErrorKind::OutOfRange,
            None => InputErrorKind::NotANumber,
        };
        Err(self.value_error(kind, value, &bound.describe(), ""))
    }

    fn wrong_type(&self, value: &Spanned<DeValue<'_>>, expected: &str) -> Error {
        self.value_error(InputErrorKind::WrongType, value, expected, "")
    }

    fn value_error(
        &self,
        kind: InputErrorKind,
        value: &Spanned<DeValue<'_>>,
        expected: &str,
        advice: &str,
    ) -> Error {
        let there = self.source.text().get(value.span()).unwrap_or("");
        self.source
            .error(kind, value.span(), quoted(there), expected, advice)
    }
}

fn whole(integer: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}
