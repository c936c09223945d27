"""Paths, uncertain poses and intervals."""

import numpy as np
import pytest
from conftest import lifted
from same import assert_same_report

import cloudtouch as ct


def tilted(height):
    """Lifted by so much, m, and tilted by 40 degrees."""
    c, s = np.cos(0.7), np.sin(0.7)
    pose = lifted(height)
    pose[1:3, 1:3] = [[c, -s], [s, c]]
    return pose


def test_nothing_between_two_free_poses_is_missed(floor, plate):
    query = ct.Query()
    ends = np.stack([tilted(0.05), tilted(-0.3)])
    assert [query.run(floor, plate, pose).verdict for pose in ends] == ["free", "free"]
    swept = query.sweep(floor, plate, ends)
    assert swept.verdict == "in_collision" and swept.first is not None
    assert swept.first_not_before <= swept.first.share and swept.certified_free_until <= swept.first.share
    assert swept.bounds[1] == 1.0 and swept.probability > 0.9
    # The pose went through a quaternion.
    again = query.run(floor, plate, swept.first.pose)
    assert abs(again.probability - swept.first.report.probability) < 1e-6
    assert repr(swept).startswith("<Swept: in_collision, P = ")


def test_a_free_path_is_free_all_the_way(floor, plate):
    swept = ct.Query().sweep(floor, plate, [lifted(0.06), lifted(0.1), lifted(0.05)], tolerance=0.05)
    assert (swept.verdict, swept.first, swept.certified_free_until) == ("free", None, 1.0)
    assert swept.upper < 0.1


def test_a_screw_is_another_way(floor, plate):
    ends = [tilted(0.1), lifted(0.1)]
    straight, screw = (ct.Query().sweep(floor, plate, ends, screw=screw) for screw in (False, True))
    assert straight.most_probable.pose.shape == screw.most_probable.pose.shape == (4, 4)
    on = ct.Query().sweep(floor, plate, [*ends, lifted(0.2)], screw=True)
    assert on.verdict == screw.verdict


def test_half_a_turn_is_warned_of(floor, plate):
    turned = lifted(0.1)
    turned[:2, :2] *= -1
    swept = ct.Query().sweep(floor, plate, [lifted(0.2), lifted(0.1), turned])
    (warning,) = swept.warnings
    assert warning.startswith("from pose 2 to the next it turns by half a turn")


def test_paths_that_are_none(floor, plate):
    for poses, words in [
        ([lifted(0.1)], "give at least two"),
        ([lifted(0.1), lifted(0.1)], "are the same"),
        ([lifted(0.1), np.full((4, 4), np.nan)], r"poses\[1\]"),
    ]:
        with pytest.raises(ct.CloudtouchError, match=words):
            ct.Query().sweep(floor, plate, poses)
    with pytest.raises(ct.CloudtouchError, match="tolerance"):
        ct.Query().sweep(floor, plate, [lifted(0.1), lifted(0.2)], tolerance=0)


def test_a_pose_known_to_the_bit_is_the_plain_answer(floor, plate):
    report, under = ct.Query().run_uncertain(floor, plate, lifted(0.004), np.zeros((6, 6)))
    assert_same_report(report, ct.Query().run(floor, plate, lifted(0.004)))
    assert (under.probability, under.poses) == (report.probability, 1)


def test_a_pose_known_roughly_is_in_doubt(floor, plate):
    # As far off as it is known: two deviations off, P hangs on one of 29 poses.
    report, under = ct.Query().run_uncertain(floor, plate, lifted(0.01), [0.01, 0.01, 0.01, 0, 0, 0])
    assert report.probability < 0.001 < 0.005 < under.probability < 0.1
    assert under.lower <= under.probability <= under.upper and under.poses in (7, 23, 26, 29)
    with pytest.raises(ct.CloudtouchError, match="covariance"):
        ct.Query().run_uncertain(floor, plate, lifted(0.02), -np.eye(6))
    with pytest.raises(ValueError, match="-1.0 is negative"):
        ct.Query().run_uncertain(floor, plate, lifted(0.02), [0.01, 0, -1, 0, 0, 0])
    with pytest.raises(ValueError, match="in degrees"):
        ct.Query().run_uncertain(floor, plate, lifted(0.02), [0.01, 0, 0, 5, 5, 5])
    with pytest.raises(ValueError, match="covariance has the shape"):
        ct.Query().run_uncertain(floor, plate, lifted(0.02), [0.01])


def test_an_interval_is_that_of_the_margins(floor, plate):
    query = ct.Query()
    interval = query.clearance_interval(floor, plate, lifted(0.03), 0.8)
    found = [query.within(floor, plate, lifted(0.03), margin)[1].probability for margin in interval]
    assert np.allclose(found, [0.1, 0.9], atol=0.01)
    with pytest.raises(ct.CloudtouchError, match="share"):
        ct.Query().clearance_interval(floor, plate, lifted(0.03), 1.5)
