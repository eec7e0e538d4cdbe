"""Operations of SX that the exporter takes, and the time that it takes for a large program.

    python operations.py EXPORTER_DIRECTORY OUTPUT_FILE INSTRUCTIONS

prints `supported NAME` or `refused NAME` for each, and `export SECONDS INSTRUCTIONS`; the program is written to
the file.
"""

import json
import random
import sys
import time
from pathlib import Path

sys.path.insert(0, sys.argv[1])

import casadi as ca  # noqa: E402
from casadi_program import Element, ExportError, Function, Group, Output, Program  # noqa: E402

# Of functions, not of expressions.
NO_OPERATIONS = {"OP_INPUT", "OP_OUTPUT", "OP_CONST", "OP_PARAMETER", "OP_CALL"}

x = Group("x", "Arguments.", [Element(f"x{i}", "1", "argument") for i in range(20)])


def program(expression):
    return Program("large", "Made for a measurement.", [
        Function("f", "Made.", "", [x], [Output("y", expression, "1", "value")])]).to_json()


def expressions():
    """Every operation that SX can be built of, by its name: those that stand in the function."""
    names = {getattr(ca, name): name for name in dir(ca)
             if name.startswith("OP_") and isinstance(getattr(ca, name), int)}
    for op, name in sorted(names.items()):
        if name in NO_OPERATIONS:
            continue
        for build in (lambda: ca.SX.unary(op, x.sx[0]), lambda: ca.SX.binary(op, x.sx[0], x.sx[1])):
            try:
                expression = build()
                function = ca.Function("f", [x.sx], [expression])
            except (RuntimeError, NotImplementedError):
                continue
            if op in map(function.instruction_id, range(function.n_instructions())):
                yield name, expression
                break


def large(count):
    rng = random.Random(1)
    nodes = [x.sx[i] for i in range(20)]
    while len(nodes) < count:
        a, b = (nodes[-1 - rng.randrange(min(len(nodes), 100))] for _ in range(2))
        nodes.append(rng.choice([a + b, a - 0.37 * b, a * b, ca.sin(a) * b]))
    return ca.vertcat(*nodes[-200:])


for name, expression in expressions():
    try:
        program(expression)
        print("supported", name)
    except ExportError:
        print("refused", name)
expression = large(int(sys.argv[3]))
begin = time.perf_counter()
text = program(expression)
print("export", time.perf_counter() - begin, len(json.loads(text)["functions"][0]["instructions"]))
Path(sys.argv[2]).write_text(text)
