"""Functions of a model in the forms that a filter needs: a value, the same with its Jacobians,
and both at zero angles."""

import random
from dataclasses import replace

import casadi as ca

from casadi_program import ExportError, Function, Output, jacobian_output
from layout import drift_noise, theta

NO_NOISE = ca.SX.zeros(3)
AWAY_FROM_GIMBAL_LOCK = (
    "Angles with theta_y away from +-90 deg, where the chart is singular and values grow like "
    "1/cos(theta_y); all other inputs finite"
)


def without_noise(output: Output) -> Output:
    """The same output at zero drift noise (the mean of the noise)."""
    return Output(
        output.name,
        ca.substitute(output.expression, drift_noise.sx, NO_NOISE),
        output.unit,
        output.doc,
        output.row_names,
        output.column_names,
    )


def at_origin(name: str, doc: str, function: Function) -> Function:
    """The same outputs at zero platform angles, where each step of a filter with a moving chart
    starts."""

    def at_zero(output: Output) -> Output:
        expression = ca.substitute(output.expression, theta.sx, ca.SX.zeros(3))
        if output.column_names:
            expression = ca.sparsify(expression)
        return Output(output.name, expression, output.unit, output.doc,
                      output.row_names, output.column_names)

    return Function(
        name, doc, function.source, [group for group in function.inputs if group is not theta],
        [at_zero(output) for output in function.outputs],
    )


def with_jacobian(name: str, doc: str, source: str, inputs, value: Output, by,
                  domain: str, together: tuple = (), shorter: tuple = ()) -> list[Function]:
    """Two functions: the value alone, and the value with its Jacobians (shared terms once).

    `by` lists (group, unit of the Jacobian). By the groups in `together` the value is
    differentiated in one pass, so that equal columns, such as those of biases and noise, are the
    same expressions; they are in the order of `by`. `shorter` is another form of the value and its
    Jacobians, in the order of `by`, with fewer operations than `value` and its derivatives.
    """
    jacobians = [
        jacobian_output(
            value, group, f"{value.name}_d_{group.name}",
            f"exact Jacobian of `{value.name}` with respect to `{group.name}`", unit,
        )
        for group, unit in by
    ]
    whole = ca.jacobian(value.expression, ca.vertcat(*[group.sx for group in together]))
    end = 0
    for place, (group, _) in enumerate(by):
        if group in together:
            start, end = end, end + len(group.elements)
            columns = ca.sparsify(whole[:, start:end])
            jacobians[place] = replace(jacobians[place], expression=columns)
    if shorter:
        value, *jacobians = [
            replace(output, expression=_checked(output, expression))
            for output, expression in zip((value, *jacobians), shorter, strict=True)
        ]
    return [
        Function(name, doc, source, inputs, [without_noise(value)], domain),
        Function(
            f"{name}_jacobian", f"{doc} With its exact Jacobians.", source, inputs,
            [without_noise(o) for o in (value, *jacobians)], domain,
        ),
    ]


def _checked(output: Output, shorter: ca.SX) -> ca.SX:
    """`shorter`, after a comparison with the output at random points."""
    symbols = ca.symvar(ca.vertcat(ca.vec(output.expression), ca.vec(shorter)))
    both = ca.Function("both", symbols, [ca.densify(output.expression), ca.densify(shorter)])
    rng = random.Random(0)
    for _ in range(8):
        expected, found = both(*[rng.uniform(-1, 1) for _ in symbols])
        # Far above rounding and far below any term of a model.
        if not ca.norm_inf(ca.vec(found - expected)) <= 1e-12 * ca.norm_inf(ca.vec(expected)):
            raise ExportError(
                f"the shorter form of `{output.name}` gives {found}, its expression {expected}: "
                "change both or leave the shorter form out"
            )
    return shorter
