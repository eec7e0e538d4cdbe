//! Writing and checking the committed files.

use std::fs;
use std::path::{Path, PathBuf};

use gyrocal_codegen::build::Derivation;
use gyrocal_testkit::{codegen, edit, fresh_directory, run, snapshot, workspace};

use crate::SCRATCH;
use crate::tiny::TinyDerivation;

#[test]
fn a_damaged_or_missing_file_is_named_with_the_command() {
    let tiny = TinyDerivation::make(SCRATCH, "damaged");
    let check = || run(&mut codegen(&tiny.directory(), &["check"]));
    let write = || run(&mut codegen(&tiny.directory(), &["write"])).succeeded();
    let missing = check().failed_with(&["generated/tiny.rs` is missing", "the write command"]);
    assert_eq!(missing.code, Some(1));
    let written = write().stdout;
    assert!(written.contains("wrote generated/tiny.rs"), "{written}");
    check().succeeded();

    // The fingerprint still fits: only the text tells.
    edit(tiny.rust(), "do not edit", "do edit");
    let wrong = check().failed_with(&[
        "generated/tiny.rs` differs",
        "in line 1",
        "the write command",
    ]);
    assert!(!wrong.stderr.contains("tiny.json"), "{}", wrong.stderr);
    assert!(
        !Derivation::open(tiny.directory())
            .unwrap()
            .stale()
            .unwrap()
            .is_empty()
    );
    write();
    check().succeeded();

    edit(tiny.program(), "\"A tiny program.\"", "\"\"");
    check().failed_with(&["generated/tiny.json` differs"]);
    write();
    fs::write(tiny.rust(), [0xff, 0xfe]).unwrap();
    check().failed_with(&["generated/tiny.rs` differs"]);
    let repaired = write().stdout;
    assert!(
        repaired.contains("tiny.rs") && !repaired.contains("tiny.json"),
        "{repaired}"
    );
    check().succeeded();
}

#[test]
fn writing_again_touches_nothing() {
    let tiny = TinyDerivation::make(SCRATCH, "again");
    let write = || {
        run(&mut codegen(&tiny.directory(), &["write"]))
            .succeeded()
            .stdout
    };
    write();
    let time = || fs::metadata(tiny.rust()).unwrap().modified().unwrap();
    let (first, contents) = (time(), snapshot(&tiny.root));
    assert!(write().contains("nothing to write"));
    assert_eq!(time(), first);
    assert_eq!(snapshot(&tiny.root), contents);
}

#[test]
fn evaluated_numbers_are_written_with_a_changed_model_and_never_compared() {
    let tiny = TinyDerivation::make(SCRATCH, "numbers");
    let declaration = tiny.directory().join("derivation.toml");
    let numbers = "\n[[numbers]]\nfile = \"n.txt\"\ncommitted = \"../generated/n.txt\"\n";
    fs::write(
        &declaration,
        fs::read_to_string(&declaration).unwrap() + numbers,
    )
    .unwrap();
    let text = fs::read_to_string(tiny.script()).unwrap();
    fs::write(
        tiny.script(),
        text + "    (output / 'n.txt').write_text('1.0')\n",
    )
    .unwrap();
    let committed = tiny.root.join("generated/n.txt");
    let codegen = |action| run(&mut codegen(&tiny.directory(), &[action]));

    codegen("write").succeeded();
    assert_eq!(fs::read_to_string(&committed).unwrap(), "1.0");
    fs::write(&committed, "1.0000000000000002").unwrap(); // another processor's last bit
    codegen("check").succeeded();
    codegen("write").succeeded();
    assert_eq!(
        fs::read_to_string(&committed).unwrap(),
        "1.0000000000000002"
    );
    edit(tiny.script(), "x * y + 2", "x * y + 3");
    codegen("write").succeeded();
    assert_eq!(fs::read_to_string(&committed).unwrap(), "1.0");
    fs::remove_file(&committed).unwrap();
    codegen("check").failed_with(&["generated/n.txt` is missing"]);
}

/// The derivation of the workspace, in two folders and twice in one of them.
#[test]
fn the_same_inputs_give_the_same_bytes() {
    let generated = |folder: &Path| snapshot(&folder.join("src/generated"));
    let folders = ["one", "another/and deeper"].map(|name| {
        let root = fresh_directory(Path::new(SCRATCH).join("same-bytes").join(name));
        copy_directory(
            &workspace().join("codegen/derive"),
            &root.join("codegen/derive"),
        );
        run(&mut codegen(&root.join("codegen/derive"), &["write"])).succeeded();
        root
    });
    let [one, another]: [PathBuf; 2] = folders;
    assert!(!generated(&one).is_empty());
    assert_eq!(generated(&one), generated(&another));
    fs::remove_dir_all(one.join("src")).unwrap();
    run(&mut codegen(&one.join("codegen/derive"), &["write"])).succeeded();
    assert_eq!(generated(&one), generated(&another));
    let numbers = |folder: &Path| fs::read(folder.join("crates/oracle/reference/platform.json"));
    assert_eq!(numbers(&one).unwrap(), numbers(&another).unwrap());
}

fn copy_directory(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for (name, contents) in snapshot(from) {
        fs::write(to.join(name), contents).unwrap();
    }
}
