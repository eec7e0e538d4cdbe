//! Arguments in the wrong order: a table (CSV) where a description (TOML) belongs, and the reverse.

use crate::error::{Error, InputErrorKind};
use crate::source::SourceText;

const ADVICE: &str = "the record or log is given first, its description after --bench or \
    --log-description: the two may be swapped";

impl SourceText {
    /// The error of a text that is a table with columns although a description is expected; `None`
    /// if it is no such table.
    #[must_use]
    pub fn table_in_place_of_description(&self) -> Option<Error> {
        let line = self.first_line();
        let is_table = line.split([',', ';', '\t']).nth(2).is_some()
            && !line.contains(['=', '[', '{', '"', '#']);
        is_table.then(|| {
            self.error(
                InputErrorKind::Syntax,
                0..0,
                "a table with columns, as a record (CSV) has",
                "a description (TOML)",
                ADVICE,
            )
        })
    }

    /// The error of a text that is a description although a table with columns is expected; `None` if
    /// it is no such description.
    #[must_use]
    pub fn description_in_place_of_table(&self) -> Option<Error> {
        let line = self.first_line();
        let is_key = |text: &str| {
            let key = text.trim();
            !key.is_empty()
                && key
                    .chars()
                    .all(|c| c.is_alphanumeric() || "_-.\"".contains(c))
        };
        let is_table = line.starts_with('[') && line.trim_end().ends_with(']');
        let is_value = line.split_once('=').is_some_and(|(key, _)| is_key(key));
        (is_table || is_value).then(|| {
            self.error(
                InputErrorKind::Syntax,
                0..0,
                "a description (TOML)",
                "a table with columns (CSV)",
                ADVICE,
            )
        })
    }

    /// The first line that is neither empty nor a comment; its beginning, if it is long.
    fn first_line(&self) -> &str {
        const LOOKED_AT: usize = 4096;
        let text = self.text();
        let head = &text[..text.floor_char_boundary(LOOKED_AT.min(text.len()))];
        let mut lines = head.lines().map(str::trim_start);
        lines
            .find(|line| !line.is_empty() && !line.starts_with('#'))
            .unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> SourceText {
        SourceText::new(text, "f").unwrap()
    }

    #[test]
    fn tables_and_descriptions_are_told_from_each_other() {
        for table in [
            "time_s,accel_x_g,accel_y_g\n0,1,2\n",
            "# log\n\nt;x;y\n",
            "t\tx\ty",
        ] {
            assert!(source(table).table_in_place_of_description().is_some());
            assert!(source(table).description_in_place_of_table().is_none());
        }
        for description in [
            "# bench\n[site]\n",
            "schema_version = 1\n",
            "a.\"b\" = [1, 2, 3]",
        ] {
            assert!(
                source(description)
                    .description_in_place_of_table()
                    .is_some()
            );
            assert!(
                source(description)
                    .table_in_place_of_description()
                    .is_none()
            );
        }
        for neither in ["{\"a\": 1}", "some words", "time"] {
            assert!(source(neither).description_in_place_of_table().is_none());
            assert!(source(neither).table_in_place_of_description().is_none());
        }
    }
}
