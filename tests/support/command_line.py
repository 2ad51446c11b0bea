"""The command as it is installed, and in this process."""

import subprocess
import sys
from pathlib import Path

from click.testing import CliRunner

from drake_haptics.cli import main

# Beside the interpreter.
COMMAND = Path(sys.executable).with_name("drake-haptics")


def call(*arguments, **options):
    """Runs the installed command to its end."""
    return subprocess.run(
        [str(word) for word in (COMMAND, *arguments)],
        **{"capture_output": True, "text": True, "timeout": 600} | options,
    )


def invoke(*arguments):
    """Runs the command in this process."""
    return CliRunner().invoke(main, [str(word) for word in arguments])
