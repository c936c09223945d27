"""Arrays that know their unit (pint, astropy, unyt), which they lose as plain ones."""

import types

import numpy as np
import pytest
from conftest import lifted, sheet

import cloudtouch as ct


class Quantity(np.ndarray):
    """As astropy's: an array that has a unit."""

    unit = None


def of(values, unit):
    quantity = np.asarray(values).view(Quantity)
    quantity.unit = unit
    return quantity


@pytest.mark.parametrize("unit", ["mm", "cm", "inch", "deg"])
def test_a_unit_that_is_no_metre_was_dropped(unit, floor, plate):
    """Millimetres were metres, without a word where sizes allow it."""
    with pytest.raises(ValueError, match=f"points is in {unit}: give plain numbers"):
        ct.Cloud(of(sheet(), unit), sensor="iso:0.001")
    with pytest.raises(ValueError, match=f"pose is in {unit}"):
        ct.Query().run(floor, plate, of(lifted(0.1), unit))
    depth = of(np.full((4, 4), 0.8), unit)
    with pytest.raises(ValueError, match=f"depth is in {unit}"):
        ct.Cloud.from_depth(depth, (4, 4, 1.5, 1.5), sensor="iso:0.001")


def test_a_quantity_of_pint_tells_its_unit():
    quantity = types.SimpleNamespace(magnitude=sheet(), units="millimeter")
    with pytest.raises(ValueError, match="points is in millimeter"):
        ct.Cloud(quantity, sensor="iso:0.001")


@pytest.mark.parametrize("unit", ["m", "meter", "rad", "", None])
def test_units_of_the_package_are_taken(unit):
    points = sheet()
    cloud = ct.Cloud(of(points, unit), sensor="iso:0.001")
    np.testing.assert_array_equal(cloud.points, ct.Cloud(points, sensor="iso:0.001").points)
