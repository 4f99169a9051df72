"""Refusals of the service: the key of a message, and a detail for the log."""

from __future__ import annotations

from coursework.errors import CourseworkError


class LTIRefusal(CourseworkError, PermissionError):
    """Refusal of a request.

    ``why`` is the key of the sentence in ``[lti.refused]`` of each language; ``detail`` is for the log only
    and contains neither answers nor tokens. ``again`` has the parameters to repeat the login in a new window,
    ``wait`` the seconds until another attempt.
    """

    def __init__(
        self,
        why: str,
        status: int = 400,
        detail: str = "",
        again: dict[str, str] | None = None,
        wait: int = 0,
    ):
        super().__init__(f"{why}: {detail}" if detail else why)
        self.why, self.status, self.detail, self.again, self.wait = why, status, detail, again, wait
