"""Role of a person in a course, from the roles that the platform states; an unknown role grants nothing."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

_MEMBER = "http://purl.imsglobal.org/vocab/lis/v2/membership"
_ABOVE = (
    "http://purl.imsglobal.org/vocab/lis/v2/institution/person",
    "http://purl.imsglobal.org/vocab/lis/v2/system/person",
)


class Role(StrEnum):
    """Role of a person in a course, which decides the permissions."""

    INSTRUCTOR = "instructor"  #: sees the class, picks what a link opens
    ASSISTANT = "assistant"  #: sees the class
    ADMIN = "admin"  #: of the course's platform: sees the class, picks
    STUDENT = "student"  #: answers
    OBSERVER = "observer"  #: sees a note that there is nothing to see
    NOBODY = "nobody"  #: the same, for a person without a known role

    @property
    def sees_class(self) -> bool:
        return self in (Role.INSTRUCTOR, Role.ASSISTANT, Role.ADMIN)

    @property
    def picks(self) -> bool:
        return self in (Role.INSTRUCTOR, Role.ADMIN)


#: Roles in the course, by their name after ``membership#``; the first one present counts. Moodle names no
#: assistant, and its observers are mentors.
_IN_COURSE = {
    "Administrator": Role.ADMIN,
    "Instructor": Role.INSTRUCTOR,
    "ContentDeveloper": Role.INSTRUCTOR,
    "Learner": Role.STUDENT,
    "Mentor": Role.OBSERVER,
    "Observer": Role.OBSERVER,
}
_ASSISTANTS = ("TeachingAssistant", "TeachingAssistantGroup", "TeachingAssistantSection", "Grader")


def role_of(stated: Iterable[str]) -> Role:
    """Return the role that a launch states.

    Roles in the course count. An administrator of the institution or the platform without a role in the
    course is an admin; a teacher or student of another course has no role here.
    """
    roles = list(stated)
    if any(role == f"{_MEMBER}/Instructor#{title}" for role in roles for title in _ASSISTANTS):
        return Role.ASSISTANT
    # A role of the course may be given by its short name.
    mine = {
        role.removeprefix(f"{_MEMBER}#") for role in roles if role.startswith(f"{_MEMBER}#") or role.isalpha()
    }
    if "Mentor" in mine and "Instructor" not in mine:
        return Role.OBSERVER
    for name, role in _IN_COURSE.items():
        if name in mine:
            return role
    of_course = any(role.startswith(_MEMBER) for role in roles) or mine
    above = any(role.startswith(_ABOVE) and role.endswith("#Administrator") for role in roles)
    return Role.ADMIN if above and not of_course else Role.NOBODY
