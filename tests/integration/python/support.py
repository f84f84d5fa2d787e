"""What the tests of the Python package share: runs of their own, and the command `constrictor`."""

import os
import pathlib
import signal
import subprocess
import time

import constrictor

BIN = pathlib.Path(os.environ["CONSTRICTOR_BIN"])
COMMAND = str(BIN / "constrictor")


def eventually(condition, bound_s=20.0):
    """Waits until the condition holds; returns False if it does not within the bound."""
    end = time.monotonic() + bound_s
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def command(*arguments):
    """The output of `constrictor ...`, which must succeed."""
    done = subprocess.run([COMMAND, *arguments], capture_output=True, text=True, timeout=30)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Launched:
    """A run whose registry of runs is the folder, so that it meets no other run of this host."""

    def __init__(self, folder, *arguments):
        os.environ["XDG_RUNTIME_DIR"] = str(folder)
        os.environ.pop("CONSTRICTOR_DOMAIN", None)
        self.report = folder / "report"
        output = folder / "out"
        with output.open("w") as file:
            self.process = subprocess.Popen(
                [COMMAND, "run", *arguments, "--report", str(self.report)], stdout=file, stderr=subprocess.STDOUT
            )
        try:
            assert eventually(constrictor.runs), output.read_text()
            with constrictor.observe() as domain:
                domain.latest("joint_state", timeout=20)
        except BaseException:
            self.end()
            raise

    def end(self):
        """Ends the run in order; kills it if it does not end."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait(10)
            raise
