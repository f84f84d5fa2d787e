"""The examples in Python beside real runs."""

import os
import pathlib
import subprocess
import sys

import numpy as np

from support import Launched

EXAMPLES = pathlib.Path(__file__).resolve().parents[3] / "examples" / "python"


def run_example(name, *arguments):
    return subprocess.run(
        [sys.executable, str(EXAMPLES / name), *arguments], capture_output=True, text=True, timeout=180
    )


def test_joint_angles_are_driven_and_written(tmp_path):
    run = Launched(tmp_path, "case_study", "--pace", "2x")
    try:
        file = tmp_path / "joints.csv"
        done = run_example("drive_and_plot.py", "--seconds", "3", "--output", str(file))
        assert done.returncode == 0, done.stdout + done.stderr
        table = np.loadtxt(file, delimiter=",", skiprows=1)
        assert table.shape[1] == 1 + 23
        # Every tick of 20 ms is there, and the yaw joints undulate while the pitch joints stay straight.
        np.testing.assert_allclose(np.diff(table[:, 0]), 0.02, atol=1e-9)
        assert np.ptp(table[:, 1 + 10]) > 0.2 and np.ptp(table[:, 1 + 11]) < 0.1
    finally:
        run.end()


def test_the_planner_follows_the_line_to_its_end(tmp_path):
    run = Launched(tmp_path, "line", "--pace", "2x")
    try:
        done = run_example("line_planner.py", "--colour", "blue")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "follow_line succeeded" in done.stdout and "end_of_line" in done.stdout
        assert run_example("line_planner.py", "--run", "229").returncode == 70
        assert os.environ["XDG_RUNTIME_DIR"] == str(tmp_path)
    finally:
        run.end()
