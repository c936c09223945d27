"""Points in tables of pandas beside columns that are no numbers, and with numbers that may be missing."""

import numpy as np
import pandas as pd
import pytest
from conftest import sheet

import cloudtouch as ct


def read(table):
    return ct.Cloud(table, sensor="iso:0.001").points


def table(points, **others):
    return pd.DataFrame(points, columns=["x", "y", "z"]).assign(**others)


@pytest.mark.parametrize("other", ["table", True, pd.Timestamp("2026-11-29"), None])
def test_columns_that_are_no_numbers_made_those_of_the_points_unreadable(other):
    points = sheet()
    np.testing.assert_array_equal(read(table(points, other=other)), read(points))


def test_single_precision_stays_beside_them():
    points = sheet().astype(np.float32)
    np.testing.assert_array_equal(read(table(points, label="table")), read(points))


def test_numbers_that_may_be_missing_are_missing_returns():
    points = sheet()
    nullable = table(points).convert_dtypes()
    np.testing.assert_array_equal(read(nullable), read(points))
    nullable.loc[3, "y"] = pd.NA
    np.testing.assert_array_equal(read(nullable), read(np.delete(points, 3, axis=0)))


def test_a_name_of_two_columns_was_the_last_of_them():
    twice = pd.DataFrame(np.hstack([sheet(), sheet(1.0)]), columns=["x", "y", "z"] * 2)
    with pytest.raises(ValueError, match="points has the column x twice"):
        read(twice)


def test_words_in_a_column_of_points_are_told_by_its_name():
    words = table(sheet()).assign(y="0.1")
    with pytest.raises(ValueError, match=r"points\['y'\] has the type"):
        read(words)
