//! The first ten minutes: the commands of their page, run in a clean clone.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use gyrocal_testkit::workspace;

use crate::harness::{Error, Figure};
use crate::kernel::instructions::output;
use crate::page;

/// Longest time that the commands may take, build included, min.
const LIMIT_MIN: f64 = 10.0;

/// Place that the page clones from, for which the committed state of this tree stands.
const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");

/// Begin and end of a block of a page; a reader runs the commands of those of a shell.
const FENCE: &str = "```";

/// Runs all commands of docs/first-ten-minutes.md in an empty folder, one after the other, and measures
/// their time. Packages of others are fetched where the machine does not have them.
pub(super) fn figure() -> Result<Figure, Error> {
    let text = std::fs::read_to_string(page::docs().join("first-ten-minutes.md"))?;
    let script = script(&text);
    // Beside the builds, where there is room for one more.
    let folder = tempfile::tempdir_in(workspace().join("target"))?;
    let begin = Instant::now();
    run(&script, folder.path())?;
    let minutes = begin.elapsed().as_secs_f64() / 60.0;
    let commands = script.lines().count();
    let name = format!("first ten minutes: {commands} commands of the page from a clean clone");
    Ok(Figure::at_most(&name, LIMIT_MIN, minutes, "min"))
}

fn run(script: &str, folder: &Path) -> Result<(), Error> {
    let here = format!("url.{}.insteadOf", workspace().display());
    let mut bash = Command::new("bash");
    bash.args(["-euo", "pipefail", "-c", script])
        .current_dir(folder);
    bash.env_remove("CARGO_TARGET_DIR").env_remove("RUSTFLAGS");
    let git = [("COUNT", "1"), ("KEY_0", &here), ("VALUE_0", REPOSITORY)];
    bash.envs(git.map(|(key, value)| (format!("GIT_CONFIG_{key}"), value)));
    let ran = output(&mut bash);
    ran.map_err(|error| format!("docs/first-ten-minutes.md: {error}"))?;
    Ok(())
}

/// The commands of a page, one a line, as a reader would type them.
fn script(page: &str) -> String {
    let mut script = String::new();
    // Blocks and what is between them, in turns.
    for block in page.split(FENCE).skip(1).step_by(2) {
        let (kind, block) = block.split_once('\n').unwrap_or_default();
        let block = block.replace("\\\n", " ");
        let typed = |line| match kind {
            "sh" => Some(line),
            _ => str::strip_prefix(line, "$ ").filter(|_| kind == "console"),
        };
        let commands = block.lines().filter_map(typed);
        script.extend(commands.flat_map(|command| [command, "\n"]));
    }
    script
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_the_commands_without_what_they_print() {
        let page = "a\n```sh\nmake \\\n  all\n```\n```toml\nx = 1\n```\n\
                    ```console\n$ show \\\n    this\nsize 3 $ 4\n$ end\n```\n";
        assert_eq!(script(page), "make    all\nshow      this\nend\n");
    }

    #[test]
    fn the_page_clones_builds_and_goes_on_to_the_gain() {
        let path = page::docs().join("first-ten-minutes.md");
        let script = script(&std::fs::read_to_string(path).expect("the page is committed"));
        let mut rest = script.as_str();
        for part in [
            format!("git clone {REPOSITORY}").as_str(),
            "cargo build --release",
            "gyrocal simulate",
            "gyrocal diagnose",
            "gyrocal calibrate",
            "gyrocal extend",
            "--validate",
        ] {
            let at = rest.find(part);
            let at = at.unwrap_or_else(|| panic!("`{part}` is missing, or earlier"));
            rest = &rest[at..];
        }
    }
}
