"""Runs the script of a plant and writes the program that it hands over."""

import runpy
import sys
import traceback
from pathlib import Path

from casadi_program import ExportError
from gyrocal_plant import PlantError, handed_over


def derive(output: Path) -> None:
    """Writes `plant.json`, and what its catalogue leaves out."""
    script = Path(Path(__file__).with_name("script.txt").read_text(encoding="utf-8"))
    sys.argv = [str(script)]
    sys.path.insert(0, str(script.parent))
    with handed_over() as handed:
        try:
            runpy.run_path(str(script), run_name="__main__")
        except ExportError:
            raise
        except Exception as error:
            raise ExportError(_in_words(script, error)) from error
    if len(handed) != 1:
        raise PlantError(f"{script.name} calls `write()` of a plant {len(handed)} times, expected once, "
                         "at its end")
    [(program, left_out)] = handed
    (output / "plant.json").write_text(program, encoding="utf-8", newline="\n")
    lines = [f"{ident}: {why}\n" for ident, why in left_out]
    (output / "left_out.txt").write_text("".join(lines), encoding="utf-8", newline="\n")


def _in_words(script: Path, error: Exception) -> str:
    """An error of the script with its line there."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(script)]
    place = f"{script.name}, line {frames[-1].lineno}" if frames else script.name
    if isinstance(error, SyntaxError):
        place = f"{script.name}, line {error.lineno}"
    return f"{place}: {type(error).__name__}: {error}"
