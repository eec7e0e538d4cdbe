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

/// Commands with their examples, each a command line with its meaning.
const EXAMPLES: [(&str, &[[&str; 2]]); 19] = [
    (
        "allan",
        &[
            [
                "gyrocal allan log.csv --columns gyro_x,gyro_y --rate-hz 100 --unit deg/h",
                "two columns of a log, 100 samples a second",
            ],
            [
                "gyrocal allan log.bin --log-description log.toml",
                "the three gyros of any log, by its description",
            ],
        ],
    ),
    (
        "calibrate",
        &[
            [
                "gyrocal calibrate record.csv --bench bench.toml",
                "the nine coefficients of a record",
            ],
            [
                "gyrocal calibrate a.csv b.csv --bench a.toml --bench b.toml --json out.json",
                "two turn-ons of one platform, with the result for programs",
            ],
            [
                "gyrocal calibrate record.csv --bench bench.toml --with gyro_y.g_z",
                "the same with a missing term in the model",
            ],
        ],
    ),
    (
        "characterise",
        &[[
            "gyrocal characterise --cell d8 --runs 20",
            "twenty records with one hidden effect of 8 sigmas each",
        ]],
    ),
    (
        "completions",
        &[[
            "gyrocal completions bash > ~/.local/share/bash-completion/completions/gyrocal",
            "completions for bash",
        ]],
    ),
    (
        "diagnose",
        &[
            [
                "gyrocal diagnose record.csv --bench bench.toml",
                "what the model gets wrong, and why",
            ],
            [
                "gyrocal diagnose record.csv --bench bench.toml --json d.json --figures figures",
                "the same for programs, and as pictures",
            ],
            [
                "gyrocal diagnose record.csv --bench bench.toml --quiet --exit-code",
                "in a script: 3 if effects were found",
            ],
        ],
    ),
    (
        "effects",
        &[
            ["gyrocal effects", "all effects by the part that they enter"],
            ["gyrocal effects gyro_y.g_z", "one effect"],
            ["gyrocal effects gyro_i.warmup", "the effects of a family"],
        ],
    ),
    (
        "emit",
        &[
            [
                "gyrocal emit --out filter.rs",
                "the nominal filter in single precision, for a controller",
            ],
            [
                "gyrocal emit extended.model.toml --module src/generated/extended.rs --number f64 \
                 --out filter.rs",
                "an extended filter in double precision",
            ],
        ],
    ),
    (
        "extend",
        &[
            [
                "gyrocal extend diagnosis.json --out extended.model.toml",
                "a filter with what a diagnosis found",
            ],
            [
                "gyrocal extend --effects gyro_y.g_z --out extended.model.toml",
                "a filter with an effect of the catalogue",
            ],
        ],
    ),
    (
        "import",
        &[
            [
                "gyrocal import csv log.csv.gz --columns map.toml --out record.csv",
                "a record from a table of another program",
            ],
            [
                "gyrocal import strapdown log.csv --log-description log.toml --out r.csv \
             --bench-out b.toml",
                "a record for `calibrate` from a strapdown log at rest",
            ],
        ],
    ),
    (
        "man",
        &[[
            "gyrocal man ~/.local/share/man/man1",
            "pages for `man gyrocal`",
        ]],
    ),
    (
        "monte-carlo",
        &[[
            "gyrocal monte-carlo scenario.toml --seeds 0..200",
            "two hundred records of a scenario, simulated and calibrated",
        ]],
    ),
    (
        "new-plant",
        &[[
            "gyrocal new-plant oscillator --gyrocal ../gyrocal",
            "a package for a plant of your own",
        ]],
    ),
    (
        "plan",
        &[
            [
                "gyrocal plan record.csv --bench bench.toml --hours 6,24",
                "the best runs of six hours and of a day",
            ],
            [
                "gyrocal plan record.csv --bench bench.toml --limits x=-30..30,y=-60..60",
                "within the limits of the gimbals",
            ],
            [
                "gyrocal plan a.csv b.csv --bench a.toml --bench b.toml --diagnosis both.json",
                "from several records and their joint diagnosis",
            ],
        ],
    ),
    (
        "plant",
        &[
            [
                "gyrocal plant derive plant.py",
                "the program of a plant from its Python script",
            ],
            [
                "gyrocal plant diagnose plant.json record.csv --columns columns.toml --validate later.csv",
                "what its model lacks, and the gain on a later record",
            ],
            [
                "gyrocal plant diagnose plant.json a.csv b.csv --columns columns.toml --report report.html",
                "two records together and alone, as a page to look at",
            ],
            [
                "gyrocal plant extend diagnosis.json --script plant.py",
                "what was found, in the equations of the script",
            ],
        ],
    ),
    (
        "rates",
        &[
            [
                "gyrocal rates log.csv --log-description log.toml",
                "one log at rest: biases of any size, noise, effects of temperature and time",
            ],
            [
                "gyrocal rates x_up.csv x_down.csv y_up.csv --log-description table.toml",
                "a turntable, a log for each attitude: scale, misalignment, g sensitivity",
            ],
        ],
    ),
    (
        "report",
        &[
            [
                "gyrocal report record.csv --bench bench.toml --out report.html",
                "a record, diagnosed, with all charts",
            ],
            [
                "gyrocal report monday.json tuesday.json --out week.html",
                "written results, with an overview",
            ],
            [
                "gyrocal report monday.csv tuesday.csv --bench bench.toml --uncertainty --json budget.json",
                "two runs of one platform: uncertainty budgets, and the scatter over runs",
            ],
        ],
    ),
    (
        "simulate",
        &[[
            "gyrocal simulate scenario.toml --out record.csv --bench-out bench.toml",
            "a record and its bench description",
        ]],
    ),
    (
        "tumble",
        &[
            [
                "gyrocal tumble log.csv --log-description log.toml",
                "one log with stops in many attitudes",
            ],
            [
                "gyrocal tumble up.csv down.csv --log-description log.toml",
                "two positions, a log each",
            ],
        ],
    ),
    (
        "watch",
        &[[
            "gyrocal watch record.csv --bench bench.toml",
            "when the watch of a controller would have raised an alarm, and its name",
        ]],
    ),
];

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
    let names: Vec<String> = command
        .get_subcommands()
        .map(|subcommand| subcommand.get_name().to_owned())
        .collect();
    let command = command.after_help(exit::HELP);
    names.into_iter().fold(command, |command, name| {
        command.mut_subcommand(&name, |subcommand| {
            with_examples(grouped(subcommand), &name)
        })
    })
}

/// Options that name files, under headings of their own.
fn grouped(command: Command) -> Command {
    let nested: Vec<String> = command
        .get_subcommands()
        .map(|subcommand| subcommand.get_name().to_owned())
        .collect();
    let command = nested.into_iter().fold(command, |command, name| {
        command.mut_subcommand(&name, grouped)
    });
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

fn with_examples(command: Command, name: &str) -> Command {
    let examples = EXAMPLES.iter().find(|(command, _)| *command == name);
    let Some((_, examples)) = examples else {
        return command;
    };
    let lines = examples
        .iter()
        .map(|[line, meaning]| format!("  # {meaning}\n  {line}\n"));
    let lines: String = lines.collect();
    command.after_help(format!("Examples:\n{lines}\n{}", exit::HELP))
}
