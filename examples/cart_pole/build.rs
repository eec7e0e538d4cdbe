//! Compiles the committed Rust of the model, or derives it again if `derive` was edited.

fn main() -> std::process::ExitCode {
    gyrocal_codegen::build::main("derive")
}
