"""Turns CasADi `SX` functions into a *program*: a JSON file of named functions,
each with named inputs and outputs and a flat list of scalar instructions.

The exporter knows nothing of any particular model. A derivation script builds a
`Program`, adds `Function`s to it and writes it; `gyrocal-codegen` reads it.

Schema version 1
----------------
    {"schema_version": 1, "name", "doc", "casadi_version",
     "groups":    [{"name", "doc", "elements": [{"name", "id", "unit", "doc"}]}],
     "functions": [{"name", "doc", "source", "domain",
                    "inputs":  [{"group"}],
                    "outputs": [{"name", "doc", "unit", "rows", "columns",
                                 "row_names", "column_names",
                                 "nonzeros": [[row, column]]}],
                    "work_size", "instructions": [[op, ...]]}],
     "tables":    [{"name", "row", "module", "doc", "fields": [{"name", "doc"}],
                    "rows": [[value, ...]]}],          (may be left out)
     "externals": [{"name", "path", "doc", "arguments"}],     (may be left out)
     "model": null or
        {"name", "doc", "moving", "parameters", "noise", "inputs": [group], "flat",
         "rates":  {"value", "jacobian", "jacobian_at_origin"},
         "output": {"value", "jacobian", "jacobian_at_origin"}}}

A *group* is a named vector of scalar inputs (a state, a set of parameters, a
physical vector). `nonzeros` are the structural nonzeros of an output in the order
in which `output` instructions number them.

A *table* holds facts about a program: one record a row, one value for each field. All values
of a field are strings, numbers, booleans or lists of strings. `row` is the name of a Rust type,
which the emitter declares. With `module` (null or left out otherwise) the module of that name in
the scalar crate declares it, and values may be of its types:
    {"index": 3}                                        an index
    {"variant": "Shape::Round", "arguments": [value]}   a variant of an enum, `Some` and `None`
    {"record": "Ring", "fields": {name: value}}         a struct
    {"list": [value]}                                   a slice

A *model* says which groups and functions play which part. `name` is that of a Rust
type. `moving` (states with rates), `parameters` (constant states, or null), `noise`
(inputs of the rates that are zero on average, or null; no function takes them) and
`inputs` (the rest) name groups, each in one part. `flat` is false where the moving states are
coordinates in a chart that hand-written Rust moves; true if it is left out. Of `rates` and `output`
    value               names a function of one output, a full column;
    jacobian            one that gives the same value first, then VALUE_d_GROUP for
                        moving, parameters and (rates only) noise; what is left out is
                        structurally zero;
    jacobian_at_origin  may be left out: one that gives the outputs of `jacobian` where
                        all moving states are zero. It takes no moving states; its
                        outputs have the same names, order and shapes, and nonzeros
                        only where those of `jacobian` have them.

Instructions, `w` being a work vector of `work_size` scalars:
    ["input", w, input, element]      ["output", output, nonzero, w]
    ["const", w, value]               [operation, w, operand, ...]
    ["call", w, external, operand, ...]

An *external* function is one of the surrounding Rust, `fn name<T: Scalar>(x: T) -> T` with up to
four arguments, at `path`.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import casadi as ca

SCHEMA_VERSION = 1

# What the emitter can lower: every operation of SX but `printme`, which writes to the console.
# Anything else is refused here, by name, before a program is written.
_UNARY = {
    ca.OP_NEG: "neg", ca.OP_SQ: "sq", ca.OP_TWICE: "twice", ca.OP_INV: "inv",
    ca.OP_SQRT: "sqrt", ca.OP_EXP: "exp", ca.OP_LOG: "log",
    ca.OP_SIN: "sin", ca.OP_COS: "cos", ca.OP_TAN: "tan",
    ca.OP_ASIN: "asin", ca.OP_ACOS: "acos", ca.OP_ATAN: "atan",
    ca.OP_SINH: "sinh", ca.OP_COSH: "cosh", ca.OP_TANH: "tanh",
    ca.OP_ASINH: "asinh", ca.OP_ACOSH: "acosh", ca.OP_ATANH: "atanh",
    ca.OP_EXPM1: "expm1", ca.OP_LOG1P: "log1p", ca.OP_ERF: "erf", ca.OP_ERFINV: "erfinv",
    ca.OP_FLOOR: "floor", ca.OP_CEIL: "ceil",
    ca.OP_FABS: "abs", ca.OP_SIGN: "sign", ca.OP_NOT: "not", ca.OP_ASSIGN: "copy",
}
_BINARY = {
    ca.OP_ADD: "add", ca.OP_SUB: "sub", ca.OP_MUL: "mul", ca.OP_DIV: "div",
    ca.OP_POW: "pow", ca.OP_CONSTPOW: "pow", ca.OP_ATAN2: "atan2",
    ca.OP_FMOD: "fmod", ca.OP_REMAINDER: "remainder", ca.OP_HYPOT: "hypot",
    ca.OP_COPYSIGN: "copysign", ca.OP_FMIN: "min", ca.OP_FMAX: "max",
    ca.OP_LT: "lt", ca.OP_LE: "le", ca.OP_EQ: "eq", ca.OP_NE: "ne",
    ca.OP_AND: "and", ca.OP_OR: "or", ca.OP_IF_ELSE_ZERO: "if_else_zero",
}
_NAMES = {
    getattr(ca, name): name
    for name in dir(ca)
    if name.startswith("OP_") and isinstance(getattr(ca, name), int)
}


class ExportError(Exception):
    """A model that cannot become a program; the message says what to change."""


def rust_name(name: str) -> str:
    """The name in Rust: lower-case words joined by `_`, so `V_x` is `v_x` and `omegaX` `omega_x`.

    Names without capitals stay as they are.
    """
    if not re.search("[A-Z]", name):
        return name
    words = re.sub("(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name)
    return re.sub("_+", "_", words).lower()


def _rust_names(place: str, names: Sequence[str]) -> list[str]:
    """The names in Rust; refuses two that become one."""
    seen: dict[str, str] = {}
    for name in names:
        other = seen.setdefault(rust_name(name), name)
        if other != name:
            raise ExportError(f"{place} has `{other}` and `{name}`, which are both "
                              f"`{rust_name(name)}` in Rust; rename one")
    return [rust_name(name) for name in names]


@dataclass(frozen=True)
class Element:
    """One scalar of a group: name, unit, meaning, and its public id (by default the name, if that
    has capitals and so is another in Rust)."""

    name: str
    unit: str
    doc: str
    id: str = ""

    def to_dict(self) -> dict[str, str]:
        name = rust_name(self.name)
        ident = self.id or (self.name if self.name != name else "")
        return {"name": name, "id": ident, "unit": self.unit, "doc": self.doc}


class Group:
    """A named vector of scalar inputs, declared once and used by many functions."""

    def __init__(self, name: str, doc: str, elements: Sequence[Element],
                 shape: tuple[int, int] | None = None):
        self.name = name
        self.doc = doc
        self.elements = list(elements)
        self.shape = shape or (len(self.elements), 1)
        _rust_names(f"group `{name}`", self.names)
        self.sx = ca.vertcat(*[ca.SX.sym(element.name) for element in elements])

    def __getitem__(self, name: str) -> ca.SX:
        """The symbol of the element called `name`."""
        for index, element in enumerate(self.elements):
            if element.name == name:
                return self.sx[index]
        raise KeyError(f"group `{self.name}` has no element `{name}`")

    @property
    def names(self) -> list[str]:
        return [element.name for element in self.elements]

    @property
    def matrix(self) -> ca.SX:
        """The symbols in the shape of the group; elements of a matrix stand row by row."""
        rows, columns = self.shape
        return ca.reshape(self.sx, columns, rows).T

    def to_dict(self) -> dict[str, Any]:
        elements = [element.to_dict() for element in self.elements]
        return {"name": rust_name(self.name), "doc": self.doc, "elements": elements}


def vector(name: str, doc: str, unit: str, axes: Sequence[str] = ("x", "y", "z")) -> Group:
    """A group of one element for each axis, called `NAME_AXIS`."""
    return Group(name, doc, [Element(f"{name}_{axis}", unit, f"along {axis}") for axis in axes])


def matrix(name: str, doc: str, unit: str, rows: Sequence[str], columns: Sequence[str]) -> Group:
    """A group with the elements of a matrix, row by row, called `NAME_ROW_COLUMN`."""
    elements = [Element(f"{name}_{row}_{column}", unit, f"row {row}, column {column}")
                for row in rows for column in columns]
    shape = (len(rows), len(columns))
    text = f"{doc.rstrip('.')}: {shape[0]} x {shape[1]}, row by row."
    return Group(name, text, elements, shape)


class ExternalFunction:
    """A scalar function of the surrounding Rust, called by name.

    `path` is that of a Rust function `fn NAME<T: Scalar>(x: T) -> T` (an argument for each of
    `arguments`, four at most), by default `crate::NAME`. `derivatives` has for each argument what
    gives the partial derivative: another external function, or a callable that makes an expression
    of the arguments. Without them the function cannot be differentiated. CasADi evaluates `value`,
    a callable of symbols, in its place, or NaN.
    """

    known: dict[str, "ExternalFunction"] = {}

    def __init__(self, name: str, doc: str, arguments: Sequence[str], path: str = "",
                 derivatives: Sequence[Callable[..., ca.SX]] | None = None,
                 value: Callable[..., ca.SX] | None = None):
        self.name, self.doc, self.arguments = name, doc, list(arguments)
        self.path = path or f"crate::{name}"
        self.of: str | None = None
        if derivatives is not None and len(derivatives) != len(self.arguments):
            raise ExportError(f"external function `{name}` has {len(self.arguments)} arguments and "
                              f"{len(derivatives)} derivatives, expected one for each")
        symbols = [ca.SX.sym(argument) for argument in self.arguments]
        # Depends on every argument, and is no number.
        body = value(*symbols) if value else ca.sqrt(-1 - ca.sumsqr(ca.vertcat(*symbols)))
        if derivatives is None:
            derivatives = [self._missing() for _ in symbols]
        jacobian = ca.Function(f"jac_{name}", [*symbols, ca.SX.sym("out")],
                               [derivative(*symbols) for derivative in derivatives])
        self.function = ca.Function(name, symbols, [body], {
            "never_inline": True, "custom_jacobian": jacobian, "jac_penalty": 0,
            "enable_forward": False, "enable_reverse": False,
        })
        self._register()

    def _missing(self) -> Callable[..., ca.SX]:
        """A derivative that the exporter refuses."""
        missing = ExternalFunction.__new__(ExternalFunction)
        missing.name, missing.of = f"derivative_of_{self.name}", self.name
        missing.doc, missing.path, missing.arguments = "", "", self.arguments
        symbols = [ca.SX.sym(argument) for argument in self.arguments]
        missing.function = ca.Function(
            missing.name, symbols, [ca.sqrt(-1 - ca.sumsqr(ca.vertcat(*symbols)))],
            {"never_inline": True},
        )
        missing._register()
        return missing

    def _register(self) -> None:
        other = ExternalFunction.known.setdefault(self.name, self)
        if other is not self and (other.path, other.arguments) != (self.path, self.arguments):
            raise ExportError(f"two different external functions are called `{self.name}`")

    def __call__(self, *arguments: ca.SX) -> ca.SX:
        return self.function(*arguments)

    def to_dict(self) -> dict[str, Any]:
        return {"name": self.name, "path": self.path, "doc": self.doc,
                "arguments": len(self.arguments)}


@dataclass(frozen=True)
class Output:
    """A named result: a vector, or a matrix of which only structural nonzeros count."""

    name: str
    expression: ca.SX
    unit: str
    doc: str
    row_names: list[str] = field(default_factory=list)
    column_names: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Function:
    """Expressions of some groups, with what a reader of the Rust must know."""

    name: str
    doc: str
    source: str
    inputs: list[Group]
    outputs: list[Output]
    domain: str = "all finite inputs"

    def casadi(self) -> ca.Function:
        """The CasADi function; refuses what a program cannot hold."""
        for output in self.outputs:
            if not isinstance(output.expression, ca.SX):
                raise ExportError(
                    f"output `{output.name}` of function `{self.name}` is "
                    f"{type(output.expression).__name__}, expected casadi.SX; "
                    "build it from the symbols of groups; an MX function becomes one of SX by "
                    "`function.expand()`"
                )
        known = [group.sx for group in self.inputs]
        free = [
            str(symbol)
            for symbol in ca.symvar(ca.veccat(*[o.expression for o in self.outputs]))
            if not any(ca.depends_on(group, symbol) for group in known)
        ]
        if free:
            raise ExportError(
                f"function `{self.name}` has the free variable(s) {', '.join(free)}; "
                "add the group that declares them to its inputs"
            )
        return ca.Function(
            self.name,
            known,
            [ca.densify(o.expression) if o.expression.is_dense() else o.expression
             for o in self.outputs],
            [group.name for group in self.inputs],
            [output.name for output in self.outputs],
        )


class Table:
    """Facts for the Rust that uses a program: an array of records.

    `name` is that of the array, `row` that of its type; `fields` gives the meaning of each
    field by its name; `rows` hold a value for every field: strings, numbers, booleans or lists
    of strings, of one kind in a field. With `module`, a module of the scalar crate declares the
    type of a record, and values may also be `Index`, `Variant`, `Record` and `Items`.
    """

    def __init__(self, name: str, row: str, doc: str, fields: dict[str, str], rows: list[dict],
                 module: str | None = None):
        self.name, self.row, self.doc, self.fields, self.rows = name, row, doc, fields, rows
        self.module = module

    def to_dict(self) -> dict:
        for number, row in enumerate(self.rows):
            if set(row) != set(self.fields):
                raise ExportError(
                    f"row {number} of table `{self.name}` has the fields {sorted(row)}, "
                    f"expected {sorted(self.fields)}"
                )
        kinds = {field: {_kind(self.name, field, row[field]) for row in self.rows}
                 for field in self.fields}
        for name, found in kinds.items():
            if "typed values" in found and self.module is None:
                raise ExportError(
                    f"field `{name}` of table `{self.name}` holds typed values, expected the "
                    "table to name the module that declares their types"
                )
            if len(found) > 1 and self.module is None:
                raise ExportError(
                    f"field `{name}` of table `{self.name}` holds {', '.join(sorted(found))}, "
                    "expected values of one kind"
                )
        module = {} if self.module is None else {"module": self.module}
        return {
            "name": self.name,
            "row": self.row,
            **module,
            "doc": self.doc,
            "fields": [{"name": name, "doc": doc} for name, doc in self.fields.items()],
            "rows": [[_value(row[name]) for name in self.fields] for row in self.rows],
        }


@dataclass(frozen=True)
class Index:
    """An index in a table: a number that is an integer in Rust."""

    value: int

    def to_json(self):
        return {"index": self.value}


@dataclass(frozen=True)
class Variant:
    """A variant of a Rust enum, `Shape::Round`, with what it holds."""

    path: str
    arguments: tuple = ()

    def to_json(self):
        return {"variant": self.path, "arguments": [_value(item) for item in self.arguments]}


@dataclass(frozen=True)
class Record:
    """A Rust struct with its fields."""

    name: str
    fields: dict

    def to_json(self):
        fields = {name: _value(value) for name, value in self.fields.items()}
        return {"record": self.name, "fields": fields}


@dataclass(frozen=True)
class Items:
    """A slice of values of one type."""

    items: tuple

    def to_json(self):
        return {"list": [_value(item) for item in self.items]}


def optional(value) -> Variant:
    """`Some` of a value, or `None`."""
    return Variant("None") if value is None else Variant("Some", (value,))


def _kind(table: str, name: str, value) -> str:
    if isinstance(value, (Index, Variant, Record, Items)):
        return "typed values"
    if isinstance(value, bool):
        return "booleans"
    if isinstance(value, (int, float)) and math.isfinite(value):
        return "numbers"
    if isinstance(value, str):
        return "strings"
    if isinstance(value, (list, tuple)) and all(isinstance(item, str) for item in value):
        return "lists"
    raise ExportError(
        f"field `{name}` of table `{table}` holds {value!r}, expected a string, a finite number, "
        "a boolean or a list of strings"
    )


def _value(value):
    """As it stands in the file: numbers are floats, so that a field has one type."""
    if isinstance(value, (Index, Variant, Record, Items)):
        return value.to_json()
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return list(value) if isinstance(value, tuple) else value
    return float(value)


@dataclass
class Program:
    """A set of functions that become one Rust module.

    `model` is the section of that name in the schema; where it names groups, they may
    stand there themselves, which adds those that no function takes (noise) to the
    program.
    """

    name: str
    doc: str
    functions: list[Function] = field(default_factory=list)
    model: dict | None = None
    tables: list[Table] = field(default_factory=list)

    def write(self, path: Path) -> None:
        """Writes the program; the same symbols give the same bytes."""
        path.write_text(self.to_json(), encoding="utf-8", newline="\n")

    def to_json(self) -> str:
        names = [function.name for function in self.functions]
        for name in names:
            if names.count(name) > 1:
                raise ExportError(f"program `{self.name}` has two functions `{name}`")
        _rust_names(f"program `{self.name}`", names)
        groups: dict[str, Group] = {}
        for function in self.functions:
            for group in function.inputs:
                if not isinstance(group, Group):
                    raise ExportError(
                        f"an input of function `{function.name}` is {type(group).__name__}, "
                        "expected a Group: arguments need names, declare them in one"
                    )
                if groups.setdefault(rust_name(group.name), group) is not group:
                    raise ExportError(f"two different groups are called `{group.name}`")
        externals: dict[str, ExternalFunction] = {}
        model = _model_to_dict(self.model, groups)
        document = {
            "schema_version": SCHEMA_VERSION,
            "name": self.name,
            "doc": self.doc,
            "casadi_version": ca.__version__,
            "groups": [group.to_dict() for group in groups.values()],
            "functions": [_function_to_dict(function, externals) for function in self.functions],
            "model": model,
        }
        if externals:
            used = [externals[name] for name in sorted(externals)]
            document["externals"] = [external.to_dict() for external in used]
        if self.tables:
            document["tables"] = [table.to_dict() for table in self.tables]
        return _dump(document) + "\n"


def jacobian_output(of: Output, by: Group | ca.SX, name: str, doc: str, unit: str,
                    column_names: list[str] | None = None) -> Output:
    """The exact Jacobian of `of` with respect to `by` (a group, or some of its symbols)."""
    symbols = by.sx if isinstance(by, Group) else by
    if column_names is None:
        column_names = by.names if isinstance(by, Group) else []
    return Output(
        name,
        ca.sparsify(ca.jacobian(of.expression, symbols)),
        unit,
        doc,
        of.row_names,
        column_names,
    )


def _model_to_dict(model: dict | None, groups: dict[str, Group]) -> dict | None:
    """The model section with names for groups; adds its groups to `groups`."""

    def name(value):
        if isinstance(value, list):
            return [name(item) for item in value]
        if isinstance(value, dict):
            return {key: name(item) for key, item in value.items()}
        if isinstance(value, str):
            return rust_name(value)
        if not isinstance(value, Group):
            return value
        if groups.setdefault(rust_name(value.name), value) is not value:
            raise ExportError(f"two different groups are called `{value.name}`")
        return rust_name(value.name)

    texts = ("name", "doc")
    return None if model is None else {
        key: value if key in texts else name(value) for key, value in model.items()
    }


def _function_to_dict(function: Function, externals: dict[str, ExternalFunction]) -> dict:
    compiled = function.casadi()
    place = f"function `{function.name}`"
    work_size, instructions = _instructions(function.name, compiled, externals)
    outputs = []
    for index, output in enumerate(function.outputs):
        sparsity = compiled.sparsity_out(index)
        rows, columns = sparsity.get_triplet()
        for kind, names, count in (
            ("row", output.row_names, sparsity.size1()),
            ("column", output.column_names, sparsity.size2()),
        ):
            if names and len(names) != count:
                raise ExportError(
                    f"output `{output.name}` of `{function.name}` has {count} {kind}s "
                    f"but {len(names)} {kind} names"
                )
        outputs.append(
            {
                "name": rust_name(output.name),
                "doc": output.doc,
                "unit": output.unit,
                "rows": sparsity.size1(),
                "columns": sparsity.size2(),
                "row_names": _rust_names(f"{place}, rows", output.row_names),
                "column_names": _rust_names(f"{place}, columns", output.column_names),
                "nonzeros": [[int(r), int(c)] for r, c in zip(rows, columns)],
            }
        )
    return {
        "name": rust_name(function.name),
        "doc": function.doc,
        "source": function.source,
        "domain": function.domain,
        "inputs": [{"group": rust_name(group.name)} for group in function.inputs],
        "outputs": outputs,
        "work_size": work_size,
        "instructions": instructions,
    }


def _instructions(name: str, compiled: ca.Function,
                  externals: dict[str, ExternalFunction]) -> tuple[int, list[list]]:
    """Size of the work vector, and the instructions."""
    ids = [compiled.instruction_id(k) for k in range(compiled.n_instructions())]
    if ca.OP_CALL in ids:
        flat = _Flat(name, externals)
        flat.outputs(compiled)
        return flat.size, flat.result
    result: list[list] = []
    for k, op in enumerate(ids):
        to, args = compiled.instruction_output(k), compiled.instruction_input(k)
        if op == ca.OP_INPUT:
            result.append(["input", to[0], args[0], args[1]])
        elif op == ca.OP_OUTPUT:
            result.append(["output", to[0], to[1], args[0]])
        else:
            result.append(_operation(name, compiled, k, to[0], args))
    return compiled.sz_w(), result


def _operation(name: str, compiled: ca.Function, k: int, to: int, args: Sequence[int]) -> list:
    """An instruction that is neither input, output nor call."""
    op = compiled.instruction_id(k)
    if op == ca.OP_CONST:
        value = compiled.instruction_constant(k)
        if not math.isfinite(value):
            raise ExportError(
                f"function `{name}`, instruction {k} holds the constant {value}; "
                "constants must be finite, look for a division by zero or an overflow"
            )
        return ["const", to, value]
    if op in _UNARY:
        return [_UNARY[op], to, args[0]]
    if op in _BINARY:
        return [_BINARY[op], to, args[0], args[1]]
    if op == ca.OP_LIFT:
        return ["copy", to, args[0]]
    if op == ca.OP_PARAMETER:
        raise ExportError(f"function `{name}`, instruction {k} reads a free variable; add the "
                          "group that declares it to the inputs")
    reason = "; it prints to the console" if op == ca.OP_PRINTME else ""
    raise ExportError(
        f"function `{name}`, instruction {k} uses the CasADi operation {_NAMES.get(op, op)}, which "
        f"is not supported{reason}; write it with "
        + ", ".join(sorted(set(_UNARY.values()) | set(_BINARY.values())))
    )


class _Flat:
    """The instructions of a function with those of the functions that it calls in their place;
    calls of external functions stay. Every instruction writes a place of its own."""

    def __init__(self, name: str, externals: dict[str, ExternalFunction]):
        self.name, self.externals = name, externals
        self.size = 0
        self.result: list[list] = []

    def place(self) -> int:
        self.size += 1
        return self.size - 1

    def outputs(self, compiled: ca.Function) -> None:
        """Reads all inputs and writes all outputs of the outermost function."""
        inputs: list[list[int]] = []
        for index in range(compiled.n_in()):
            inputs.append([])
            for element in range(compiled.nnz_in(index)):
                inputs[-1].append(self.place())
                self.result.append(["input", inputs[-1][-1], index, element])
        for index, places in enumerate(self.call(compiled, inputs)):
            for nonzero, place in enumerate(places):
                self.result.append(["output", index, nonzero, place])

    def call(self, compiled: ca.Function, inputs: list[list[int]]) -> list[list[int]]:
        """Places of the outputs of a function, from those of its inputs."""
        work: dict[int, int] = {}
        outputs = [[-1] * compiled.nnz_out(index) for index in range(compiled.n_out())]
        nodes = compiled.instructions_sx()
        for k in range(compiled.n_instructions()):
            op = compiled.instruction_id(k)
            to, args = compiled.instruction_output(k), compiled.instruction_input(k)
            if op == ca.OP_INPUT:
                work[to[0]] = inputs[args[0]][args[1]]
            elif op == ca.OP_OUTPUT:
                outputs[to[0]][to[1]] = work[args[0]]
            elif op == ca.OP_CALL:
                places = self.function(nodes[k].which_function(), [work[arg] for arg in args])
                work.update((w, place) for w, place in zip(to, places) if w >= 0)
            else:
                operands = [work[arg] for arg in args] if op != ca.OP_CONST else args
                place = self.place()
                self.result.append(_operation(self.name, compiled, k, place, operands))
                work[to[0]] = place
        return outputs

    def function(self, called: ca.Function, arguments: list[int]) -> list[int]:
        """Places of the results of a call, all outputs one after another."""
        external = ExternalFunction.known.get(called.name())
        if external is not None:
            if external.of is not None:
                raise ExportError(
                    f"function `{self.name}` has a derivative of the external function "
                    f"`{external.of}`, which has none; give it `derivatives`"
                )
            self.externals[external.name] = external
            place = self.place()
            self.result.append(["call", place, external.name, *arguments])
            return [place]
        try:
            expanded = called if called.class_name() == "SXFunction" else called.expand()
        except RuntimeError as error:
            raise ExportError(
                f"function `{self.name}` calls `{called.name()}`, a {called.class_name()}, which "
                "has no scalar instructions; replace it by an ExternalFunction with derivatives "
                "and provide it in Rust"
            ) from error
        inputs, start = [], 0
        for index in range(expanded.n_in()):
            inputs.append(arguments[start:start + expanded.nnz_in(index)])
            start += expanded.nnz_in(index)
        return [place for output in self.call(expanded, inputs) for place in output]


def _dump(value, indent: int = 0) -> str:
    """JSON with one instruction a line, so that a change of the model reads as a diff."""
    pad = " " * (indent + 1)
    if isinstance(value, dict) and value:
        body = ",\n".join(
            f"{pad}{json.dumps(key)}: {_dump(item, indent + 1)}" for key, item in value.items()
        )
        return "{\n" + body + "\n" + " " * indent + "}"
    if isinstance(value, list) and any(isinstance(item, (dict, list)) for item in value):
        if all(isinstance(item, list) and len(item) == 2 and
               all(isinstance(number, int) for number in item) for item in value):
            return json.dumps(value, separators=(",", ":"))
        body = ",\n".join(pad + _dump(item, indent + 1) for item in value)
        return "[\n" + body + "\n" + " " * indent + "]"
    return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))
