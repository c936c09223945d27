"""Equality of answers to the bit, NaN beside NaN; times apart."""

import dataclasses

import numpy as np


def assert_same_report(one, other):
    for field in dataclasses.fields(one):
        if field.name != "seconds":
            _assert_same(getattr(one, field.name), getattr(other, field.name), field.name)


def assert_same_batch(one, other):
    for name, column in one.columns().items():
        if name != "seconds":
            np.testing.assert_array_equal(column, getattr(other, name), err_msg=name)


def _assert_same(one, other, name):
    if isinstance(one, tuple):
        assert len(one) == len(other), name
        for a, b in zip(one, other):
            _assert_same(a, b, name)
    elif isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other, err_msg=name)
    else:
        assert one == other, name
