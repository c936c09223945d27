"""The numbers are those of the command-line tool, which is the Rust library, to the bit."""

import json
import os
import subprocess

import numpy as np
import pytest
from cloudtouch.demo import table_top
from conftest import sheet

import cloudtouch as ct

TOOL = os.environ.get("CLOUDTOUCH_TOOL")


def poses():
    generator = np.random.default_rng(2011)
    for height in np.linspace(-0.02, 0.05, 29):
        turn, _ = np.linalg.qr(np.eye(3) + 0.05 * generator.normal(size=(3, 3)))
        pose = np.eye(4)
        pose[:3, :3] = turn * np.sign(np.diag(turn))
        pose[:3, 3] = *generator.uniform(-0.02, 0.02, size=2), height
        yield pose


def write_points(path, points):
    path.write_text("".join(" ".join(repr(float(v)) for v in point) + "\n" for point in points))


@pytest.mark.skipif(TOOL is None, reason="CLOUDTOUCH_TOOL does not name the cloudtouch command of this build")
def test_the_tool_and_the_package_tell_the_same_bits(tmp_path):
    vertices, triangles = table_top()
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += ["f " + " ".join(str(i + 1) for i in triangle) for triangle in triangles.tolist()]
    (tmp_path / "table.obj").write_text("\n".join(lines) + "\n")
    scene, plate = sheet(seed=1).astype(np.float32), sheet(seed=2)
    write_points(tmp_path / "scene.xyz", scene)
    write_points(tmp_path / "plate.xyz", plate)

    bodies = {
        "scene.xyz": ct.Cloud(scene, sensor="iso:0.001"),
        "table.obj": ct.Mesh(vertices, triangles),
    }
    other = ct.Cloud(plate, sensor="lidar:0.002,0.001", min_range=0.0)
    cases = [
        {
            "id": f"{name} {index}",
            "scene": name,
            "object": "plate.xyz",
            "pose": pose.tolist(),
            "scene_sensor": "iso:0.001",
            "object_sensor": "lidar:0.002,0.001",
        }
        for name in bodies
        for index, pose in enumerate(poses())
    ]
    (tmp_path / "cases.json").write_text(json.dumps({"format": 1, "length_unit": "m", "cases": cases}))
    command = [TOOL, "batch", str(tmp_path / "cases.json"), "--json", "--refine", "no", "--min-range", "0"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    told = {answer["id"]: answer for answer in map(json.loads, run.stdout.splitlines())}
    assert len(told) == len(cases)

    verdicts = set()
    for name, body in bodies.items():
        for index, pose in enumerate(poses()):
            report, rust = ct.Query().run(body, other, pose), told[f"{name} {index}"]
            assert report.probability == rust["collision_probability"]
            assert list(report.bounds) == rust["bounds"]
            assert report.verdict == rust["verdict"]
            assert report.undecided_by == rust["undecided_by"]
            assert report.log_likelihood_ratio == rust["log_likelihood_ratio"]
            assert report.clearance_at_least == rust["clearance_at_least_m"]
            clearance = rust["clearance_m"]
            if clearance is None:
                assert report.clearance is None
            else:
                ours = (report.clearance, report.clearance_std, report.clearance_is_bound)
                assert ours == (clearance["mean"], clearance["std"], clearance["is_bound"])
            assert list(report.evidence) == [rust["evidence"][field] for field in report.evidence._fields]
            assert list(report.warnings) == [warning["words"] for warning in rust["warnings"]]
            assert len(report.contacts) == len(rust["contacts"])
            for contact, theirs in zip(report.contacts, rust["contacts"]):
                assert contact.point.tolist() == theirs["point"]
                assert contact.normal.tolist() == theirs["normal_a_to_b"]
                numbers = (contact.probability, contact.clearance, contact.area)
                assert numbers == (theirs["probability"], theirs["clearance_m"], theirs["area_m2"])
            verdicts.add(report.verdict)
    assert verdicts >= {"free", "uncertain", "in_collision"}
