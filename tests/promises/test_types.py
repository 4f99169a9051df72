"""The types that the package states agree. As a test the check shares the processors with the others."""

import subprocess
import sys
from pathlib import Path


def test_the_types_of_the_package_agree():
    done = subprocess.run(
        [sys.executable, "-m", "mypy"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
