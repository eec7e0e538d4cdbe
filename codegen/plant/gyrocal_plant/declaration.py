"""A plant as its user writes it down, and the program file that is made of it."""

from __future__ import annotations

import difflib
import importlib.util
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import casadi as ca
import casadi_program
from casadi_program import Element, ExportError, Group, Table

from . import dependence, grammar, units


def _equations():
    """Class `Plant` of the exporter, by the place of its file: a user's script may be `plant.py` too."""
    path = Path(casadi_program.__file__).with_name("plant.py")
    spec = importlib.util.spec_from_file_location("gyrocal_exporter_plant", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module.Plant


Equations = _equations()


class PlantError(ExportError):
    """A plant that cannot be diagnosed as it is written; the message says what to change."""


_handed: list[tuple[str, list[tuple[str, str]]]] | None = None


@contextmanager
def handed_over() -> Iterator[list[tuple[str, list[tuple[str, str]]]]]:
    """Programs that `Plant.write` hands over instead of writing them, each with the terms that its
    catalogue leaves out and why: what a build takes from a script."""
    global _handed
    _handed = []
    try:
        yield _handed
    finally:
        _handed = None


@dataclass
class _Symbol:
    name: str
    unit: str
    doc: str
    sx: ca.SX
    facts: dict = field(default_factory=dict)


@dataclass
class _Effect:
    id: str
    name: str
    formula: str
    unit: str
    # term, ramp, step, regressor, delay or play.
    kind: str
    # rate, output, parameter or input.
    place: str
    index: int
    # Size of a term; what it multiplies.
    term: ca.SX | None = None
    knee: grammar.Knee | None = None
    regressor: int = 0
    own: bool = False
    equivalents: list[str] = field(default_factory=list)


@dataclass
class _Late:
    """An input as it acts, a dead time after it is logged."""

    sx: ca.SX
    # The input, and the parameter that is its dead time.
    index: int
    parameter: int


class Plant:
    """States, parameters, inputs, outputs and noise of a plant, with its equations.

        plant = Plant("Duffing", "A driven oscillator.")
        x, v = plant.state("x", "m"), plant.state("v", "m/s")
        k = plant.parameter("k", "s^-2", 4.0)
        u = plant.input("u", "m/s^2")
        plant.rate("x", v)
        plant.rate("v", u - k * x)
        plant.output("y", "m", x, sigma=1e-3)
        plant.write("duffing.json")
    """

    def __init__(self, name: str, doc: str):
        self.name, self.doc = name, doc
        self._states: list[_Symbol] = []
        self._parameters: list[_Symbol] = []
        self._inputs: list[_Symbol] = []
        self._outputs: list[_Symbol] = []
        self._late: list[_Late] = []
        self._regressors: list[str] = []
        self._periods: list[tuple[str, float]] = []
        self._rates: dict[str, ca.SX] = {}
        self._densities: dict[str, float] = {}
        self._effects: list[_Effect] = []
        self._extensions: list[tuple[str, float, float | None, float | None]] = []
        self._dropped: list[tuple[str, str]] = []
        self._grammar: bool | None = None

    def state(self, name: str, unit: str = "", initial: float = 0.0, sigma: float | None = None,
              typical: float | None = None, doc: str = "") -> ca.SX:
        """A state that moves. `sigma` is the standard deviation of its initial value before a record
        (nothing is known of it without); `typical` its size in use, which signs and dead zones need."""
        return self._declare(self._states, name, unit, doc, initial=float(initial),
                             sigma=_sigma(name, sigma), typical=typical)

    def parameter(self, name: str, unit: str = "", value: float = 0.0, sigma: float | None = None,
                  positive: bool = False, doc: str = "") -> ca.SX:
        """A constant that a fit estimates, with its value before a record and the standard deviation
        of that; nothing is known of it without."""
        return self._declare(self._parameters, name, unit, doc, value=float(value),
                             sigma=_sigma(name, sigma), positive=positive)

    def input(self, name: str, unit: str = "", interpolate: bool = False,
              typical: float | None = None, doc: str = "") -> ca.SX:
        """A measured input: held from row to row, or interpolated."""
        return self._declare(self._inputs, name, unit, doc, interpolate=interpolate, typical=typical)

    def delay(self, logged: ca.SX, unit: str = "s", value: float = 0.0, sigma: float | None = None,
              doc: str = "") -> ca.SX:
        """An input as it acts: a dead time after it is logged. The dead time is a parameter named
        `INPUT.delay`, in seconds, with its value before a record and the standard deviation of that. Before the
        first row of a record an input is what it is there. Rates may use what is returned, readings may not."""
        index = next((i for i, one in enumerate(self._inputs) if ca.is_equal(one.sx, logged)), None)
        if index is None:
            raise PlantError(f"the delay of `{logged}` is not that of an input; give what plant.input(...) "
                             "returned")
        name = self._inputs[index].name
        if unit != "s":
            raise PlantError(f"the delay of `{name}` is in `{unit}`, expected `s`, as the time of a record is")
        if any(late.index == index for late in self._late):
            raise PlantError(f"the delay of `{name}` is declared twice; use what the first call returned")
        self.parameter(f"{name}.delay", unit, value, sigma, doc=doc or f"dead time of {name}")
        late = _Late(ca.SX.sym(f"{name}_late"), index, len(self._parameters) - 1)
        self._late.append(late)
        return late.sx

    def regressor(self, name: str) -> None:
        """A logged quantity, such as a temperature, that rates and outputs may depend on."""
        self._regressors.append(name)

    def period(self, name: str, seconds: float) -> None:
        """A known period, such as that of a shaft or a day. Rates and outputs may have a wave of it over the
        time that is logged."""
        if not seconds > 0:
            raise PlantError(f"the period `{name}` is {seconds} s, expected more than 0")
        if name in dict(self._periods):
            raise PlantError(f"the period `{name}` is declared twice; rename one")
        self._periods.append((name, float(seconds)))

    def rate(self, state: str, expression: ca.SX, noise: float = 0.0) -> None:
        """Rate of change of a state; `noise` is the root of the spectral density of white noise in it,
        its unit times the root of a second."""
        if state not in [one.name for one in self._states]:
            raise PlantError(f"a rate is given for `{state}`, which is no state; declare "
                             f"plant.state(\"{state}\") first")
        if state in self._rates:
            raise PlantError(f"the rate of `{state}` is given twice; leave one")
        self._rates[state] = ca.SX(expression)
        if noise < 0:
            raise PlantError(f"the noise of the rate of `{state}` is {noise}, expected 0 or more")
        self._densities[state] = float(noise)

    def output(self, name: str, unit: str, expression: ca.SX, sigma: float,
               saturates: tuple[float, float] | None = None, doc: str = "") -> None:
        """What a sensor reads, with the standard deviation of its white noise. At the ends of
        `saturates` it says nothing."""
        if not sigma > 0:
            raise PlantError(f"the noise of output `{name}` is {sigma}, expected a standard deviation "
                             "above 0: a guess within a factor of two will do, it is estimated")
        self._declare(self._outputs, name, unit, doc, expression=ca.SX(expression),
                      sigma=float(sigma), saturates=saturates)

    def effect(self, ident: str, term: ca.SX, rate: str = "", output: str = "", name: str = "",
               unit: str = "") -> None:
        """A term that a rate or an output may have, times a size that is to be found. With one such
        term no catalogue is proposed; `plant.propose()` adds the proposed one to it."""
        place, index = self._channel(ident, rate, output)
        if any(other.id == ident for other in self._effects):
            raise PlantError(f"effect `{ident}` is declared twice; rename one")
        self._effects.append(_Effect(ident, name or ident, str(ca.SX(term)), unit or "1", "term",
                                     place, index, ca.SX(term), own=True))
        self._grammar = bool(self._grammar)

    def propose(self) -> None:
        """Proposes a catalogue beside the effects that are given."""
        self._grammar = True

    def extend(self, ident: str, value: float = 0.0, sigma: float | None = None, knee: float | None = None) -> None:
        """Takes a term of the catalogue into the equations. Its size becomes a parameter of this name,
        with its value before a record and the standard deviation of that; a knee becomes one named
        `IDENT.knee`."""
        self._extensions.append((ident, float(value), sigma, knee))

    def write(self, path: str | Path | None = None) -> None:
        """Writes the program file, by default beside the script."""
        if _handed is not None:
            _handed.append((self.to_json(), self._dropped))
            return
        target = Path(path) if path else Path(sys.argv[0]).with_suffix(".json")
        target.write_text(self.to_json(), encoding="utf-8", newline="\n")
        print(f"{target}: {len(self._effects)} effects in the catalogue, {len(self._dropped)} left out")
        for ident, why in self._dropped:
            print(f"  {ident}: {why}")

    def to_json(self) -> str:
        """The program file."""
        self._check()
        self._extend_by_delays()
        if self._grammar is not False:
            self._propose()
        self._extend()
        sizes = self._judged()
        return self._program(sizes).to_json()

    # --- declarations

    def _declare(self, place: list[_Symbol], name: str, unit: str, doc: str, **facts) -> ca.SX:
        every = [*self._states, *self._parameters, *self._inputs, *self._outputs]
        if any(other.name == name for other in every):
            raise PlantError(f"`{name}` is declared twice; rename one")
        try:
            units.parse(unit)
        except ValueError as error:
            raise PlantError(f"`{name}`: {error}") from error
        symbol = _Symbol(name, unit, doc or name, ca.SX.sym(name), facts)
        place.append(symbol)
        return symbol.sx

    def _channel(self, ident: str, rate: str, output: str) -> tuple[str, int]:
        names = {"rate": [one.name for one in self._states], "output": [o.name for o in self._outputs]}
        for place, name in (("rate", rate), ("output", output)):
            if name in names[place]:
                return place, names[place].index(name)
        raise PlantError(f"effect `{ident}` names the rate `{rate}` and the output `{output}`, expected "
                         f"rate= one of {names['rate']} or output= one of {names['output']}, which must "
                         "be declared before")

    # --- checks

    def _check(self) -> None:
        if not self._states or not self._outputs:
            raise PlantError(f"plant `{self.name}` has {len(self._states)} states and "
                             f"{len(self._outputs)} outputs, expected one of each at least")
        for state in self._states:
            if state.name not in self._rates:
                raise PlantError(f"state `{state.name}` has no rate; add plant.rate(\"{state.name}\", …)")
        known = [*self._states, *self._parameters, *self._inputs]
        late = [one.sx for one in self._late]
        symbols = [one.sx for one in known] + late
        readings = [(f"output `{one.name}`", one.facts["expression"]) for one in self._outputs]
        readings += [(f"effect `{one.id}`", one.term) for one in self._effects if one.place == "output"]
        for what, reading in readings:
            if any(ca.depends_on(reading, one) for one in late):
                raise PlantError(f"{what} uses a delayed input, which rates alone may: let a state "
                                 "follow the input, and read that")
        every = [(f"the rate of `{n}`", e) for n, e in self._rates.items()]
        every += [(f"output `{o.name}`", o.facts["expression"]) for o in self._outputs]
        every += [(f"effect `{e.id}`", e.term) for e in self._effects if e.term is not None]
        for what, expression in every:
            if expression.numel() != 1:
                raise PlantError(f"{what} has {expression.numel()} elements, expected one number")
            free = [str(s) for s in ca.symvar(expression)
                    if not any(ca.is_equal(s, one) for one in symbols)]
            if free:
                raise PlantError(f"{what} uses {', '.join(free)}, which the plant does not declare")
        self._check_units(known)
        # A state that moves no output, directly or through other states, cannot be estimated.
        seen = ca.vertcat(*[o.facts["expression"] for o in self._outputs])
        rates = {s.name: self._rates[s.name] for s in self._states}
        reached = {s.name for s in self._states if ca.depends_on(seen, s.sx)}
        while True:
            more = {s.name for s in self._states if s.name not in reached
                    and any(ca.depends_on(rates[name], s.sx) for name in reached)}
            if not more:
                break
            reached |= more
        for state in self._states:
            if state.name not in reached:
                raise PlantError(f"no output depends on state `{state.name}`, not even through other "
                                 "states: no record says anything of it; add a sensor or leave it out")

    def _check_units(self, known: list[_Symbol]) -> None:
        symbols = [one.sx for one in known] + [late.sx for late in self._late]
        names = [one.unit for one in known] + [self._inputs[late.index].unit for late in self._late]
        wanted = [(f"the rate of `{s.name}`", self._rates[s.name], s.unit and units.per_s(s.unit))
                  for s in self._states]
        wanted += [(f"output `{o.name}`", o.facts["expression"], o.unit) for o in self._outputs]
        for what, expression, unit in wanted:
            try:
                found = units.of(expression, symbols, names)
            except units.Disagree as error:
                raise PlantError(f"units of {what} disagree: {error} in {expression}; correct a unit or "
                                 "the equation") from error
            if unit and found is not None and found != units.parse(unit):
                raise PlantError(f"units of {what} disagree: the expression is in "
                                 f"`{units.written(found)}`, its declaration in "
                                 f"`{units.written(units.parse(unit))}`; correct a unit or the equation")

    # --- catalogue

    def _kinematic(self, state: _Symbol) -> bool:
        """A rate that is another state: a definition, which nothing can be added to."""
        return any(ca.is_equal(self._rates[state.name], other.sx) for other in self._states)

    def _moving(self) -> list[_Symbol]:
        return [state for state in self._states if not self._kinematic(state)]

    def _propose(self) -> None:
        symbols = [(s.name, units.plain(s.unit), s.sx, s.facts["typical"], True) for s in self._states]
        acting = self._acting()
        symbols += [(i.name, units.plain(i.unit), acting[n], i.facts["typical"], False)
                    for n, i in enumerate(self._inputs)]
        for index, state in enumerate(self._states):
            if self._kinematic(state):
                continue
            own = units.per_s(state.unit)
            for ident, words, unit, expression, knee in grammar.functions(symbols):
                self._add(f"{state.name}_rate.{ident}", f"rate of {state.name}: {words}",
                          units.over(own, unit), "rate", index, expression, knee)
        rates = ca.vertcat(*[self._rates[s.name] for s in self._states])
        states = ca.vertcat(*[s.sx for s in self._states])
        for index, output in enumerate(self._outputs):
            reading = output.facts["expression"]
            fed = any(ca.depends_on(reading, i.sx) for i in self._inputs)
            slope = None if fed else ca.jacobian(reading, states) @ rates
            # A reading is of its row, and has no part of an input that acts late.
            if slope is not None and any(ca.depends_on(slope, late.sx) for late in self._late):
                slope = None
            terms = grammar.of_output(output.name, units.plain(output.unit), reading, slope)
            for ident, words, unit, expression in terms:
                self._add(f"{output.name}.{ident}", f"sensor: {words}",
                          units.over(output.unit or "1", unit), "output", index, expression)

    def _acting(self) -> list[ca.SX]:
        """The inputs as they act: those with a dead time late."""
        acting = [one.sx for one in self._inputs]
        for late in self._late:
            acting[late.index] = late.sx
        return acting

    def _add(self, ident, name, unit, place, index, term, knee=None) -> None:
        if any(other.id == ident for other in self._effects):
            return
        self._effects.append(_Effect(ident, name, str(term), unit, "term", place, index, term, knee))

    def _unit_of(self, knee: grammar.Knee) -> str:
        return next(one.unit for one in [*self._states, *self._inputs] if one.name == knee.of)

    def _extend_by_delays(self) -> None:
        """Makes inputs late in all rates, and so in the terms that are proposed for these."""
        delays = {f"{one.name}.delay": one.sx for one in self._inputs}
        for ident, value, sigma, knee in self._extensions:
            if ident not in delays:
                continue
            if knee is not None:
                raise PlantError(f"effect `{ident}` has no knee; leave `knee=` out")
            logged = delays[ident]
            late = self.delay(logged, "s", value, sigma)
            self._rates = {name: ca.substitute(rate, logged, late) for name, rate in self._rates.items()}
            for own in self._effects:
                if own.place == "rate" and own.term is not None:
                    own.term = ca.substitute(own.term, logged, late)
        self._extensions = [one for one in self._extensions if one[0] not in delays]

    def _extend(self) -> None:
        """Makes terms of the catalogue nominal ones."""
        of_time = {effect.id for effect in self._of_time(self._constants())}
        for ident, value, sigma, knee in self._extensions:
            known = {effect.id: effect for effect in [*self._constants(), *self._effects]}
            if ident in of_time:
                raise PlantError(f"effect `{ident}` is a function of time and no term of the equations, "
                                 "which a model cannot be extended by: leave it out, each diagnosis "
                                 "searches for it")
            if ident not in known:
                near = difflib.get_close_matches(ident, known, n=3)
                raise PlantError(f"the catalogue has no effect `{ident}` to extend the plant by"
                                 + (f"; near names are {', '.join(near)}" if near else ""))
            effect = known[ident]
            size = self._declare(self._parameters, ident, effect.unit, effect.name, value=value,
                                 sigma=_sigma(ident, sigma), positive=False)
            term = effect.term
            if effect.knee:
                own = effect.knee
                bend = self._declare(self._parameters, f"{ident}.knee", self._unit_of(own), f"knee of {effect.name}",
                                     value=own.value if knee is None else float(knee), sigma=own.sigma,
                                     positive=False)
                term = ca.substitute(term, own.sx, bend)
            elif knee is not None:
                raise PlantError(f"effect `{ident}` has no knee; leave `knee=` out")
            if effect.place == "rate":
                state = self._states[effect.index].name
                self._rates[state] = self._rates[state] + size * term
            else:
                facts = self._outputs[effect.index].facts
                facts["expression"] = facts["expression"] + size * term
            self._effects = [one for one in self._effects if one is not effect]
        self._extensions = []

    def _constants(self) -> list[_Effect]:
        """A constant in each rate that is no definition and in each output."""
        rates = [_Effect(f"{s.name}_rate.bias", f"rate of {s.name}: a constant", "1",
                         units.per_s(s.unit), "term", "rate", self._states.index(s), ca.SX(1))
                 for s in self._moving()]
        return rates + [_Effect(f"{o.name}.bias", f"sensor: a constant in {o.name}", "1", o.unit or "1",
                                "term", "output", index, ca.SX(1))
                        for index, o in enumerate(self._outputs)]

    def _input_errors(self) -> list[_Effect]:
        """What acts in the place of each input beside what is logged: no effect itself, but delay and play
        multiply it."""
        rates = ca.vertcat(*self._rates.values())
        if self._grammar is False:
            return []
        late = {one.index: one.sx for one in self._late}
        return [_Effect(f"{i.name}.error", f"input {i.name}", "1", i.unit or "1", "term", "input", index,
                        ca.SX(1))
                for index, i in enumerate(self._inputs)
                if ca.depends_on(rates, i.sx) or index in late and ca.depends_on(rates, late[index])]

    def _judged(self) -> list[_Symbol]:
        """Sizes of all terms: biases of the channels first, then what the catalogue keeps."""
        biases = self._constants() + self._input_errors()
        every = biases + self._effects
        sizes = ca.SX.sym("size", len(every))
        rates, output = self._with(every, sizes)
        bent = [e.knee for e in every if e.knee]
        if bent:
            knees, places = ca.vertcat(*[one.sx for one in bent]), ca.vertcat(*[one.value for one in bent])
            rates, output = (ca.substitute(e, knees, places) for e in (rates, output))
        late = [self._inputs[one.index] for one in self._late]
        scales = [one.facts["typical"] or 1.0 for one in [*self._states, *self._inputs, *late]]
        variables = [one.sx for one in [*self._states, *self._inputs, *self._late]]
        found = dependence.judge(
            rates, output, ca.vertcat(*variables), scales,
            ca.vertcat(*[p.sx for p in self._parameters]),
            [p.facts["value"] for p in self._parameters], sizes)
        kept, self._channels = [], {}
        for index, (effect, judged) in enumerate(zip(every, found)):
            why = self._reason(every, judged)
            is_bias = index < len(biases)
            if why and effect.own:
                raise PlantError(f"effect `{effect.id}` {why}; leave it out")
            if is_bias:
                # Drifts, steps and regressors of a channel multiply it, whether it is an effect or not.
                self._channels[(effect.place, effect.index)] = len(self._channels)
            if effect.place == "input":
                continue
            if why:
                self._dropped.append((effect.id, why))
            else:
                kept.append(index)
        names = {index: every[index].id for index in kept}
        for index in kept:
            every[index].equivalents = [names[o] for o in found[index].equivalents if o in names]
        self._biases = biases
        self._effects = [every[index] for index in kept]
        self._effects += self._of_time(biases)
        own = biases + [e for e in self._effects if e.term is not None and e not in biases]
        return own

    def _reason(self, every: list[_Effect], judged: dependence.Judgement) -> str:
        if judged.is_zero:
            return "is identically zero, or the same at all points as nothing"
        if judged.copy_of is not None and every[judged.copy_of].place != "input":
            return f"is a copy of `{every[judged.copy_of].id}`"
        if judged.covered_by is not None:
            names = " and ".join(f"`{self._parameters[i].name}`" for i in judged.covered_by)
            return f"does the same as a change of the nominal parameter {names}, which is fitted"
        return ""

    def _of_time(self, biases: list[_Effect]) -> list[_Effect]:
        found = []
        for bias in biases:
            if bias.place == "input":
                is_late = any(late.index == bias.index for late in self._late)
                found += [_Effect(f"{self._inputs[bias.index].name}.{kind}", f"{bias.name} {words}", formula,
                                  unit, kind, "input", bias.index)
                          for kind, words, formula, unit in grammar.of_input(bias.unit)
                          if not (is_late and kind == "delay")]
                continue
            channel = bias.id.removesuffix(".bias")
            words = bias.name.removesuffix("a constant").rstrip(": ")
            found.append(_Effect(f"{channel}.ramp", f"{words}: a drift in proportion to time",
                                 "t", f"{bias.unit} per h", "ramp", bias.place, bias.index))
            found.append(_Effect(f"{channel}.step", f"{words}: a step", "step(t - t0)", bias.unit,
                                 "step", bias.place, bias.index))
            for index, name in enumerate(self._regressors):
                found.append(_Effect(f"{channel}.{name}", f"{words}: proportional to {name}", name,
                                     f"{bias.unit} per unit of {name}", "regressor", bias.place,
                                     bias.index, regressor=index))
            found += self._waves(bias, channel, words)
        rates = ca.vertcat(*self._rates.values())
        for index, parameter in enumerate(self._parameters):
            if ca.depends_on(rates, parameter.sx):
                found.append(_Effect(f"{parameter.name}.step", f"a sudden change of {parameter.name}",
                                     "step(t - t0)", parameter.unit or "1", "step", "parameter", index))
        return found

    def _waves(self, bias: _Effect, channel: str, words: str) -> Iterator[_Effect]:
        # Waves follow the logged quantities: of each period the sine, then the cosine.
        place = len(self._regressors)
        for name, seconds in self._periods:
            for wave, formula in (("sine", "sin"), ("cosine", "cos")):
                yield _Effect(f"{channel}.{name}.{wave}", f"{words}: the {wave} of a wave of {seconds:g} s",
                              f"{formula}(2 pi t / {seconds:g} s)", bias.unit, "regressor", bias.place,
                              bias.index, regressor=place)
                place += 1

    # --- program

    def _with(self, effects: list[_Effect], sizes: ca.SX) -> tuple[ca.SX, ca.SX]:
        rates = [self._rates[s.name] for s in self._states]
        output = [o.facts["expression"] for o in self._outputs]
        errors = {e.index: sizes[position] for position, e in enumerate(effects) if e.place == "input"}
        places = [(i.sx, index) for index, i in enumerate(self._inputs)]
        places += [(late.sx, late.index) for late in self._late]
        logged = ca.vertcat(*[sx for sx, _ in places])
        acting = ca.vertcat(*[sx + errors.get(index, 0) for sx, index in places])
        if errors:
            rates = [ca.substitute(rate, logged, acting) for rate in rates]
        for position, effect in enumerate(effects):
            if effect.place == "input":
                continue
            target = rates if effect.place == "rate" else output
            target[effect.index] = target[effect.index] + sizes[position] * effect.term
        return ca.vertcat(*rates), ca.vertcat(*output)

    def _program(self, terms: list[_Effect]):
        nominal = len(self._parameters)
        elements = [_element(p.name, p.unit, p.doc, f"parameter_{i}")
                    for i, p in enumerate(self._parameters)]
        # A constant that extends the plant is a channel as well.
        taken = {p.name for p in self._parameters}
        elements += [_element(f"further {e.id}" if e.id in taken else e.id, e.unit, e.name, f"size_{i}")
                     for i, e in enumerate(terms)]
        bent = [e for e in terms if e.knee]
        elements += [_element(f"{e.id}.knee", self._unit_of(e.knee), f"knee of {e.name}", f"knee_{i}")
                     for i, e in enumerate(bent)]
        late = [self._inputs[one.index] for one in self._late]
        elements += [_element(f"{i.name}.late", i.unit, f"what {i.name} was its dead time before, less what it is",
                              f"late_{n}") for n, i in enumerate(late)]
        elements += [_element(e.id, e.unit, e.name, f"delay_{n}") for n, e in enumerate(self._delays())]
        parameters = Group("parameters", "Parameters, sizes of effects, then knees of these, what delayed inputs were "
                           "less what they are, and delays that are effects.", elements)
        states = Group("states", "States.", [_element(s.name, s.unit, s.doc, f"state_{i}")
                                             for i, s in enumerate(self._states)])
        inputs = Group("inputs", "Inputs.", [_element(i.name, i.unit, i.doc, f"input_{n}")
                                             for n, i in enumerate(self._inputs)])
        driven = [s for s in self._states if self._densities[s.name] > 0]
        noise = Group("noise", "Noise of rates.", [
            Element(f"noise_{i}", s.unit, f"noise of the rate of {s.name}") for i, s in enumerate(driven)])
        rates, output = self._with(terms, parameters.sx[nominal:nominal + len(terms)])
        for i, state in enumerate(driven):
            rates[self._states.index(state)] += noise.sx[i]
        old = ca.vertcat(*[s.sx for s in [*self._states, *self._parameters, *self._inputs]],
                         *[e.knee.sx for e in bent], *[one.sx for one in self._late])
        knees = nominal + len(terms)
        first = knees + len(bent)
        acting = [inputs.sx[one.index] + parameters.sx[first + n] for n, one in enumerate(self._late)]
        new = ca.vertcat(states.sx, parameters.sx[:nominal], inputs.sx, parameters.sx[knees:first], *acting)
        rates, output = (ca.substitute(e, old, new) for e in (rates, output))
        program = Equations(
            self.name, self.doc, states, rates, output,
            [f"reading_{i}" for i in range(len(self._outputs))], "mixed",
            parameters=parameters, inputs=[inputs] if self._inputs else [],
            noise=noise if driven else None, source=f"equations of {self.name}",
        ).program()
        program.tables = self._tables(terms, driven)
        return program

    def _delays(self) -> list[_Effect]:
        return [effect for effect in self._effects if effect.kind == "delay"]

    def _tables(self, terms: list[_Effect], driven: list[_Symbol]) -> list[Table]:
        nominal = len(self._parameters)
        bent = [e for e in terms if e.knee]
        first = nominal + len(terms) + len(bent)

        def size_of(effect: _Effect) -> int:
            if effect.kind == "delay":
                return first + len(self._late) + self._delays().index(effect)
            if effect.term is not None:
                return nominal + terms.index(effect)
            if effect.place == "parameter":
                return effect.index
            return nominal + self._channels[(effect.place, effect.index)]

        channels = [{"place": b.place, "index": b.index, "unit": b.unit, "name": b.id.removesuffix(".bias").removesuffix(".error"),
                     "constant": nominal + position} for position, b in enumerate(self._biases)]
        outputs = []
        for one in self._outputs:
            low, high = one.facts["saturates"] or (0.0, 0.0)
            outputs.append({"id": one.name, "unit": one.unit or "1", "sigma": one.facts["sigma"],
                            "saturates": one.facts["saturates"] is not None, "low": low, "high": high})
        tables = [
            _table("plant_states", "PlantState", "States.", [
                {"id": s.name, "unit": s.unit or "1", "initial": s.facts["initial"],
                 "sigma": s.facts["sigma"]} for s in self._states]),
            _table("plant_parameters", "PlantParameter", "Nominal parameters.", [
                {"id": p.name, "unit": p.unit or "1", "value": p.facts["value"],
                 "sigma": p.facts["sigma"], "positive": p.facts["positive"]}
                for p in self._parameters]),
            _table("plant_inputs", "PlantInput", "Inputs.", [
                {"id": i.name, "unit": i.unit or "1", "interpolate": i.facts["interpolate"]}
                for i in self._inputs]),
            _table("plant_outputs", "PlantOutput", "Outputs.", outputs),
            _table("plant_noises", "PlantNoise", "White noise of rates.", [
                {"state": self._states.index(s), "density": self._densities[s.name]} for s in driven]),
            _table("plant_regressors", "PlantRegressor", "Logged quantities.", [
                {"id": name} for name in self._regressors]),
            _table("plant_periods", "PlantPeriod", "Known periods.", [
                {"id": name, "period_s": seconds} for name, seconds in self._periods]),
            _table("plant_channels", "PlantChannel", "Rates and outputs that effects enter.", channels),
            _table("plant_knees", "PlantKnee", "Knees of effects.", [
                {"size": size_of(e), "constant": nominal + len(terms) + position, "unit": self._unit_of(e.knee) or "1",
                 "value": e.knee.value, "sigma": e.knee.sigma}
                for position, e in enumerate(bent)]),
            _table("plant_delays", "PlantDelay", "Dead times of inputs, and the constants that make inputs late.", [
                {"input": one.index, "constant": first + position, "time": one.parameter}
                for position, one in enumerate(self._late)] + [
                {"input": e.index, "constant": nominal + self._channels[("input", e.index)], "time": size_of(e)}
                for e in self._delays()]),
            _table("plant_effects", "PlantEffect", "Catalogue of effects.", [
                {"id": e.id, "name": e.name, "formula": e.formula, "unit": e.unit, "kind": e.kind,
                 "place": e.place, "index": e.index, "size": size_of(e), "regressor": e.regressor,
                 "equivalents": e.equivalents} for e in self._effects]),
        ]
        # A program has no empty tables.
        return [table for table in tables if table.rows]


def _sigma(name: str, sigma: float | None) -> float:
    """Zero stands for a value of which nothing is known."""
    if sigma is not None and not sigma > 0:
        raise PlantError(f"the standard deviation of `{name}` is {sigma}, expected one above 0, or none "
                         "if nothing is known of it")
    return float(sigma or 0.0)


def _element(ident: str, unit: str, doc: str, name: str) -> Element:
    return Element(name, unit or "1", doc, ident)


def _table(name: str, row: str, doc: str, rows: list[dict]) -> Table:
    fields = {key: key for key in rows[0]} if rows else {"id": "id"}
    return Table(name, row, doc, fields, rows)
