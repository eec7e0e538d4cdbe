//! The private environment: made once, whole, and from nothing but the lock file.

use std::fs;
use std::path::Path;

use gyrocal_testkit::{codegen, fresh_directory, real_environments, run, snapshot, system_python};

use crate::SCRATCH;
use crate::tiny::TinyDerivation;

fn entries(directory: &Path) -> Vec<String> {
    let names = fs::read_dir(directory).unwrap();
    names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

/// Two processes at once, and a half-made environment left by a third that was killed.
#[test]
fn two_processes_make_one_environment() {
    let tinies = ["race-a", "race-b"].map(|name| TinyDerivation::make(SCRATCH, name));
    run(&mut codegen(&tinies[0].directory(), &["write"])).succeeded();
    let environments = fresh_directory(Path::new(SCRATCH).join("race-environments"));
    for name in entries(&real_environments()) {
        if name.starts_with("python-") && !name.contains(".lock") {
            fs::create_dir_all(environments.join(&name).join("bin")).unwrap();
            fs::write(environments.join(&name).join("bin/python"), "half-made").unwrap();
        }
    }
    std::thread::scope(|scope| {
        for tiny in &tinies {
            let environments = &environments;
            scope.spawn(move || {
                let mut command = codegen(&tiny.directory(), &["write"]);
                run(command.env("GYROCAL_CODEGEN_ENV_DIR", environments)).succeeded();
            });
        }
    });
    assert_eq!(
        fs::read(tinies[0].rust()).unwrap(),
        fs::read(tinies[1].rust()).unwrap()
    );
    let complete = |name: &&String| environments.join(name).join("complete").is_file();
    let names = entries(&environments);
    assert_eq!(names.iter().filter(complete).count(), 1, "{names:?}");
    assert!(!names.iter().any(|name| name.contains(".tmp")), "{names:?}");
    fs::remove_dir_all(environments).unwrap(); // 375 MB
}

/// Variables that would send Python or pip elsewhere, while an environment is made and used.
#[test]
fn the_callers_python_does_not_leak_in() {
    let tiny = TinyDerivation::make(SCRATCH, "poison");
    let poison = fresh_directory(Path::new(SCRATCH).join("poison-path"));
    let stolen = poison.join("stolen");
    for module in ["casadi", "sitecustomize", "usercustomize", "main"] {
        fs::write(
            poison.join(format!("{module}.py")),
            "raise SystemExit('poisoned')\n",
        )
        .unwrap();
    }
    let environments = fresh_directory(Path::new(SCRATCH).join("poison-environments"));
    let mut command = codegen(&tiny.directory(), &["write"]);
    command
        .env("GYROCAL_CODEGEN_ENV_DIR", &environments)
        .env("GYROCAL_PYTHON", system_python())
        .env("PYTHONPATH", &poison)
        .env("PYTHONHOME", poison.join("nowhere"))
        .env("PYTHONPLATLIBDIR", "nowhere")
        .env("PYTHONWARNINGS", "error")
        .env("PIP_TARGET", &stolen)
        .env("PIP_PREFIX", &stolen)
        .env("PIP_USER", "1")
        .env("PIP_NO_BINARY", ":all:")
        .env("PIP_CONSTRAINT", poison.join("nowhere.txt"))
        .env_remove("PYTHONDONTWRITEBYTECODE");
    let before = snapshot(&tiny.directory());
    run(&mut command).succeeded();
    assert!(!stolen.exists(), "pip installed into {}", stolen.display());
    assert_eq!(
        snapshot(&tiny.directory()),
        before,
        "byte code in the sources"
    );
    fs::remove_dir_all(environments).unwrap(); // 375 MB
}

/// An interpreter with the pinned CasADi needs no environment, so no network either.
#[test]
fn an_interpreter_with_casadi_is_used_as_it_is() {
    let tiny = TinyDerivation::make(SCRATCH, "as-it-is");
    run(&mut codegen(&tiny.directory(), &["write"])).succeeded();
    let name = entries(&real_environments())
        .into_iter()
        .find(|name| real_environments().join(name).join("complete").is_file());
    let interpreter = real_environments().join(name.unwrap()).join("bin/python");
    let environments = fresh_directory(Path::new(SCRATCH).join("as-it-is-environments"));
    let mut command = codegen(&tiny.directory(), &["check"]);
    command
        .env("GYROCAL_CODEGEN_ENV_DIR", &environments)
        .env("GYROCAL_PYTHON", interpreter)
        .env("GYROCAL_OFFLINE", "1");
    run(&mut command).succeeded();
    assert!(entries(&environments).is_empty());
}
