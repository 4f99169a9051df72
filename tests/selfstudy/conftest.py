"""A folder to study in."""

import pytest


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder, as the notebook's own."""
    folder = tmp_path / "notebooks"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder
