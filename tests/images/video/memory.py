"""What a piece of work costs a process of its own."""

import subprocess
import sys

from app.settings import ROOT

PEAK = """
def peak():
    # Not getrusage's, which begins with that of the process that started this one.
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith("VmHWM"))
"""


def printed(script: str, *arguments: object) -> int:
    """The number that a script, in which ``peak()`` are the most bytes its process ever held, prints."""
    command = [sys.executable, "-c", PEAK + script, *map(str, arguments)]
    return int(subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout)
