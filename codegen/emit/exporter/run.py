"""Runs a derivation script: `run.py DERIVATION_DIRECTORY OUTPUT_DIRECTORY [FILE NAME]`.

The script is `main.py` in the derivation directory; its function `derive(output)`
writes programs into the directory `output`. With FILE and NAME its function
`derive_from(file, name, output)` writes the program `NAME.json` that FILE asks for.
Run with `python -I -B`, so that nothing of the caller's environment takes part and
nothing is written into the sources.
"""

import sys
from pathlib import Path


def main(arguments: list[str]) -> int:
    if len(arguments) not in (2, 4):
        print("usage: run.py DERIVATION_DIRECTORY OUTPUT_DIRECTORY [FILE NAME]", file=sys.stderr)
        return 2
    derivation, output = Path(arguments[0]).resolve(), Path(arguments[1]).resolve()
    sys.path[:0] = [str(Path(__file__).resolve().parent), str(derivation)]
    from casadi_program import ExportError

    output.mkdir(parents=True, exist_ok=True)
    try:
        import main as derivation_script

        if len(arguments) == 2:
            derivation_script.derive(output)
        elif hasattr(derivation_script, "derive_from"):
            derivation_script.derive_from(Path(arguments[2]).resolve(), arguments[3], output)
        else:
            raise ExportError("its main.py has no function `derive_from(file, name, output)`, so "
                              "it derives nothing from files of others")
    except ExportError as error:
        print(f"derivation refused: {error}", file=sys.stderr)
        return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
