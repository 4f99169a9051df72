import pytest
from site_people import Class


@pytest.fixture
def class_of_three(tmp_path):
    return Class(f"sqlite:///{tmp_path}/site.db")
