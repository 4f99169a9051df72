"""What stands in for the reading of pictures, where it is not what is tried."""

import pytest
from scanned_class import read_told


@pytest.fixture
def pages_are_told(monkeypatch):
    """Pictures tell what is written on them."""
    monkeypatch.setattr("coursework.scanning.pages.read_page", read_told)
