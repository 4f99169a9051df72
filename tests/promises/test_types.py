"""The types that the package states agree."""

import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.e2e
def test_the_types_of_the_package_agree():
    done = subprocess.run(
        [sys.executable, "-m", "mypy"],
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
