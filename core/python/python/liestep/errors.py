"""What can go wrong: one family of exceptions.

All are `liestep.Error`. Those of a text have its line and column, and advice where the message ends with some.
"""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """What this package raises.

    Attributes
    ----------
    message : str
        What is wrong, and what to write.
    line, column : int or None
        Where in the text, from one.
    run : liestep.Run or None
        What was recorded before a run stopped.
    """

    run: Any = None

    def __init__(self, message: str, line: int | None = None, column: int | None = None) -> None:
        super().__init__(message, line, column)
        self.message = message
        self.line = line
        self.column = column

    def __str__(self) -> str:
        return self.message

    @property
    def advice(self) -> str | None:
        """What to write instead, where the message says it behind a colon."""
        _, colon, advice = self.message.rpartition(": ")
        return advice if colon else None


class DeclarationError(Error, ValueError):
    """A text that declares nothing, or something that can't be stepped."""

    #: All mistakes: message, line, column. The exception itself is the first.
    mistakes: list[tuple[str, int, int]] = []

    @classmethod
    def of(cls, mistakes: list[tuple[str, int, int]]) -> DeclarationError:
        """The error of these mistakes, of which there is one at least."""
        message, line, column = mistakes[0]
        error = cls(message, line or None, column or None)
        error.mistakes = mistakes
        return error

    def __str__(self) -> str:
        place = f"line {self.line}, column {self.column}: " if self.line else ""
        more = f" (and {len(self.mistakes) - 1} more in `mistakes`)" if len(self.mistakes) > 1 else ""
        return f"{place}{self.message}{more}"


class SetupError(Error, ValueError):
    """Numbers or a method with which there is no motion."""


class CallError(Error, TypeError):
    """A call with arguments that the function doesn't have."""


class StepError(Error, ArithmeticError):
    """A step that has no solution; what was recorded before is the attribute `run`."""


class ColumnError(Error, KeyError):
    """A column or a quantity that a run doesn't have."""


class SceneError(Error, ValueError):
    """A mistake in a scene's file, or in its run."""


class StoreError(Error, OSError):
    """The files of an ensemble can't be written or read, or are those of another."""


class MemoryError(Error, ValueError):
    """A table that is larger than the memory."""
