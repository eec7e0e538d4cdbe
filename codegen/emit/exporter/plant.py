"""A plant for a filter, from its equations: the program with everything that the traits need.

    Plant("CartPole", "A cart with a pole.", states, rates, output,
          parameters=constants, inputs=[drive], noise=gusts).program()
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import casadi as ca

from casadi_program import Function, Group, Output, Program, jacobian_output, rust_name


@dataclass(frozen=True)
class Plant:
    """Continuous equations of states and constant parameters, and what the sensors read.

    `rates` are the derivatives of `states` by time, one for each, `output` the readings, both
    expressions of the symbols of the groups. `noise` enters `rates` and is zero on average: filters
    take its densities. `rate_names` are `NAME_dot` by default. `name` is that of the Rust type.
    """

    name: str
    doc: str
    states: Group
    rates: ca.SX
    output: ca.SX
    output_names: Sequence[str]
    output_unit: str = "mixed"
    parameters: Group | None = None
    inputs: Sequence[Group] = ()
    noise: Group | None = None
    source: str = ""
    domain: str = "all finite inputs"
    more: Sequence[Function] = field(default=())

    def program(self) -> Program:
        """The program: rates and output, each alone and with its Jacobians, and the model."""
        rates = Output("rates", self.rates, "units of the states per s", "rates of the states",
                       [f"{name}_dot" for name in self.states.names])
        output = Output("output", self.output, self.output_unit, "readings of the sensors",
                        list(self.output_names))
        return Program(rust_name(self.name), self.doc, [
            *self._pair("dynamics", "Rates of the states.", rates, self.noise),
            *self._pair("readings", "Readings of the sensors.", output, None),
            *self.more,
        ], {
            "name": self.name, "doc": self.doc, "moving": self.states,
            "parameters": self.parameters, "noise": self.noise, "inputs": list(self.inputs),
            "rates": {"value": "dynamics", "jacobian": "dynamics_jacobian"},
            "output": {"value": "readings", "jacobian": "readings_jacobian"},
        })

    def _pair(self, name: str, doc: str, value: Output, noise: Group | None) -> list[Function]:
        groups = [self.states, *([self.parameters] if self.parameters else []), *self.inputs]
        by = [group for group in (self.states, self.parameters, noise) if group]
        outputs = [value] + [
            jacobian_output(value, group, f"{value.name}_d_{group.name}",
                            f"exact Jacobian of `{value.name}` by `{rust_name(group.name)}`",
                            "mixed")
            for group in by
        ]
        if self.noise is not None:
            zeros = ca.SX.zeros(len(self.noise.elements))
            outputs = [
                Output(o.name, ca.substitute(o.expression, self.noise.sx, zeros), o.unit, o.doc,
                       o.row_names, o.column_names)
                for o in outputs
            ]
        inputs = [group for group in groups
                  if any(ca.depends_on(o.expression, group.sx) for o in outputs)]
        return [
            Function(name, doc, self.source, inputs, [outputs[0]], self.domain),
            Function(f"{name}_jacobian", f"{doc[:-1]}, with their exact Jacobians.", self.source,
                     inputs, outputs, self.domain),
        ]
