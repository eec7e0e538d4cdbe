//! Names of the local variables of one function.

use std::collections::{BTreeMap, BTreeSet};

use crate::Program;
use crate::program::{Function, Output};

/// Gives each variable a name that nothing else in the function has.
pub(super) struct Locals {
    taken: BTreeSet<String>,
    /// For each name that was taken more than once the number that it was given last.
    numbers: BTreeMap<String, usize>,
    temporaries: usize,
}

impl Locals {
    /// With the arguments of the function taken, and the names of the elements of each.
    ///
    /// An element that has a name in common with another argument or element gets the name
    /// of its group before its own.
    pub(super) fn new(program: &Program, function: &Function) -> (Self, Vec<Vec<String>>) {
        let groups: Vec<_> = program.inputs_of(function).collect();
        let all = || groups.iter().flat_map(|group| &group.elements);
        let mut locals = Self {
            taken: groups
                .iter()
                .map(|group| &group.name)
                .chain(program.externals.iter().map(|external| &external.name))
                .cloned()
                .collect(),
            numbers: BTreeMap::new(),
            temporaries: 0,
        };
        let elements = groups
            .iter()
            .map(|group| {
                group
                    .elements
                    .iter()
                    .map(|element| {
                        let name = &element.name;
                        let is_shared = all().filter(|other| other.name == *name).count() > 1;
                        let is_argument = groups.iter().any(|group| group.name == *name)
                            || program.externals.iter().any(|other| other.name == *name);
                        // `let [dt] = *dt;` shadows an argument that is not needed again.
                        if !is_shared && (!is_argument || group.name == *name) {
                            locals.taken.insert(name.clone());
                            return name.clone();
                        }
                        locals.unique(&format!("{}_{name}", group.name))
                    })
                    .collect()
            })
            .collect();
        (locals, elements)
    }

    /// The name itself if it is free.
    pub(super) fn exactly(&mut self, name: &str) -> Option<String> {
        self.taken.insert(name.to_owned()).then(|| name.to_owned())
    }

    /// The name, with a number if it is taken.
    pub(super) fn unique(&mut self, name: &str) -> String {
        if let Some(name) = self.exactly(name) {
            return name;
        }
        // Names are never given back, so lower numbers stay taken.
        let mut number = self.numbers.get(name).map_or(2, |last| last + 1);
        loop {
            if let Some(unique) = self.exactly(&format!("{name}_{number}")) {
                self.numbers.insert(name.to_owned(), number);
                return unique;
            }
            number += 1;
        }
    }

    /// `t1`, `t2`, ...
    pub(super) fn temporary(&mut self) -> String {
        loop {
            self.temporaries += 1;
            if let Some(name) = self.exactly(&format!("t{}", self.temporaries)) {
                return name;
            }
        }
    }

    /// A name for an element of an output, if its rows have names.
    pub(super) fn of_output(&mut self, output: &Output, nonzero: usize) -> Option<String> {
        let (row, column) = output.nonzeros[nonzero];
        let row = output.row_names.get(row)?;
        let name = match output.column_names.get(column) {
            None if output.columns == 1 => row.clone(),
            None => return None,
            Some(column) if output.name.contains("_d_") => format!("{row}_d_{column}"),
            Some(column) => format!("{row}_{column}"),
        };
        self.exactly(&name)
            .or_else(|| self.exactly(&format!("{}_{name}", output.name)))
    }
}
