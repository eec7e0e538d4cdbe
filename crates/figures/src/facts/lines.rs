//! Lines of what a command shows, on a terminal and on a page. A row of a table is a line, and so is a paragraph.

use super::values::{command, numbers, plain};

/// A line.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    /// Its text: cells apart by tabs, what begins below another line by newlines.
    pub(super) text: String,
    /// First of the cells of a row, if it is no number.
    pub(super) label: String,
    /// The verdict that it begins with.
    pub(super) verdict: String,
    /// The command in it, which its text does not have.
    pub(super) command: String,
    /// Cells of a row of a page, the empty ones too.
    pub(super) cells: Vec<String>,
    /// Whether the cells are the heads of columns.
    pub(super) is_head: bool,
}

impl Line {
    pub(super) fn new(text: &str, verdict: &str) -> Self {
        let text = plain(text);
        let (label, _) = text.split_once('\t').unwrap_or_default();
        let command = command(&text);
        let (before, after) = text.split_once(&command).unwrap_or_default();
        Self {
            text: format!("{before} {after}").trim().to_owned(),
            label: match numbers(label).is_empty() {
                true => label.to_owned(),
                false => String::new(),
            },
            verdict: plain(verdict),
            command,
            ..Self::default()
        }
    }

    fn of_cells(cells: &[String], is_head: bool) -> Self {
        let full = cells.iter().filter(|cell| !cell.is_empty());
        let full: Vec<&str> = full.map(String::as_str).collect();
        Self {
            cells: cells.iter().map(|cell| spaced(&plain(cell))).collect(),
            is_head,
            // The heads of columns are no row.
            ..Self::new(&full.join(if is_head { " " } else { "\t" }), "")
        }
    }
}

/// A text with single spaces.
fn spaced(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Lines of the first screen, and of what stands below it.
pub(super) fn of_terminal(text: &str) -> [Vec<Line>; 2] {
    let (screen, details) = text.split_once("\n\n").unwrap_or((text, ""));
    let mut screen = of_blocks(screen, true);
    if let Some(first) = screen.first_mut() {
        let loud = first.text.split("  ").next();
        let loud = loud.filter(|words| !words.contains(char::is_lowercase));
        first.verdict = loud.unwrap_or_default().to_owned();
    }
    [screen, of_blocks(details, false)]
}

/// Lines of a text. Those of a paragraph are one, unless they are `apart`.
fn of_blocks(text: &str, apart: bool) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    let mut paragraph = String::new();
    let (mut is_table, mut end) = (false, |paragraph: &mut String| {
        if !paragraph.is_empty() {
            lines.push(Line::new(&core::mem::take(paragraph), ""));
        }
    });
    let mut rows = Vec::new();
    for line in text.lines() {
        let own = line.trim();
        is_table &= line.starts_with(' ') && !own.is_empty();
        if own.starts_with('─') {
            is_table = true;
        } else if is_table {
            let cells = own.split("  ").map(str::trim);
            let cells: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
            rows.push(Line::new(&cells.join("\t"), ""));
        } else {
            let begins = |letter: fn(char) -> bool| own.starts_with(letter);
            let is_entry =
                own.starts_with("- ") || (begins(|c| c.is_ascii_digit()) && own.contains(". "));
            let is_item = line.starts_with("  ") && !line.starts_with("   ");
            if own.is_empty() || apart || is_entry || is_item {
                end(&mut paragraph);
            }
            let gap = if begins(char::is_uppercase) {
                "\n"
            } else {
                " "
            };
            if !paragraph.is_empty() {
                paragraph += gap;
            }
            paragraph += own;
        }
    }
    end(&mut paragraph);
    lines.extend(rows);
    lines
}

/// Lines of a page, without what its charts draw.
pub(super) fn of_page(html: &str) -> Vec<Line> {
    /// Elements that a reader does not see.
    const UNSEEN: [&str; 3] = ["script", "style", "button"];
    /// Elements that do not end a line.
    const WITHIN: [&str; 9] = ["a", "b", "code", "em", "i", "span", "strong", "sub", "sup"];
    let mut lines = Vec::new();
    let (mut text, mut cells, mut is_row) = (String::new(), Vec::new(), false);
    let (mut rest, mut is_head) = (html, false);
    while let Some((before, after)) = rest.split_once('<') {
        text += before;
        let (tag, after) = after.split_once('>').unwrap_or((after, ""));
        let name = tag.split([' ', '\n']).next().unwrap_or_default();
        rest = after;
        if UNSEEN.contains(&name) {
            let end = format!("</{name}>");
            rest = after.split_once(&end).map_or("", |(_, after)| after);
        }
        if WITHIN.contains(&name.trim_start_matches('/')) {
            text.push(' ');
            continue;
        }
        is_row |= name == "tr";
        is_head = (is_head || name == "thead") && name != "/thead";
        if is_row && !matches!(name, "/td" | "/th" | "/tr") {
            text.push(' ');
            continue;
        }
        let own = core::mem::take(&mut text);
        let own = unescaped(spaced(&own));
        if is_row {
            if name == "/tr" {
                is_row = false;
                lines.push(Line::of_cells(&core::mem::take(&mut cells), is_head));
            } else {
                cells.push(own);
            }
        } else if !own.is_empty() {
            let verdict = own.split(':').next().filter(|_| name == "/h1");
            lines.push(Line::new(&own, verdict.unwrap_or_default()));
        }
    }
    lines
}

fn unescaped(text: String) -> String {
    const ENTITIES: [(&str, &str); 6] = [
        ("&#x2f;", "/"),
        ("&#x27;", "'"),
        ("&quot;", "\""),
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&amp;", "&"),
    ];
    let replaced = |text: String, (name, letter): (&str, &str)| text.replace(name, letter);
    ENTITIES.into_iter().fold(text, replaced)
}
