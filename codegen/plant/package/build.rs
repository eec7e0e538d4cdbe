//! Derives the plant from `plant.py`.

fn main() -> std::process::ExitCode {
    gyrocal_plant_codegen::build("plant.py")
}
