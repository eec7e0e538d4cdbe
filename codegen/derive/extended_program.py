"""The platform with a list of effects: one more constant parameter for each of their parameters."""

from dataclasses import replace

import casadi as ca

from casadi_program import Element, ExportError, Function, Group, Output, Program, Table
from drift import drift_law
from effect import KINDS_WITH_WEIGHT, At, Effect, Enters, Parameter, by_axis, rust_name
from frames import platform_c_chart
from functions import AWAY_FROM_GIMBAL_LOCK, at_origin, with_jacobian
from kinematics import angle_rates_of
from layout import (
    AXES, REGRESSORS, conditions, drift, drift_noise, east_0, f_0, field_0, force, omega_0,
    platform_c_gyros, theta,
)
from specific_force import specific_force


def program(name: str, model: str, doc: str, effects: list[Effect],
            tables: list[Table] = (), strapdown: bool = False,
            with_weights: bool = False) -> Program:
    """The functions of the nominal model with `effects`, and with the inputs that they need.

    `with_weights` adds the function of the weights of terms that depend on time.

    With `strapdown` the platform is analytic: computed from the outputs of gyros fixed to a body.
    """
    effects = _output_first(effects)
    parameters = _parameters(effects)
    shapes = _shapes(effects)
    rates, reading = _expressions(effects, parameters, shapes, strapdown)
    candidates = [omega_0, f_0, east_0, field_0, platform_c_gyros, conditions,
                  *([shapes] if shapes else [])]

    def needed(expression: ca.SX) -> list[Group]:
        return [group for group in candidates if ca.depends_on(expression, group.sx)]

    value = Output("theta_dot", rates, "rad/s", "rates of the platform angles",
                   [f"theta_dot_{i}" for i in AXES])
    output = Output("reading", reading, "g", "outputs of the accelerometers, up positive",
                    [f"e_{i}" for i in AXES])
    of_output = [parameters] if ca.depends_on(reading, parameters.sx) else []
    own = [
        *with_jacobian(
            "dynamics", "Rates of the platform angles under Earth rate and gyro drift.",
            "equations (7) and (9), with the terms of the catalogue",
            [theta, parameters, *needed(rates)], value,
            [(theta, "1/s"), (parameters, "rad/s per unit of the parameter"),
             (drift_noise, "rad/s per deg/h")],
            AWAY_FROM_GIMBAL_LOCK, together=(parameters, drift_noise),
        ),
        *with_jacobian(
            "accelerometers", "Outputs of the accelerometers.",
            "equations (8) and (12), with the terms of the catalogue",
            [theta, *of_output, *needed(reading)], output,
            [(theta, "g/rad"), *((group, "g per unit of the parameter") for group in of_output)],
            "all finite inputs",
        ),
    ]
    by_name = {function.name: function for function in own}
    for function, of in (("dynamics", "Rates of the platform angles"),
                         ("accelerometers", "Outputs of the accelerometers")):
        own.append(at_origin(
            f"{function}_at_origin_jacobian", f"{of}, with exact Jacobians, at zero angles.",
            by_name[f"{function}_jacobian"],
        ))
    used = {group.name for function in own for group in function.inputs}
    return Program(
        name, doc, own + ([_weights(effects, shapes)] if with_weights else []),
        {
            "name": model,
            "doc": f"{doc} Three angles move, all else is constant.",
            "moving": theta.name,
            "flat": False,  # Anchored moves the chart of the angles
            "parameters": parameters.name,
            "noise": drift_noise.name,
            "inputs": [group.name for group in candidates if group.name in used],
            "rates": _forms("dynamics"),
            "output": _forms("accelerometers"),
        },
        list(tables),
    )


def added_parameters(effects: list[Effect]) -> list[Element]:
    """The parameters after the drift coefficients, in the order in which a model has them."""
    return _parameters(_output_first(effects)).elements[len(drift.elements):]


def shape_elements(effects: list[Effect]) -> list[Element]:
    """Onsets and time constants, in the order in which a model has them."""
    shapes = _shapes(_output_first(effects))
    return shapes.elements if shapes else []


def weighted(effects: list[Effect]) -> list[tuple[Effect, Parameter]]:
    """The parameters of terms that are functions of time, of a regressor or of a shape."""
    return [(effect, p) for effect in _output_first(effects)
            if effect.kind in KINDS_WITH_WEIGHT for p in effect.parameters]


def _weights(effects: list[Effect], shapes: Group | None) -> Function:
    """Function of the weights: what a unit of each parameter adds to its channel."""
    rows = []
    for effect, parameter in weighted(effects):
        own = {p.name: ca.SX.sym(p.name) for p in effect.parameters}
        given = {p.name: shapes[rust_name(effect.shape_id(p))] for p in effect.shapes}
        at = At(
            a=by_axis(force.sx), drift={}, field={}, time_s=conditions["time_s"],
            interval_s=conditions["interval_s"], **{name: conditions[name] for name in REGRESSORS},
            omega_0=omega_0.sx, f_0=f_0.sx, east_0=east_0.sx,
        )
        (expression,) = effect.term(own | given, at).values()
        rows.append(ca.jacobian(expression, own[parameter.name]))
    output = Output(
        "weights", ca.vertcat(*rows), "unit of the channel per unit of the parameter",
        "weights of the parameters",
        [rust_name(effect.state_id(p)) for effect, p in weighted(effects)],
    )
    return Function(
        "weights",
        "Addition to its channel of a unit of each parameter whose term is a function of time, of a "
        "regressor or of a shape.",
        "the terms of the catalogue", [force, conditions, *([shapes] if shapes else [])],
        [output], "time constants and the interval greater than zero, all other inputs finite",
    )


def _forms(function: str) -> dict[str, str]:
    return {
        "value": function,
        "jacobian": f"{function}_jacobian",
        "jacobian_at_origin": f"{function}_at_origin_jacobian",
    }


def _output_first(effects: list[Effect]) -> list[Effect]:
    """Effects that enter an output come first: filters take the leading parameters as those that an
    output depends on."""
    found = [effect for effect in effects if _enters_output(effect)]
    return found + [effect for effect in effects if effect not in found]


def _enters_output(effect: Effect) -> bool:
    parameters, shapes = _parameters([effect]), _shapes([effect])
    return ca.depends_on(_expressions([effect], parameters, shapes)[1], parameters.sx)


def _parameters(effects: list[Effect]) -> Group:
    """The nine drift coefficients, then the parameters of the effects."""
    return Group(
        "parameters",
        "Constant parameters: drift coefficients, then sizes of effects.",
        drift.elements + [
            Element(rust_name(effect.state_id(p)), p.unit, f"{effect.name}; {p.doc}",
                    effect.state_id(p))
            for effect in effects for p in effect.parameters
        ],
    )


def _shapes(effects: list[Effect]) -> Group | None:
    """The given parameters of the effects."""
    elements = [
        Element(rust_name(effect.shape_id(p)), p.unit, f"{effect.name}; {p.doc}",
                effect.shape_id(p))
        for effect in effects for p in effect.shapes
    ]
    return Group("shapes", "Onsets and time constants of effects.", elements) if elements else None


def _expressions(effects: list[Effect], parameters: Group, shapes: Group | None,
                 strapdown: bool = False):
    """Rates of the angles and outputs of the accelerometers.

    An analytic platform, held by the outputs of its gyros, rotates by minus their errors
    (docs/measured-data.md). Its accelerometers are fixed to the same body.
    """
    at = At(
        a={}, drift={}, field={},
        time_s=conditions["time_s"], interval_s=conditions["interval_s"],
        **{name: conditions[name] for name in REGRESSORS},
        omega_0=omega_0.sx, f_0=f_0.sx, east_0=east_0.sx,
    )

    def term(effect: Effect):
        own = {p.name: parameters[rust_name(effect.state_id(p))] for p in effect.parameters}
        own |= {p.name: shapes[rust_name(effect.shape_id(p))] for p in effect.shapes}
        return effect.term(own, at)

    for effect in _entering(Enters.INPUT, effects):
        at = replace(at, **term(effect))
    force = specific_force(theta.sx, at.f_0)
    field = platform_c_chart(theta.sx) @ field_0.sx
    reading = force
    if strapdown:
        # The group has the matrix by rows; CasADi reshapes by columns.
        rotation = ca.reshape(platform_c_gyros.sx, 3, 3).T
        force, field = rotation.T @ force, rotation.T @ field
    at = replace(at, a=by_axis(force), field=by_axis(field))
    nominal = parameters.sx[: len(drift.elements)]
    omega_d = drift_law(force, nominal, drift_noise.sx)
    # Terms that use drifts use the sum of all other terms.
    others = ca.SX.sym("omega_d", 3)
    at = replace(at, drift=by_axis(others))
    added = _sum(term(effect) for effect in _entering(Enters.RATE, effects))
    plain = ca.vertcat(*[omega_d[n] + sum(e for e in added[i] if not ca.depends_on(e, others))
                         for n, i in enumerate(AXES)])
    of_others = ca.vertcat(*[sum((e for e in added[i] if ca.depends_on(e, others)), ca.SX(0))
                             for i in AXES])
    omega_d = plain + ca.substitute(of_others, others, plain)
    if strapdown:
        omega_d = -rotation @ omega_d
    rates = angle_rates_of(theta.sx, omega_d, at.omega_0)
    for effect in _entering(Enters.TIME, effects):
        rates = term(effect) * rates
    read = _sum(term(effect) for effect in _entering(Enters.OUTPUT, effects))
    errors = ca.vertcat(*[sum(read[i], ca.SX(0)) for i in AXES])
    return rates, reading + (rotation @ errors if strapdown else errors)


def _entering(where: Enters, effects: list[Effect]) -> list[Effect]:
    return [effect for effect in effects if effect.has_term and effect.enters == where]


def _sum(terms) -> dict[str, list[ca.SX]]:
    """The expressions for each axis."""
    result = {i: [] for i in AXES}
    for term in terms:
        for axis, expression in term.items():
            if axis not in result:
                raise ExportError(f"a term is for the axis `{axis}`, expected one of {AXES}")
            result[axis].append(expression)
    return result
