"""Exceptions, with the fields of the errors of the library."""

from __future__ import annotations

from typing import Any

__all__ = ["ComputationError", "GyrocalError", "GyrocalWarning", "InputError", "SetupError", "refusal"]


class GyrocalError(Exception):
    """A call failed. ``str`` gives the message, its causes and what to do.

    Attributes:
        message: What is wrong, in a sentence.
        code: The kind of the fault, such as ``gyrocal::input::norm``.
        file: The file, or the name of the frame, at fault.
        line: Line in the file, from 1. Of a frame: the line that the row would have in a file, whose
            first line is the header.
        column: Character of the line, from 1.
        found: What was found there.
        expected: What was expected.
        advice: What to do.
        causes: The causes, each of the one before it.
        result: The result that tells the same, where there is one.

    >>> import gyrocal
    >>> try:
    ...     gyrocal.diagnose("none.csv", "examples/data/three_days.bench.toml")
    ... except gyrocal.GyrocalError as error:
    ...     error.file, error.line
    ('none.csv', None)
    """

    def __init__(
        self,
        message: str,
        *,
        code: str | None = None,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        found: str | None = None,
        expected: str | None = None,
        advice: str | None = None,
        causes: list[str] | None = None,
        result: Any = None,
    ) -> None:
        super().__init__(message)
        self.message = message
        self.code = code
        self.file = file
        self.line = line
        self.column = column
        self.found = found
        self.expected = expected
        self.advice = advice
        self.causes = list(causes or [])
        self.result = result

    def __str__(self) -> str:
        text = ": ".join([self.message, *self.causes])
        return f"{text}\nWhat to do: {self.advice}" if self.advice else text

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self.message, self.__dict__.copy())


def _restored(kind: type[GyrocalError], message: str, fields: dict[str, Any]) -> GyrocalError:
    error = kind(message)
    error.__dict__.update(fields)
    return error


class InputError(GyrocalError, ValueError):
    """An argument, a file, a frame or one of its values is wrong.

    >>> import gyrocal
    >>> try:
    ...     gyrocal.simulate("examples/data/three_days.scenario.toml", seed=-1)
    ... except gyrocal.InputError as error:
    ...     print(error)
    seed: found -1, expected an integer of at least 0 and below 2^63
    """


class SetupError(InputError):
    """A gross error of the set-up leaves nothing sound; ``result`` tells which.

    >>> import gyrocal
    >>> record = gyrocal.Record.read("examples/data/three_days.csv")
    >>> metric = gyrocal.Record(record.time_s, 9.80665 * record.accel_g)
    >>> try:
    ...     gyrocal.calibrate(metric, "examples/data/three_days.bench.toml")
    ... except gyrocal.SetupError as error:
    ...     error.result.setup[0].kind
    'unit'
    """


class ComputationError(GyrocalError, RuntimeError):
    """The computation failed.

    >>> import gyrocal
    >>> issubclass(gyrocal.ComputationError, (gyrocal.GyrocalError, RuntimeError))
    True
    """


class GyrocalWarning(UserWarning):
    """What is to be known of a record before its result is used; the words are those of the command.

    >>> import gyrocal, warnings
    >>> warnings.simplefilter("always", gyrocal.GyrocalWarning)
    """


def refusal(place: str, found: str, expected: str, advice: str | None = None) -> InputError:
    """The error of a value other than expected; `place` is the argument, or the frame and its column."""
    return InputError(
        f"{place}: found {found}, expected {expected}", found=found, expected=expected, advice=advice
    )
