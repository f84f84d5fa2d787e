"""What options of the benchmarks in Python accept."""
import argparse


def whole(least, most=None, step=1):
    """The type of an option: whole numbers of at least `least`, at most `most`, that are multiples of `step`."""
    accepted = f"a whole number from {least}"
    if most is not None:
        accepted += f" to {most}"
    if step > 1:
        accepted += f", a multiple of {step}"

    def parse(text):
        number = int(text) if text.isdigit() else -1
        if number < least or (most is not None and number > most) or number % step != 0:
            raise argparse.ArgumentTypeError(f"found '{text}', accepted {accepted}")
        return number
    return parse
