"""A site with a platform in front."""

import pytest
from site_linked import Linked


@pytest.fixture
def tool(tmp_path):
    return Linked(tmp_path)


@pytest.fixture
def visitor(tool):
    return tool.visitor()
