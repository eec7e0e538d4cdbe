"""Every operation of SX and random expression graphs, with CasADi's own numbers.

Derives `operations.json`, `graphs.json` and, for each, a text file of values; run with the exporter:

    python -I -B codegen/emit/exporter/run.py codegen/emit/tests/data/operations OUTPUT_DIRECTORY

A line of the values is the name of a function, its inputs and its outputs, numbers in hexadecimal.
The environment variables GRAPHS and EDGES give other numbers of random graphs and of calls of
operations, whose further arguments are drawn near the edges.
"""

import os
import random
from pathlib import Path

import casadi as ca
from casadi_program import Element, ExternalFunction, Function, Group, Output, Program, rust_name

UNARY = {
    "neg": lambda x: -x, "sq": ca.sq if hasattr(ca, "sq") else lambda x: x * x,
    "inv": lambda x: 1 / x, "sqrt": ca.sqrt, "exp": ca.exp, "log": ca.log, "sin": ca.sin,
    "cos": ca.cos, "tan": ca.tan, "asin": ca.asin, "acos": ca.acos, "atan": ca.atan,
    "sinh": ca.sinh, "cosh": ca.cosh, "tanh": ca.tanh, "asinh": ca.asinh, "acosh": ca.acosh,
    "atanh": ca.atanh, "expm1": ca.expm1, "log1p": ca.log1p, "erf": ca.erf, "erfinv": ca.erfinv,
    "floor": ca.floor, "ceil": ca.ceil, "abs": ca.fabs, "sign": ca.sign, "not": ca.logic_not,
}
BINARY = {
    "add": lambda x, y: x + y, "sub": lambda x, y: x - y, "mul": lambda x, y: x * y,
    "div": lambda x, y: x / y, "pow": lambda x, y: x**y, "atan2": ca.atan2, "fmod": ca.fmod,
    "remainder": ca.remainder, "hypot": ca.hypot, "copysign": ca.copysign, "min": ca.fmin,
    "max": ca.fmax, "less": lambda x, y: x < y, "less_or_equal": lambda x, y: x <= y,
    "equal": lambda x, y: x == y, "not_equal": lambda x, y: x != y, "both": ca.logic_and,
    "either": ca.logic_or, "if_else": lambda x, y: ca.if_else(x > y, x * y, y - x),
    "if_zero": lambda x, y: ca.if_else(x, y, 0),
}
# ±0, subnormal, the ends of the range, branch points of the inverse functions, what is no number.
EDGES = [0.0, 5e-324, 1e-310, 1e-8, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 20.0, 1e5, 1e300,
         float("inf"), float("nan")]
EDGES = [sign * edge for edge in EDGES for sign in (1.0, -1.0)][:-1]
PAIRS = [0.0, -0.0, 1e-310, -0.5, 1.0, 2.5, -3.0, 1e300, float("inf"), -float("inf"), float("nan")]

SEED = 1
EDGE_CALLS = int(os.environ.get("EDGES", "0"))
GRAPHS = int(os.environ.get("GRAPHS", "120"))
POINTS = 4

x = Group("x", "Argument.", [Element("x", "1", "argument")])
xy = Group("xy", "Arguments.", [Element("x", "1", "first"), Element("y", "1", "second")])
z = Group("z", "Arguments.", [Element(f"z{i}", "1", "argument") for i in range(3)])


def functions_of(name: str, expression: ca.SX, group: Group) -> list[Function]:
    """A function of an operation and one of its derivatives."""
    slopes = ca.densify(ca.jacobian(expression, group.sx)).T
    return [
        Function(f"{name}_value", "Value.", "", [group], [Output("y", expression, "1", "value")]),
        Function(f"{name}_slope", "Slopes.", "", [group], [Output("y", slopes, "1", "slopes")]),
    ]


def graph(rng: random.Random) -> ca.SX:
    """Three results of some twenty random operations on three inputs and some constants."""
    nodes = [z.sx[i] for i in range(3)] + [ca.SX(rng.choice([0.25, 2.0, -1.5, 3.7])) for _ in "12"]
    # CasADi inverts the error function to 1e-8 only.
    unary = [operation for name, operation in UNARY.items() if name != "erfinv"]
    binary = list(BINARY.values())
    # Sums and products are most of any model.
    binary += [BINARY[name] for name in ("add", "sub", "mul") for _ in range(8)]
    for _ in range(20):
        # Later nodes more often, so that graphs are deep.
        pick = lambda: nodes[max(rng.randrange(len(nodes)), rng.randrange(len(nodes)))]
        if rng.random() < 0.4:
            nodes.append(rng.choice(unary)(pick()))
        else:
            nodes.append(rng.choice(binary)(pick(), pick()))
    return ca.vertcat(*nodes[-3:])


def near(rng: random.Random) -> float:
    """A number near an edge, some ulps or a few percent away."""
    edge = rng.choice(EDGES)
    return edge * (1 + rng.choice([0, 1e-16, 1e-15, 1e-8, 0.03]) * rng.gauss(0, 1))


def lines(function: Function, points: list[list[float]]) -> list[str]:
    compiled = function.casadi()
    result = []
    for point in points:
        values = [value for result in compiled.call([ca.DM(point)]) for value in result.nonzeros()]
        result.append(" ".join([rust_name(function.name), *(number.hex() for number in point), "->",
                                *(float(value).hex() for value in values)]))
    return result


def write(output: Path, program: Program, texts: list[str]) -> None:
    program.write(output / f"{program.name}.json")
    (output / f"{program.name}.txt").write_text("\n".join(texts) + "\n", encoding="utf-8",
                                                newline="\n")


def derive(output: Path) -> None:
    functions, texts = [], []
    rng = random.Random(SEED)
    each = EDGE_CALLS // (2 * len(UNARY) + 2 * len(BINARY))
    ones = [[edge] for edge in EDGES] + [[near(rng)] for _ in range(each)]
    pairs = [[a, b] for a in PAIRS for b in PAIRS] + [[near(rng), near(rng)] for _ in range(each)]
    for name, operation in UNARY.items():
        for function in functions_of(name, operation(x.sx), x):
            functions.append(function)
            texts += lines(function, ones)
    for name, operation in BINARY.items():
        for function in functions_of(name, operation(xy.sx[0], xy.sx[1]), xy):
            functions.append(function)
            texts += lines(function, pairs)
    write(output, Program("operations", "Every operation.", functions), texts)

    # `y` by hand, `x` by a function that itself is called by name.
    by_x = ExternalFunction("bump_by_x", "Slope of the bump.", ["x", "y"],
                            value=lambda x, y: (1 - x * y) * ca.exp(-x * y))
    bump = ExternalFunction("bump", "A bump.", ["x", "y"],
                            derivatives=[by_x, lambda x, y: -x * x * ca.exp(-x * y)],
                            value=lambda x, y: x * ca.exp(-x * y))
    wing = Group("Wing", "Names with capitals.", [Element("alphaDot", "1", "first"),
                                                  Element("V_x", "1", "second")])
    alpha, speed = wing["alphaDot"], wing["V_x"]
    curve = bump(ca.sin(alpha), speed) * alpha + bump(speed * speed, ca.SX(0.5))
    slopes = ca.densify(ca.jacobian(curve, wing.sx)).T
    functions = [
        Function("liftCurve", "Calls.", "", [wing], [Output("y", curve, "1", "value")]),
        Function("lift_curve_slope", "Slopes.", "", [wing],
                 [Output("y", slopes, "1", "slopes", ["alphaDot", "V_x"])]),
    ]
    points = [[0.3, 0.5], [-1.2, 2.0], [0.0, -0.7]]
    texts = [line for function in functions for line in lines(function, points)]
    write(output, Program("calls", "Calls.", functions), texts)

    rng = random.Random(SEED)
    functions, texts = [], []
    while len(functions) < GRAPHS:
        expression = graph(rng)
        # What the exporter refuses: constants that are not finite.
        if ca.symvar(expression):
            name = f"graph{len(functions)}"
            functions.append(Function(name, "A random graph.", "", [z],
                                      [Output("y", ca.densify(expression), "1", "values")]))
            points = [[float(round(rng.uniform(-2, 2) * 4096)) / 4096 for _ in range(3)]
                      for _ in range(POINTS)]
            try:
                Program("test", "", [functions[-1]]).to_json()
                texts += lines(functions[-1], points)
            except Exception:
                functions.pop()
    write(output, Program("graphs", "Random graphs.", functions), texts)
