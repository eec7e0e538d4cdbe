//! Writes or checks the committed files of a derivation: `gyrocal-codegen write|check`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::{Parser, Subcommand};
use gyrocal_codegen::build::{DECLARATION_FILE, Derivation, Error, Variant};
use gyrocal_codegen::{Program, explain};

/// Writes or checks the files that a derivation generates.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Directory that holds derivation.toml; a relative one is looked for here and in
    /// the directories above. May be given several times.
    #[arg(long, value_name = "DIRECTORY", default_value = ".")]
    derivation: Vec<PathBuf>,

    /// Not the derivation's own programs but the one that this file asks of it.
    #[arg(long, value_name = "FILE", requires = "committed")]
    file: Option<PathBuf>,

    /// Directory of the committed copy of the module of --file.
    #[arg(long, value_name = "DIRECTORY", requires = "file")]
    committed: Option<PathBuf>,

    /// Print how long each stage took.
    #[arg(long, global = true)]
    timings: bool,

    #[command(subcommand)]
    action: Action,
}

#[derive(Subcommand)]
enum Action {
    /// Derive everything and rewrite the committed files that differ.
    Write,
    /// Derive everything and compare with the committed files; exit code 1 if any differs.
    Check,
    /// Explain a function of a program file: operations before and after simplification, critical
    /// path, shared subexpressions, structure of the outputs.
    Explain {
        /// Name of the function.
        function: String,
        /// The program, as the exporter writes it.
        #[arg(long, value_name = "FILE")]
        program: PathBuf,
    },
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Error> {
    if let Action::Explain { function, program } = &arguments.action {
        print!("{}", explained(function, program)?);
        return Ok(());
    }
    // A variant is of one derivation, the first; its file asks for it.
    let count = if arguments.file.is_some() {
        1
    } else {
        arguments.derivation.len()
    };
    arguments.derivation[..count]
        .iter()
        .try_for_each(|directory| write_or_check(arguments, &find(directory)))
}

fn write_or_check(arguments: &Arguments, directory: &Path) -> Result<(), Error> {
    let variant = match (&arguments.file, &arguments.committed) {
        (Some(file), Some(committed)) => Some(Variant::open(directory, file)?.committed(committed)),
        _ => None,
    };
    let timings = match &arguments.action {
        Action::Explain { .. } => return Ok(()),
        Action::Write => {
            let written = match &variant {
                Some(variant) => variant.write()?,
                None => Derivation::open(directory)?.write()?,
            };
            let here = std::env::current_dir().unwrap_or_default();
            for path in &written.paths {
                println!(
                    "wrote {}",
                    path.strip_prefix(&here).unwrap_or(path).display()
                );
            }
            if written.paths.is_empty() {
                println!("nothing to write: every file is what the derivation gives");
            }
            written.timings
        }
        Action::Check => {
            let timings = match &variant {
                Some(variant) => variant.check()?,
                None => Derivation::open(directory)?.check()?,
            };
            println!("every file is what the derivation gives");
            timings
        }
    };
    if arguments.timings {
        let line =
            |stage: &str, time: Duration| println!("{stage:<12}{:8.3} s", time.as_secs_f64());
        let made = if timings.environment_created {
            "made env."
        } else {
            "found env."
        };
        line(made, timings.environment);
        line("derivation", timings.derivation);
        line("emission", timings.emission);
    }
    Ok(())
}

/// The account of a function of a program file.
fn explained(function: &str, program: &Path) -> Result<String, Error> {
    let text = std::fs::read_to_string(program).map_err(|source| Error::Io {
        action: "read",
        path: program.to_owned(),
        source,
    })?;
    let program = Program::from_json(&text, &program.display().to_string())?;
    Ok(explain(&program, function)?)
}

/// The directory as given, or below one of the directories above this one.
fn find(given: &Path) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    here.ancestors()
        .map(|above| above.join(given))
        .find(|directory| directory.join(DECLARATION_FILE).is_file())
        .unwrap_or_else(|| given.to_owned())
}
