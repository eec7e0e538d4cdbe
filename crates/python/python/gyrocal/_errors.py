"""Exceptions, with the fields of the errors of the library."""

from __future__ import annotations

from typing import Any

__all__ = ["ComputationError", "GyrocalError", "InputError", "SetupError"]


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
    """An argument, a file, a frame or one of its values is wrong."""


class SetupError(InputError):
    """A gross error of the set-up leaves nothing sound; ``result`` tells which."""


class ComputationError(GyrocalError, RuntimeError):
    """The computation failed."""
