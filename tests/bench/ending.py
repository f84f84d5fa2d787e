"""How the benchmarks in Python end a run that they have started."""
import signal
import subprocess


def end_in_order(run, patience_s):
    """Ends a launcher like Ctrl-C, with its report complete, and kills it if that takes longer than `patience_s`."""
    if run.poll() is None:
        run.send_signal(signal.SIGINT)
    try:
        run.wait(patience_s)
    except subprocess.TimeoutExpired:
        run.kill()
        run.wait()
