//! Cycles between modules of a crate: groups that use each other, found from paths and imports.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::{self, Visit};
use syn::{Item, ItemUse, UseTree, Visibility};

use super::source::{Crate, Module};

/// Modules that use each other, directly or through others.
pub(crate) struct Cycle {
    /// Crate and, for modules inside a module, the path of that.
    pub(crate) within: String,
    /// The modules.
    pub(crate) members: Vec<String>,
}

/// Cycles between the modules at the top of a crate.
pub(crate) fn at_the_top(of: &Crate) -> Vec<Cycle> {
    cycles(of, &references(of), &[])
}

/// Cycles between the modules inside a module, of all modules that have any.
pub(crate) fn inside(of: &Crate) -> Vec<Cycle> {
    let references = references(of);
    let parents = of.modules.iter().filter(|module| !module.path.is_empty());
    parents
        .flat_map(|parent| cycles(of, &references, &parent.path))
        .collect()
}

/// Pairs of modules, by their full paths, of which the first uses the second. A module also uses
/// the module around it if it takes from there an item that is defined there.
type References = BTreeSet<(Vec<String>, Vec<String>)>;

fn references(of: &Crate) -> References {
    let modules: BTreeMap<&[String], &Module> = of
        .modules
        .iter()
        .map(|module| (module.path.as_slice(), module))
        .collect();
    let mut found = References::new();
    for module in &of.modules {
        let mut paths = Paths {
            module,
            found: Vec::new(),
        };
        for item in &module.items {
            paths.visit_item(item);
        }
        for path in paths.found {
            if let Some(defined) = resolve(&modules, path, 0)
                && defined != module.path
            {
                found.insert((module.path.clone(), defined));
            }
        }
    }
    found
}

/// Groups of children of `parent` that use each other.
fn cycles(of: &Crate, references: &References, parent: &[String]) -> Vec<Cycle> {
    let child = |path: &[String]| -> Option<String> { path.strip_prefix(parent)?.first().cloned() };
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (from, to) in references {
        if let (Some(from), Some(to)) = (child(from), child(to))
            && from != to
        {
            uses.entry(from).or_default().insert(to);
        }
    }
    let reach = |from: &String| {
        let (mut seen, mut pending) = (BTreeSet::new(), vec![from.clone()]);
        while let Some(next) = pending.pop() {
            for to in uses.get(&next).into_iter().flatten() {
                if seen.insert(to.clone()) {
                    pending.push(to.clone());
                }
            }
        }
        seen
    };
    let reached: BTreeMap<&String, BTreeSet<String>> =
        uses.keys().map(|module| (module, reach(module))).collect();
    let mut groups = BTreeSet::new();
    for (module, reaches) in &reached {
        if reaches.contains(*module) {
            let with = reaches.iter().filter(|other| {
                reached
                    .get(other)
                    .is_some_and(|back| back.contains(*module))
            });
            groups.insert(with.cloned().collect::<Vec<String>>());
        }
    }
    let within = core::iter::once(of.name.as_str()).chain(parent.iter().map(String::as_str));
    let within = within.collect::<Vec<_>>().join("::");
    groups
        .into_iter()
        .map(|members| Cycle {
            within: within.clone(),
            members,
        })
        .collect()
}

/// The module that defines the item at the end of a path of names from the root, re-exports
/// followed.
fn resolve(
    modules: &BTreeMap<&[String], &Module>,
    path: Vec<String>,
    depth: usize,
) -> Option<Vec<String>> {
    let longest = (0..=path.len())
        .rev()
        .find(|length| modules.contains_key(&path[..*length]))?;
    let module = modules.get(&path[..longest])?;
    let Some(name) = path.get(longest) else {
        return Some(path);
    };
    // Re-exports of re-exports are rare; what goes round has no end.
    if depth < 8 {
        for item in &module.items {
            if let Item::Use(import) = item
                && !matches!(import.vis, Visibility::Inherited)
            {
                let mut names = Vec::new();
                leaves(&import.tree, &mut Vec::new(), &mut names);
                for (alias, target) in names {
                    if alias == *name
                        && let Some(target) = absolute(&target, module)
                        && target != path
                    {
                        return resolve(modules, target, depth + 1);
                    }
                }
            }
        }
    }
    Some(module.path.clone())
}

/// Paths that a module names, from the root of its crate.
struct Paths<'a> {
    module: &'a Module,
    found: Vec<Vec<String>>,
}

impl<'a> Visit<'a> for Paths<'_> {
    fn visit_item_use(&mut self, import: &'a ItemUse) {
        // A parent's re-exports say nothing of what it needs.
        if !matches!(import.vis, Visibility::Inherited) {
            return;
        }
        let mut names = Vec::new();
        leaves(&import.tree, &mut Vec::new(), &mut names);
        for (_, path) in names {
            self.found.extend(absolute(&path, self.module));
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path
            .segments
            .iter()
            .map(|segment| segment.ident.to_string())
            .collect();
        if names.len() > 1 {
            self.found.extend(absolute(&names, self.module));
        }
        visit::visit_path(self, path);
    }

    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        if !super::source::of_tests(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }
}

/// Name in scope and full path of everything that a tree of imports names.
fn leaves(tree: &UseTree, before: &mut Vec<String>, found: &mut Vec<(String, Vec<String>)>) {
    match tree {
        UseTree::Path(path) => {
            before.push(path.ident.to_string());
            leaves(&path.tree, before, found);
            before.pop();
        }
        UseTree::Group(group) => {
            for tree in &group.items {
                leaves(tree, before, found);
            }
        }
        UseTree::Name(name) if name.ident == "self" => {
            let alias = before.last().cloned().unwrap_or_default();
            found.push((alias, before.clone()));
        }
        UseTree::Name(name) => {
            let name = name.ident.to_string();
            found.push((name.clone(), [before.as_slice(), &[name]].concat()));
        }
        UseTree::Rename(rename) => {
            let path = [before.as_slice(), &[rename.ident.to_string()]].concat();
            found.push((rename.rename.to_string(), path));
        }
        UseTree::Glob(_) => found.push((String::new(), before.clone())),
    }
}

/// A path as written in a module, from the root of the crate; `None` for other crates.
fn absolute(path: &[String], module: &Module) -> Option<Vec<String>> {
    let mut base = match path.first()?.as_str() {
        "crate" => Vec::new(),
        "self" => module.path.clone(),
        "super" => {
            let mut above = module.path.clone();
            above.pop()?;
            above
        }
        // Children of the module stay inside it.
        _ => return None,
    };
    for name in &path[1..] {
        if name == "super" {
            base.pop()?;
        } else {
            base.push(name.clone());
        }
    }
    Some(base)
}
