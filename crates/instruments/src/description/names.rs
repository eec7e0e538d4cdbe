//! Names of units: what a description may call them, and its schema with it.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, Visitor};

/// A unit that has names, of which the first is the one that is written.
pub(super) trait Named: Copy + 'static {
    /// The units with their names.
    const NAMES: &'static [(Self, &'static [&'static str])];
}

/// Declares units with their names, as they are read and written, and as the schema has them.
macro_rules! named_units {
    (
        $(#[doc = $of_all:literal])+
        $name:ident {
            $($(#[doc = $of_one:literal])+ $unit:ident = $names:expr,)+
        }
    ) => {
        $(#[doc = $of_all])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum $name {
            $($(#[doc = $of_one])+ $unit,)+
        }

        impl $crate::description::names::Named for $name {
            const NAMES: &'static [(Self, &'static [&'static str])] = &[$((Self::$unit, $names)),+];
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                let names: &[&str] = match self {
                    $(Self::$unit => $names,)+
                };
                serializer.serialize_str(names[0])
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_str($crate::description::names::ByName::new())
            }
        }

        #[cfg(feature = "schema")]
        impl schemars::JsonSchema for $name {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                let words = |lines: &[&str]| {
                    let lines: Vec<&str> = lines.iter().map(|line| line.trim()).collect();
                    lines.join("\n")
                };
                schemars::json_schema!({
                    "description": words(&[$($of_all),+]),
                    "oneOf": [$({
                        "description": words(&[$($of_one),+]),
                        "type": "string",
                        "enum": $names,
                    }),+],
                })
            }
        }
    };
}

pub(super) use named_units;

/// Reads a unit by one of its names.
pub(super) struct ByName<T>(PhantomData<T>);

impl<T> ByName<T> {
    pub(super) fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T: Named> Visitor<'_> for ByName<T> {
    type Value = T;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("the name of a unit")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        let found = T::NAMES.iter().find(|(_, names)| names.contains(&text));
        found.map(|(unit, _)| *unit).ok_or_else(|| {
            let names = T::NAMES.iter().map(|(_, names)| format!("`{}`", names[0]));
            let names: Vec<String> = names.collect();
            E::custom(format!(
                "unknown variant `{text}`, expected one of {}",
                names.join(", ")
            ))
        })
    }
}
