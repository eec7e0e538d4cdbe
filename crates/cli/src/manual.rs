//! `gyrocal completions` and `gyrocal man`: completions of shells and manual pages, from the definition
//! of the command line.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use gyrocal_document::{Screen, Standing};
use gyrocal_record::{Outputs, printable_path};
use miette::miette;

use crate::Failure;
use crate::outputs::make_folder;
use crate::reply::Reply;

/// Print the completions of a shell.
#[derive(Debug, Args)]
pub(crate) struct CompletionsArguments {
    /// The shell.
    shell: Shell,
}

/// Write the manual pages, one for each command.
#[derive(Debug, Args)]
pub(crate) struct ManArguments {
    /// The folder, which is made if it does not exist.
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Runs `gyrocal completions` of a command line; returns the completions.
pub(crate) fn completions(
    arguments: &CompletionsArguments,
    mut definition: Command,
) -> Result<Reply, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut definition, "gyrocal", &mut script);
    Ok(String::from_utf8_lossy(&script).into_owned().into())
}

/// Runs `gyrocal man` of a command line: writes all pages or none.
pub(crate) fn pages(arguments: &ManArguments, mut definition: Command) -> Result<Reply, Failure> {
    let folder = &arguments.folder;
    let mut outputs = Outputs::new();
    make_folder("", folder, &mut outputs)?;
    definition.build();
    let mut names = Vec::new();
    stage(&definition, folder, &mut outputs, &mut names)?;
    let what = format!("{} manual pages in {}", names.len(), printable_path(folder));
    let mut screen = Screen::new(Standing::Neutral, "WROTE", what);
    screen.fact("pages", names.join(", "));
    Ok(Reply {
        outputs,
        ..Reply::of(screen, String::new())
    })
}

fn stage(
    command: &Command,
    folder: &std::path::Path,
    outputs: &mut Outputs,
    names: &mut Vec<String>,
) -> Result<(), Failure> {
    let name = command
        .get_display_name()
        .unwrap_or(command.get_name())
        .to_owned();
    let page = Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text)
        .map_err(|reason| Failure::Work(miette!("{name}: no page: {reason}")))?;
    outputs.stage(&folder.join(format!("{name}.1")), &text)?;
    names.push(name);
    let subcommands = command.get_subcommands();
    for subcommand in subcommands.filter(|subcommand| subcommand.get_name() != "help") {
        stage(subcommand, folder, outputs, names)?;
    }
    Ok(())
}
