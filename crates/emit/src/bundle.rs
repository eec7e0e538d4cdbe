//! The sources of a crate as one module.

use crate::error::EmitError;

/// A crate of the libraries.
pub(crate) struct Sources<'a> {
    /// Name of its module in the file.
    pub(crate) name: &'a str,
    /// Files below the directory of its sources.
    pub(crate) files: &'a [(&'a str, &'a str)],
}

/// Paths of other crates, and those of their modules in the file.
const PATHS: [(&str, &str); 6] = [
    ("::gyrocal_scalar::", "crate::scalar::"),
    ("gyrocal_scalar::", "crate::scalar::"),
    ("::gyrocal_estimation::", "crate::estimation::"),
    ("gyrocal_estimation::", "crate::estimation::"),
    ("::gyrocal::", "crate::gyrocal::"),
    ("libm::", "crate::elementary::"),
];

const OFF: &str = "// emit: off";
const ON: &str = "// emit: on";

impl Sources<'_> {
    /// The text of the module.
    pub(crate) fn module(&self) -> Result<String, EmitError> {
        let inside = self.inside(&mut vec![])?;
        Ok(format!("pub mod {} {{\n{inside}}}\n", self.name))
    }

    /// The text inside a module, those below it included.
    fn inside(&self, path: &mut Vec<String>) -> Result<String, EmitError> {
        let missing = || EmitError::Source {
            module: format!("{}::{}", self.name, path.join("::")),
        };
        let text = self.text(path).ok_or_else(missing)?;
        let mut out = String::new();
        for line in selected(text) {
            match declared(&line) {
                Some((start, module)) => {
                    path.push(module.to_owned());
                    let inside = self.inside(path)?;
                    path.pop();
                    out.push_str(&format!("{start}mod {module} {{\n{inside}}}\n"));
                }
                None => {
                    out.push_str(&self.repathed(&line));
                    out.push('\n');
                }
            }
        }
        Ok(out)
    }

    fn text(&self, path: &[String]) -> Option<&str> {
        let file = |name: String| {
            let mut files = self.files.iter();
            files.find(|(file, _)| *file == name).map(|(_, text)| *text)
        };
        if path.is_empty() {
            return file("lib.rs".to_owned());
        }
        let path = path.join("/");
        file(format!("{path}.rs")).or_else(|| file(format!("{path}/mod.rs")))
    }

    /// A line with the paths of the file.
    fn repathed(&self, line: &str) -> String {
        let mut line = replaced(line, "crate::", &format!("crate::{}::", self.name));
        for (from, to) in PATHS {
            line = replaced(&line, from, to);
        }
        line
    }
}

/// A line with a path in the place of another one that begins there.
fn replaced(line: &str, path: &str, by: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some(at) = rest.find(path) {
        let (before, from) = rest.split_at(at);
        let inside = |letter: char| letter.is_alphanumeric() || matches!(letter, '$' | '_' | ':');
        out.push_str(before);
        out.push_str(match before.ends_with(inside) {
            true => path,
            false => by,
        });
        rest = &from[path.len()..];
    }
    out.push_str(rest);
    out
}

/// A generated module that belongs to no crate of the libraries.
pub(crate) fn generated(name: &str, text: &str) -> String {
    let sources = Sources { name, files: &[] };
    let lines = selected(text);
    let lines: Vec<String> = lines.iter().map(|line| sources.repathed(line)).collect();
    format!("pub mod {name} {{\n{}\n}}\n", lines.join("\n"))
}

/// What declares a module in a file of its own: all before `mod`, and its name.
fn declared(line: &str) -> Option<(&str, &str)> {
    let name = line.trim_end().strip_suffix(';')?;
    let at = name.find("mod ")?;
    let (start, name) = (&name[..at], &name[at + "mod ".len()..]);
    let visible = matches!(start.trim(), "" | "pub" | "pub(crate)" | "pub(super)");
    let word = name
        .chars()
        .all(|letter| letter.is_ascii_alphanumeric() || letter == '_');
    (visible && word).then_some((start, name))
}

/// The lines of a file that belong into one without features and tests.
pub(crate) fn selected(text: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let mut lines = text.lines();
    let mut off = false;
    while let Some(line) = lines.next() {
        let start = line.trim_start();
        match start {
            OFF => off = true,
            ON => {
                off = false;
                continue;
            }
            _ => {}
        }
        if off || start.starts_with("#![no_std]") {
            continue;
        }
        let condition = start
            .strip_prefix("#[cfg(")
            .and_then(|rest| rest.strip_suffix(")]"));
        match condition.and_then(holds) {
            Some(true) => continue,
            Some(false) => {
                let indent = line.len() - start.len();
                while out.last().is_some_and(|last| belongs(last, indent)) {
                    out.pop();
                }
                skip_item(&mut lines, indent);
            }
            None => out.push(line.to_owned()),
        }
    }
    out
}

/// True for documentation and attributes of what follows, at an indentation.
fn belongs(line: &str, indent: usize) -> bool {
    let start = line.trim_start();
    line.len() - start.len() == indent && (start.starts_with("///") || start.starts_with("#["))
}

/// Passes over an item, with its documentation and attributes.
fn skip_item<'a>(lines: &mut impl Iterator<Item = &'a str>, indent: usize) {
    let mut depth = 0_i64;
    for line in lines {
        if depth == 0 && belongs(line, indent) {
            continue;
        }
        for letter in line.chars() {
            match letter {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth -= 1,
                _ => {}
            }
        }
        let start = line.trim_start();
        let closed = line.len() - start.len() == indent && start.starts_with('}');
        if closed || (depth <= 0 && line.ends_with([';', '}'])) {
            return;
        }
    }
}

/// A condition of compilation in the file: features, tests and conditions of build scripts do not hold.
/// `None` for one of the target, which the compiler judges.
fn holds(condition: &str) -> Option<bool> {
    let inside = |name: &str| {
        let rest = condition.strip_prefix(name)?.strip_prefix('(')?;
        Some(parts(rest.strip_suffix(')')?))
    };
    if let Some(parts) = inside("not") {
        return parts
            .first()
            .and_then(|part| holds(part))
            .map(|value| !value);
    }
    if let Some(parts) = inside("all") {
        let values: Vec<Option<bool>> = parts.iter().map(|part| holds(part)).collect();
        return match values.contains(&Some(false)) {
            true => Some(false),
            false => values
                .into_iter()
                .collect::<Option<Vec<bool>>>()
                .map(|_| true),
        };
    }
    if let Some(parts) = inside("any") {
        let values: Vec<Option<bool>> = parts.iter().map(|part| holds(part)).collect();
        return match values.contains(&Some(true)) {
            true => Some(true),
            false => values
                .into_iter()
                .collect::<Option<Vec<bool>>>()
                .map(|_| false),
        };
    }
    match condition.starts_with("target_") {
        true => None,
        false => Some(false),
    }
}

/// The parts of a list, divided by commas outside of parentheses.
fn parts(list: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut from) = (Vec::new(), 0, 0);
    for (at, letter) in list.char_indices() {
        match letter {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(list[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(list[from..].trim());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_judged_but_those_of_the_target() {
        assert_eq!(holds("test"), Some(false));
        assert_eq!(holds("not(feature = \"std\")"), Some(true));
        assert_eq!(
            holds("all(feature = \"x\", not(gyrocal_rederived))"),
            Some(false)
        );
        assert_eq!(holds("any(test, feature = \"batch\")"), Some(false));
        assert_eq!(holds("target_arch = \"arm\""), None);
        assert_eq!(
            holds("all(feature = \"std\", any(target_feature = \"fma\"))"),
            Some(false)
        );
        assert_eq!(
            holds("not(all(feature = \"std\", target_arch = \"arm\"))"),
            Some(true)
        );
    }

    #[test]
    fn items_go_with_their_documentation() {
        let text = "/// Kept.\nfn a() {}\n\n/// Gone.\n#[inline]\n#[cfg(test)]\nfn b(\n    x: u8,\n) -> u8 {\n    \
                    x\n}\nconst C: u8 =\n    1;\n// emit: off\nfn d() {}\n// emit: on\n#[cfg(not(test))]\nfn e() {}";
        let kept = "/// Kept.\nfn a() {}\n\nconst C: u8 =\n    1;\nfn e() {}";
        assert_eq!(selected(text).join("\n"), kept);
    }

    #[test]
    fn paths_lead_to_the_modules_of_the_file() {
        let sources = Sources {
            name: "gyrocal",
            files: &[],
        };
        let found = sources.repathed("use crate::site::{$crate::x}; use ::gyrocal_scalar::Real;");
        let expected = "use crate::gyrocal::site::{$crate::x}; use crate::scalar::Real;";
        assert_eq!(found, expected);
        assert_eq!(
            declared("pub(crate) mod site;"),
            Some(("pub(crate) ", "site"))
        );
        assert_eq!(declared("mod site {"), None);
    }
}
