"""The command `microtexture`.

Modules that take long to import are imported by the command that needs them, so that ``--help`` answers at once.
"""

import os
import sys


def main() -> None:
    """Entry point of the console script."""
    from app.cli.commands import application

    completing = "_MICROTEXTURE_COMPLETE" in os.environ
    application(with_method_options="synthesize" in sys.argv or completing)(prog_name="microtexture")
