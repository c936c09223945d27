"""Tables on an engine's workers: the same bits as here, whatever becomes of a worker."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from test_checker import HEIGHTS, root, table, whole

import cloudtouch as ct

EXAMPLES = Path(__file__).parents[1] / "examples"

#: Fixtures of another file.
__all__ = ["root", "whole"]


def write_poses(folder, rows, parts):
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    folder.mkdir()
    for number, places in enumerate(np.array_split(np.arange(len(rows["id"])), parts)):
        columns = {name: rows[name][places].tolist() for name in rows}
        parquet.write_table(pyarrow.table(columns), folder / f"{number}.parquet")


def read_answers(folder):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    answers = parquet.read_table(folder).sort_by("id").to_pydict()
    return answers


def assert_told(answers, whole):
    assert answers["id"] == whole["id"].tolist()
    for name in ("probability", "lower", "upper", "clearance_at_least"):
        np.testing.assert_array_equal(np.array(answers[name], dtype=float), whole[name], err_msg=name)
    assert answers["verdict"] == whole["verdict"].tolist()


@pytest.fixture(scope="module")
def cluster():
    ray = pytest.importorskip("ray", reason="ray is not installed: pip install 'ray[data]'")
    # With fewer, readers and workers starve one another.
    ray.init(num_cpus=4, include_dashboard=False, logging_level="error")
    yield ray
    ray.shutdown()


@pytest.mark.parametrize(("parts", "workers"), [(1, 1), (3, 2), (7, 3)])
def test_ray_answers_the_same_bits(cluster, tmp_path, root, whole, parts, workers):
    sys.path.insert(0, str(EXAMPLES))
    from label_with_ray import label

    write_poses(tmp_path / "poses", table(), parts)
    label(str(tmp_path / "poses"), str(root), str(tmp_path / "answers"), sensor="iso:0.001", workers=workers)
    assert_told(read_answers(tmp_path / "answers"), whole)


class Dying(ct.PoseChecker):
    """Takes its worker down the first time that it meets a certain row."""

    def __call__(self, rows):
        mark = Path(os.environ["CLOUDTOUCH_MARK"])
        if 11 in rows["id"].tolist() and not mark.exists():
            mark.touch()
            os._exit(1)
        return super().__call__(rows)


def test_a_killed_worker_costs_nothing(cluster, tmp_path, root, whole):
    ray, mark = cluster, tmp_path / "killed"
    write_poses(tmp_path / "poses", table(), 5)
    ray.data.read_parquet(str(tmp_path / "poses")).map_batches(
        Dying,
        fn_constructor_args=(str(root),),
        fn_constructor_kwargs={"sensor": "iso:0.001"},
        batch_size=4,
        num_cpus=1,
        runtime_env={"env_vars": {"CLOUDTOUCH_MARK": str(mark), "PYTHONPATH": str(Path(__file__).parent)}},
        compute=ray.data.ActorPoolStrategy(size=2),
    ).write_parquet(str(tmp_path / "answers"))
    assert mark.exists(), "no worker was killed"
    assert_told(read_answers(tmp_path / "answers"), whole)


def test_dask_answers_the_same_bits(tmp_path, root, whole):
    pytest.importorskip("dask", reason="dask is not installed: pip install dask pandas pyarrow")
    write_poses(tmp_path / "poses", table(), len(HEIGHTS))
    text = (EXAMPLES / "label_with_dask.py").read_text().replace('sensor="kinect"', 'sensor="iso:0.001"')
    (tmp_path / "label.py").write_text(text)
    names = [str(tmp_path / "poses"), str(root), str(tmp_path / "answers")]
    subprocess.run([sys.executable, "label.py", *names], cwd=tmp_path, check=True)
    assert_told(read_answers(tmp_path / "answers"), whole)
