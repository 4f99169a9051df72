"""Records that a later version wrote are not read as if they were of this one."""

import pytest
from tables import each_row

from coursework.errors import BadInput
from coursework.issuing.issued import ISSUED_FORMAT, Issued


@each_row(
    ("more", "told"), [(0, "not an issued record"), (1, r"^issued\.json was written by a later version")]
)
def test_a_later_format_is_told(more, told):
    with pytest.raises(BadInput, match=told):
        Issued({"format": ISSUED_FORMAT + more, "issued": [{}]}, "issued.json")
