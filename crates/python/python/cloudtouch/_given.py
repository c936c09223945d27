"""Single values that users give, as the compiled half takes them; it does not know their names."""

from __future__ import annotations

from typing import Any

import numpy as np


def number(value: Any, name: str) -> float:
    """A real number."""
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {_told(value)}: give a number") from None


def optional_number(value: Any, name: str) -> float | None:
    """A real number, or none."""
    return None if value is None else number(value, name)


def count(value: Any, name: str) -> int:
    """A whole number that is not negative."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and value >= 0:
        return int(value)
    raise TypeError(f"{name} is {_told(value)}: give a whole number, 0 or more")


def flag(value: Any, name: str) -> bool:
    """Yes or no."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise TypeError(f"{name} is {_told(value)}: give True or False")


def count_and_number(value: Any, name: str) -> tuple[int, float] | None:
    """A pair of both, or none."""
    if value is None:
        return None
    try:
        first, second = value
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {_told(value)}: give two numbers, such as (8, 3.0)") from None
    return count(first, f"{name}[0]"), number(second, f"{name}[1]")


def _told(value: Any) -> str:
    return f"{value!r}" if isinstance(value, (str, bytes, bool, int, float)) else f"of the type {type(value).__name__}"
