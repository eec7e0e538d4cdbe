//! The Rust sources of the workspace as syntax trees, module by module, without tests.

use std::fs;
use std::path::{Path, PathBuf};

use syn::{Attribute, Item, ItemMod, Meta};

use crate::error::Error;

/// A crate of the workspace.
pub(crate) struct Crate {
    /// Name of the package, `gyrocal-` left out.
    pub(crate) name: String,
    /// All modules, the root first.
    pub(crate) modules: Vec<Module>,
}

/// A module that is not a test and not generated.
pub(crate) struct Module {
    /// Names from the root of the crate; empty for the root.
    pub(crate) path: Vec<String>,
    /// The file, from the root of the workspace.
    pub(crate) file: PathBuf,
    /// Lines of the file; zero for a module written inside another.
    pub(crate) lines: usize,
    /// Its items, without modules and tests.
    pub(crate) items: Vec<Item>,
}

/// The crates of a workspace: every library and command, hand-written sources only.
pub(crate) fn crates(workspace: &Path) -> Result<Vec<Crate>, Error> {
    let mut packages = vec![workspace.to_owned(), workspace.join("codegen/emit")];
    let mut members = Vec::new();
    for entry in fs::read_dir(workspace.join("crates"))? {
        members.push(entry?.path());
    }
    members.sort();
    packages.extend(members);
    let mut crates = Vec::new();
    for package in packages {
        for root in ["src/lib.rs", "src/main.rs"] {
            let root = package.join(root);
            if root.is_file() {
                crates.push(read(workspace, &package, &root)?);
            }
        }
    }
    Ok(crates)
}

fn read(workspace: &Path, package: &Path, root: &Path) -> Result<Crate, Error> {
    let name = match package.strip_prefix(workspace)?.iter().next_back() {
        Some(folder) => folder.to_string_lossy().into_owned(),
        None => "gyrocal".to_owned(),
    };
    let mut reader = Reader {
        workspace,
        modules: Vec::new(),
    };
    let folder = root.parent().unwrap_or(package);
    reader.file(root, folder, Vec::new())?;
    Ok(Crate {
        name,
        modules: reader.modules,
    })
}

struct Reader<'a> {
    workspace: &'a Path,
    modules: Vec<Module>,
}

impl Reader<'_> {
    /// Reads a file and the modules that it declares, which are looked for in `folder`.
    fn file(&mut self, file: &Path, folder: &Path, path: Vec<String>) -> Result<(), Error> {
        let text = fs::read_to_string(file)?;
        if text.starts_with("// @generated") {
            return Ok(());
        }
        let syntax =
            syn::parse_file(&text).map_err(|error| format!("{}: {error}", file.display()))?;
        let lines = text.lines().count();
        self.items(file, folder, path, lines, syntax.items)
    }

    fn items(
        &mut self,
        file: &Path,
        folder: &Path,
        path: Vec<String>,
        lines: usize,
        items: Vec<Item>,
    ) -> Result<(), Error> {
        let place = self.modules.len();
        self.modules.push(Module {
            path: path.clone(),
            file: file.strip_prefix(self.workspace)?.to_owned(),
            lines,
            items: Vec::new(),
        });
        for item in items {
            if attributes(&item).is_some_and(of_tests) {
                continue;
            }
            match item {
                Item::Mod(module) => self.module(file, folder, &path, module)?,
                item => self.modules[place].items.push(item),
            }
        }
        Ok(())
    }

    fn module(
        &mut self,
        file: &Path,
        folder: &Path,
        path: &[String],
        module: ItemMod,
    ) -> Result<(), Error> {
        let name = module.ident.to_string();
        let below = folder.join(&name);
        let path = [path, std::slice::from_ref(&name)].concat();
        if let Some((_, items)) = module.content {
            return self.items(file, &below, path, 0, items);
        }
        // Files in other places are generated ones.
        if module
            .attrs
            .iter()
            .any(|attribute| attribute.path().is_ident("path"))
        {
            return Ok(());
        }
        let beside = folder.join(format!("{name}.rs"));
        let inside = below.join("mod.rs");
        let found = if beside.is_file() { beside } else { inside };
        self.file(&found, &below, path)
    }
}

/// True for `#[test]` and for `#[cfg(...)]` with `test` in it.
pub(crate) fn of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) => {
            list.path.is_ident("cfg")
                && list
                    .tokens
                    .to_string()
                    .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
                    .any(|word| word == "test")
        }
        Meta::NameValue(_) => false,
    })
}

fn attributes(item: &Item) -> Option<&[Attribute]> {
    Some(match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => return None,
    })
}
