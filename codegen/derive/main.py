"""Derives the programs of the platform. Run by the build, or by hand:

    python -I -B codegen/emit/exporter/run.py codegen/derive OUTPUT_DIRECTORY
"""

from pathlib import Path

import catalogue_program
import model_file
import oracle_program
import platform_program
import reference
import strapdown_catalogue_program
import strapdown_program
import surveyed_program


def derive(output: Path) -> None:
    """Writes one program file for each generated Rust module, and reference values of CasADi."""
    programs = [
        platform_program.program(),
        oracle_program.program(),
        surveyed_program.program(),
        strapdown_program.program(),
        catalogue_program.program(),
        strapdown_catalogue_program.program(),
    ]
    for program in programs:
        program.write(output / f"{program.name}.json")
    reference.write(programs, output / "reference.json")


def derive_from(file: Path, name: str, output: Path) -> None:
    """Writes the program `name` of a user's model file."""
    model_file.program(file, name).write(output / f"{name}.json")
