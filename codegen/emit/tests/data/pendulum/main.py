"""A small model with everything that the emitter treats in a way of its own.

Derives `pendulum.json` and CasADi's own numbers; run with the exporter:

    python -I -B codegen/emit/exporter/run.py codegen/emit/tests/data/pendulum OUTPUT_DIRECTORY
"""

import json
import random
from pathlib import Path

import casadi as ca
from casadi_program import Element, Function, Group, Output, Program, jacobian_output

swing = Group("swing", "State of the pendulum.", [
    Element("angle", "rad", "angle from the vertical"),
    Element("rate", "rad/s", "rate of the angle"),
])
rod = Group("rod", "Constants of the pendulum.", [
    Element("length", "m", "length of the rod", "rod.length"),
    Element("damping", "m^3/s", "damping at low rates"),
])
field = Group("field", "Field of gravity.", [
    Element("gravity", "m/s^2", "acceleration of free fall"),
])
push = Group("push", "Random push.", [Element("torque", "m^2/s^2", "torque over mass")])

POINTS = 20
SEED = 1


def derive(output: Path) -> None:
    angle, rate = swing["angle"], swing["rate"]
    length, damping = rod["length"], rod["damping"]
    drag = ca.if_else(ca.fabs(rate) > 1, ca.fabs(rate) ** 1.5, 1)
    rates = Output(
        "swing_dot",
        ca.vertcat(
            rate,
            -field["gravity"] / length * ca.sin(angle)
            - damping * rate * drag / length**3
            + push["torque"] / length**2,
        ),
        "rad/s, rad/s^2",
        "rates of the state",
        ["angle_dot", "rate_dot"],
    )
    bob = Output(
        "bob", ca.vertcat(length * ca.sin(angle), -length * ca.cos(angle)), "m",
        "place of the bob", ["across", "up"],
    )

    def still(value: Output) -> Output:
        """The output at zero torque."""
        expression = ca.substitute(value.expression, push.sx, ca.SX.zeros(1))
        return Output(value.name, expression, value.unit, value.doc,
                      value.row_names, value.column_names)

    def jacobian(value: Output, group: Group) -> Output:
        return still(jacobian_output(value, group, f"{value.name}_d_{group.name}",
                                     f"`{value.name}` by `{group.name}`", "mixed"))

    def at_origin(name: str, doc: str, function: Function) -> Function:
        """The function with the pendulum at rest; values with structural zeros too."""
        outputs = [
            Output(o.name, ca.sparsify(ca.substitute(o.expression, swing.sx, ca.SX.zeros(2))),
                   o.unit, o.doc, o.row_names, o.column_names)
            for o in function.outputs
        ]
        groups = [group for group in function.inputs if group is not swing]
        return Function(name, doc, function.source, groups, outputs, function.domain)

    inputs, source, domain = [swing, rod, field], "Newton <1687> [law 2]", "length above 0"
    functions = [
        Function("swing_rates", "Rates of a damped pendulum.", source, inputs, [still(rates)],
                 domain),
        Function("swing_rates_jacobian", "Rates of a damped pendulum, with Jacobians.", source,
                 inputs, [still(rates), *[jacobian(rates, g) for g in (swing, rod, push)]], domain),
        Function("bob_place", "Position of the bob.", source, [swing, rod], [bob]),
        Function("bob_place_jacobian", "Position of the bob, with Jacobians.", source, [swing, rod],
                 [bob, *[jacobian(bob, g) for g in (swing, rod)]]),
        Function("reach", "A bound on the height that the bob can reach.", "", [swing, rod, field],
                 [Output("reach", ca.fmin(2 * length, rate**2 * length**2 / (2 * field["gravity"])
                                          + length * (1 - ca.cos(angle))), "m", "height")]),
        Function("heading", "Direction of the bob.", "", [swing, rod],
                 [Output("heading", ca.atan2(length * ca.sin(angle), length * ca.cos(angle)),
                         "rad", "angle"),
                  Output("turned", ca.logic_and(rate > 0, ca.logic_not(angle < 0)), "1",
                         "1 while it swings out to the right")]),
    ]
    by_name = {function.name: function for function in functions}
    functions += [
        at_origin("swing_rates_at_origin", "Rates and Jacobians at rest.",
                  by_name["swing_rates_jacobian"]),
        at_origin("bob_place_at_origin", "Position of the bob at rest, with Jacobians.",
                  by_name["bob_place_jacobian"]),
    ]
    program = Program(
        "pendulum", "A damped pendulum.", functions,
        {
            "name": "Pendulum",
            "doc": "A damped pendulum whose rod is to be calibrated.",
            "moving": swing, "parameters": rod, "noise": push, "inputs": [field],
            "rates": {"value": "swing_rates", "jacobian": "swing_rates_jacobian",
                      "jacobian_at_origin": "swing_rates_at_origin"},
            "output": {"value": "bob_place", "jacobian": "bob_place_jacobian",
                       "jacobian_at_origin": "bob_place_at_origin"},
        },
    )
    program.write(output / "pendulum.json")
    rng = random.Random(SEED)
    points = [
        {
            "swing": [rng.uniform(-3, 3), rng.uniform(-3, 3)],
            "rod": [rng.uniform(0.5, 2), rng.uniform(0, 1)],
            "field": [rng.uniform(9, 10)],
        }
        for _ in range(POINTS)
    ]
    values = {
        function.name: [
            [value
             for result in function.casadi().call([ca.DM(point[g.name]) for g in function.inputs])
             for value in result.nonzeros()]
            for point in points
        ]
        for function in functions
    }
    text = json.dumps({"inputs": points, "functions": values}, indent=1)
    (output / "reference.json").write_text(text + "\n", encoding="utf-8", newline="\n")
