"""Single values that users give, as the compiled half takes them; it does not know their names."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

Kind = TypeVar("Kind")


def number(value: Any, name: str) -> float:
    """A real number."""
    try:
        # True would be 1.
        if isinstance(value, (str, bytes, bool, np.bool_)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} is {told(value)}: give a number") from None


def optional_number(value: Any, name: str) -> float | None:
    """A real number, or none."""
    return None if value is None else number(value, name)


def count(value: Any, name: str, most: int = sys.maxsize) -> int:
    """A whole number that is not negative."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and value >= 0:
        if value > most:
            raise ValueError(f"{name} is {told(value)}: give at most {most}")
        return int(value)
    raise TypeError(f"{name} is {told(value)}: give a whole number, 0 or more")


def text(value: Any, name: str) -> str:
    """A name."""
    if isinstance(value, str):
        return value
    raise TypeError(f"{name} is {told(value)}: give a str")


def folder(value: Any, name: str) -> Path:
    """The path of a folder."""
    if isinstance(value, (str, os.PathLike)):
        return Path(value)
    raise TypeError(f"{name} is {told(value)}: give the path of a folder, a str")


def file(value: Any, name: str) -> str | os.PathLike[str]:
    """The path of a file."""
    if isinstance(value, bytes):
        return os.fsdecode(value)
    if isinstance(value, (str, os.PathLike)):
        return value
    raise TypeError(f"{name} is {told(value)}: give the path of a file, a str")


def folders(value: Any, name: str) -> list[tuple[str, str | os.PathLike[str]]]:
    """Folders by name; none where they are not given."""
    if value is None:
        return []
    if not isinstance(value, Mapping):
        raise TypeError(f'{name} is {told(value)}: give folders by name, such as {{"my_robot": "/opt/my_robot"}}')
    return [(text(key, f"a name of {name}"), folder(of, f"{name}[{key!r}]")) for key, of in value.items()]


def flag(value: Any, name: str) -> bool:
    """Yes or no."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise TypeError(f"{name} is {told(value)}: give True or False")


def count_and_number(value: Any, name: str) -> tuple[int, float] | None:
    """A pair of both, or none."""
    if value is None:
        return None
    try:
        first, second = value
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {told(value)}: give two numbers, such as (8, 3.0)") from None
    return count(first, f"{name}[0]"), number(second, f"{name}[1]")


def told(value: Any) -> str:
    """It, or its type where it may be long."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, int) and value.bit_length() > 64:
        return f"a whole number of {value.bit_length()} bits"
    is_short = value is None or isinstance(value, (str, bytes, bool, int, float))
    return f"{value!r}" if is_short else f"of the type {type(value).__name__}"


def same_kind(value: Kind) -> Kind:
    """An object of the class of another, with what a class derived from the package's has put there."""
    other = object.__new__(type(value))
    if hasattr(other, "__dict__"):
        other.__dict__.update(vars(value))
    return other
