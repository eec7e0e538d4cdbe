//! What the help of every command has beside its options: examples, groups, exit codes.

use clap::Command;

use crate::exit;

/// Heading of options that name files to write.
const FILES: &str = "Files to write";

/// Heading of options that name files to read.
const READ: &str = "Files to read";

/// Ids of options that name files to read.
const INPUTS: [&str; 9] = [
    "bench",
    "benches",
    "diagnosis",
    "gyro_axes",
    "log_description",
    "module",
    "validate",
    "validate_bench",
    "validate_gyro_axes",
];

/// Ids of options that name files to write.
const WRITTEN: [&str; 10] = [
    "json",
    "coefficients",
    "findings",
    "figures",
    "markdown",
    "out",
    "bench_out",
    "axes_out",
    "results",
    "report",
];

/// Examples of all commands, each a meaning and a command line.
const EXAMPLES: &str = include_str!("examples.txt");

/// The screen of `gyrocal` without a command.
pub(crate) const WELCOME: &str = "\
gyrocal calibrates and diagnoses the gyros of a stabilised platform.

What people do first:

  calibrate a record         gyrocal calibrate RECORD.csv --bench BENCH.toml
                             nine drift coefficients with their sigmas
  find what is wrong         gyrocal diagnose RECORD.csv --bench BENCH.toml
                             the cause of a misfit, and what else it might be
  plan the next run          gyrocal plan RECORD.csv --bench BENCH.toml
                             attitude and duration that decide what is open
  test a sensor on a table   gyrocal tumble LOG.csv --log-description LOG.toml
                             drift law from static stops; allan: its noise

No data yet?                 gyrocal simulate SCENARIO.toml --out RECORD.csv \\
                               --bench-out BENCH.toml
All commands                 gyrocal --help
One of them, with examples   gyrocal diagnose --help
The effects it knows         gyrocal effects
";

/// The definition of the command line with examples, groups and exit codes.
pub(crate) fn completed(command: Command) -> Command {
    let command = command.after_help(exit::HELP);
    command.mut_subcommands(|subcommand| with_examples(grouped(subcommand)))
}

/// Options that name files, under headings of their own.
fn grouped(command: Command) -> Command {
    let command = command.mut_subcommands(grouped);
    command.mut_args(|argument| {
        let id = argument.get_id().as_str().to_owned();
        match () {
            () if argument.is_positional() => argument,
            () if WRITTEN.contains(&&*id) => argument.help_heading(FILES),
            () if INPUTS.contains(&&*id) => argument.help_heading(READ),
            () => argument,
        }
    })
}

fn with_examples(command: Command) -> Command {
    let name = Some(command.get_name());
    let lines: Vec<&str> = EXAMPLES.lines().collect();
    let own = lines.chunks(2);
    let own = own.filter(|pair| pair.last().and_then(|line| line.split(' ').nth(1)) == name);
    let own: String = own.flatten().map(|line| format!("  {line}\n")).collect();
    match &*own {
        "" => command,
        examples => command.after_help(format!("Examples:\n{examples}\n{}", exit::HELP)),
    }
}
