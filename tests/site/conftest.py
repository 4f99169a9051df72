import pytest
from argon2 import PasswordHasher
from site_people import Class

from coursework.site.people import passwords


@pytest.fixture
def class_of_three(tmp_path):
    return Class(f"sqlite:///{tmp_path}/site.db")


@pytest.fixture(scope="session", autouse=True)
def strong_hasher():
    """What hashes passwords; in these tests another does, which takes less of a processor than a page."""
    strong = passwords._HASHER
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(passwords, "_HASHER", PasswordHasher(time_cost=1, memory_cost=16, parallelism=1))
        passwords._of_nobody.cache_clear()
        yield strong
