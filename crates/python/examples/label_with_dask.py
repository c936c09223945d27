"""The same with Dask: python label_with_dask.py POSES SCANS ANSWERS. Needs ``pip install dask pandas pyarrow``."""

import sys
from pathlib import Path

import dask
import pandas as pd

import cloudtouch as ct

poses, scans, answers = map(Path, sys.argv[1:4])
checker = ct.PoseChecker(scans, sensor="kinect")


@dask.delayed
def label(file: Path) -> None:
    """A file of the table, and one of answers."""
    part = pd.read_parquet(file)
    told = checker({name: part[name].to_numpy() for name in part.columns})
    pd.DataFrame({name: list(column) for name, column in told.items()}).to_parquet(answers / file.name)


if __name__ == "__main__":
    answers.mkdir()
    dask.compute(*map(label, sorted(poses.glob("*.parquet"))))
