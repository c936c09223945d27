"""Answers to look at."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Callable, Optional

from cloudtouch import _given

#: No frame is higher; a number in 32 bits.
MOST_PIXELS = 2**32 - 1


class Page:
    """Bodies and what was answered, as one HTML page: turned with the mouse, coloured by probability, with words.

    Made by :meth:`Query.page`, :meth:`Scene.page` and :meth:`RobotChecker.page`. Shown by a notebook where it is the last value of a cell; a file otherwise.
    """

    __slots__ = ("_render",)

    _render: Callable[[Optional[int]], str]

    def __init__(self, render: Callable[[int | None], str]) -> None:
        self._render = render

    @property
    def html(self) -> str:
        """The whole file; it needs no network."""
        return self._render(None)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the file, over what stood there."""
        if not isinstance(path, (str, os.PathLike)):
            raise TypeError(f"path is {_given.told(path)}: give the name of a file, a str")
        html, target = self.html, Path(path)
        # Beside it first: what stood there is not lost to a full disk.
        unfinished = target.with_name(target.name + ".partial")
        try:
            unfinished.write_text(html, encoding="utf-8")
            unfinished.replace(target)
        except BaseException as error:
            # The error that counts is the first.
            with contextlib.suppress(OSError):
                unfinished.unlink()
            if isinstance(error, OSError):
                raise OSError(error.errno, error.strerror, os.fspath(target)) from None
            raise

    def frame(self, height: int = 480) -> str:
        """A frame of so many pixels with the page in it, as a part of another page."""
        return self._render(_given.count(height, "height", MOST_PIXELS))

    def _repr_html_(self) -> str:
        return self.frame()
