#!/usr/bin/python3
"""Runs every command of examples/tutorial/README.md, in its order, against the installed package.

    tutorial_test.py README PREFIX

The commands are those of the blocks that begin with ```sh. They run in one shell, in an empty home folder in which
~/constrictor is the installed package. After a command that starts a run in the background, the test waits until the
run answers. It fails if a command fails.
"""

import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

BOUND_S = 1500
PREAMBLE = """set -euo pipefail
export PATH="$HOME/constrictor/bin:$PATH"
wait_for_run() {
  for _ in $(seq 600); do
    # Not a pipe to `grep -q`: it ends at the first match, and with pipefail the broken pipe counts as a failure.
    if [[ $(constrictor status --json 2>/dev/null) =~ '"tick": '[1-9] ]]; then return 0; fi
    sleep 0.2
  done
  echo "the run does not answer"; cat ./*.txt; return 1
}
"""


def blocks(page: str) -> list[tuple[int, str]]:
    """The blocks of commands with the number of their first line."""
    found = []
    for match in re.finditer(r"^```sh\n(.*?)^```$", page, re.MULTILINE | re.DOTALL):
        found.append((page.count("\n", 0, match.start()) + 2, match.group(1)))
    return found


def script(page: str) -> str:
    text = PREAMBLE
    for line, commands in blocks(page):
        text += f"echo '### line {line}'\n{commands}"
        if re.search(r"^constrictor run .*&$", commands, re.MULTILINE):
            text += "wait_for_run\n"
    return text + "echo '### the end'\n"


def main() -> int:
    readme, prefix = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    page = readme.read_text(encoding="utf-8")
    number = len(blocks(page))
    if number < 10:
        print(f"{readme}: found {number} blocks of commands, accepted at least 10: are they marked with sh?")
        return 1
    with tempfile.TemporaryDirectory() as home:
        folder = pathlib.Path(home) / "tutorial"
        folder.mkdir()
        (pathlib.Path(home) / "constrictor").symlink_to(prefix)
        environment = {**os.environ, "HOME": home, "XDG_RUNTIME_DIR": home}
        for name in ("CONSTRICTOR_DOMAIN", "CONSTRICTOR_DATA", "CONSTRICTOR_TOKEN_FILE", "CYCLONEDDS_URI"):
            environment.pop(name, None)
        log = pathlib.Path(home) / "output"
        # A file, not a pipe: programs in the background keep it open.
        with log.open("w", encoding="utf-8") as stream:
            shell = subprocess.Popen(
                ["bash", "-c", script(page)], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=stream,
                stderr=subprocess.STDOUT, start_new_session=True)
            try:
                shell.wait(timeout=BOUND_S)
            except subprocess.TimeoutExpired:
                print(f"not done after {BOUND_S} s")
            finally:
                # What is left in the background ends with the shell; a launcher takes its processes along.
                try:
                    os.killpg(shell.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
                shell.wait()
        output = log.read_text(encoding="utf-8", errors="replace")
        print(output)
        if shell.returncode != 0 or "### the end" not in output:
            for file in sorted(folder.glob("*.txt")):
                print(f"--- {file.name}\n{file.read_text(encoding='utf-8', errors='replace')}")
            print(f"the shell ended with {shell.returncode}")
            return 1
        touches = (folder / "fourth" / "logs" / "touch_log.log").read_text(encoding="utf-8")
        if not re.search(r"info touch_log tick \d+: module \d+ pushes with", touches):
            print(f"the component of one's own logged no touch:\n{touches}")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
