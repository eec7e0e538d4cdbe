//! Tables with keys of any name.

use std::collections::BTreeMap;

use toml::Spanned;
use toml::de::DeValue;

use super::Table;
use crate::error::Error;

impl Table<'_> {
    /// The entries of a table inside this one that may have any keys, or be absent: texts, and numbers and dates
    /// as they are written; those of a list with commas between them.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is no table, or a value is anything else.
    pub fn facts(&self, key: &str) -> Result<BTreeMap<String, String>, Error> {
        let Some(table) = self.free_table(key)? else {
            return Ok(BTreeMap::new());
        };
        let entries = table.entries.iter();
        let facts = entries.map(|(name, value)| Ok((name.to_string(), table.fact(value)?)));
        facts.collect()
    }

    fn fact(&self, value: &Spanned<DeValue<'_>>) -> Result<String, Error> {
        match value.get_ref() {
            DeValue::String(text) => Ok(text.to_string()),
            DeValue::Integer(_) | DeValue::Float(_) | DeValue::Datetime(_) => {
                Ok(self.source.text()[value.span()].to_owned())
            }
            DeValue::Array(all) => {
                let all = all.iter().map(|item| self.fact(item));
                Ok(all.collect::<Result<Vec<_>, _>>()?.join(", "))
            }
            _ => Err(self.wrong_type(value, "a text, a number, a date, or a list of such")),
        }
    }
}
