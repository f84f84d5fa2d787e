#!/usr/bin/python3
"""Drives the robot through a curve and plots the angles of its joints.

    constrictor run --pace 1x                      # in another terminal
    python3 drive_and_plot.py --output joints.png  # needs python3-matplotlib; a name with .csv needs nothing
"""

import argparse
import sys

import numpy as np
from numpy.typing import NDArray

import constrictor


def drive(run: constrictor.Run, seconds: float) -> "tuple[NDArray[np.float64], NDArray[np.float64]]":
    """Drives half of the time straight ahead and half of it to the left.

    Returns the robot's time [s] of each sample, and the angles [rad] of the joints (samples x joints).
    """
    times_s, angles_rad = [], []
    samples = run.subscribe("joint_state", timeout=10)
    run.drive(0.6)
    turned = False
    for sample in samples:
        times_s.append(sample["header"]["time_ns"] * 1e-9)
        angles_rad.append(sample["position_rad"])
        driven_s = times_s[-1] - times_s[0]
        if not turned and driven_s > seconds / 2:
            run.drive(0.6, 0.5)
            turned = True
        if driven_s > seconds:
            run.stand()
            break
    return np.array(times_s), np.array(angles_rad)


def write(file: str, times_s: "NDArray[np.float64]", angles_rad: "NDArray[np.float64]") -> None:
    if file.endswith(".csv"):
        names = ",".join(["time_s"] + [f"joint_{joint}_rad" for joint in range(angles_rad.shape[1])])
        np.savetxt(file, np.column_stack([times_s, angles_rad]), delimiter=",", header=names, comments="")
        return
    import matplotlib

    matplotlib.use("Agg")  # draws into a file, also without a screen
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(10, 5))
    # Joints with an even number yaw; those with an odd number pitch and stay straight on flat ground.
    for joint in range(0, angles_rad.shape[1], 2):
        axes.plot(times_s - times_s[0], np.degrees(angles_rad[:, joint]), label=f"joint {joint}")
    axes.set_xlabel("time of the robot [s]")
    axes.set_ylabel("yaw angle [degrees], positive: left")
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.tight_layout()
    figure.savefig(file, dpi=120)


def main() -> int:
    parser = argparse.ArgumentParser(description="Drives the robot through a curve and plots its joint angles.")
    parser.add_argument("--run", type=int, help="DDS domain of the run (default: the only run on this host)")
    parser.add_argument("--seconds", type=float, default=6.0, help="how long to drive, in the robot's time")
    parser.add_argument("--output", default="joints.png", help="file to write, .png or .csv (default: joints.png)")
    arguments = parser.parse_args()
    try:
        with constrictor.join(arguments.run, name="drive_plot") as run:
            times_s, angles_rad = drive(run, arguments.seconds)
        write(arguments.output, times_s, angles_rad)
    except constrictor.Error as error:
        print(f"drive_and_plot: {error}", file=sys.stderr)
        return 70
    except ImportError as error:
        print(f"drive_and_plot: {error}; install python3-matplotlib, or name a file .csv", file=sys.stderr)
        return 70
    print(f"{len(times_s)} samples of {angles_rad.shape[1]} joints in {arguments.output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
