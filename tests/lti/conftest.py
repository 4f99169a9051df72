"""A tool on a platform of one's own."""

import pytest
from lti_platform import Tool


@pytest.fixture
def tool(tmp_path, course):
    return Tool(tmp_path / "lti", course)


@pytest.fixture
def visitor(tool):
    return tool.visitor()
