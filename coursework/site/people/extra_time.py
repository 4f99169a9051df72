"""Extra time of people, by which every working time is longer for them; set for several people at once."""

from __future__ import annotations

from fractions import Fraction

from starlette.responses import Response

from coursework.database.people import people, set_extra_time
from coursework.database.permissions import Permission
from coursework.issuing.exam_columns import extra_time_of
from coursework.language.numbers import localise
from coursework.site.frame.requests import HTTPException, Request, Route
from coursework.site.frame.responses import redirect

_LARGEST = 4  #: denominator of a share that is written as a fraction


def extra_time_text(share: float | None, lang: str) -> str:
    """Return a share of extra time as ``+ 1/3`` or ``+ 15 %``; empty for none."""
    if not share:
        return ""
    fraction = Fraction(share).limit_denominator(_LARGEST)
    if abs(float(fraction) - share) < 1e-6:
        return f"+ {fraction}"
    return f"+ {localise(f'{100 * share:.4g}', lang)} %"


def change_extra_time(request: Request) -> Response:
    """Set the extra time of the ticked people.

    Raises
    ------
    BadInput
        The text is not a share.
    HTTPException
        Nobody is ticked.
    """
    share = extra_time_of({"extra_time": request.form.text("extra_time")})
    wanted = set(request.form.texts.get("person", ()))
    with request.site.store.begin() as connection:
        chosen = [person.id for person in people(connection) if str(person.id) in wanted]
        if not chosen:
            raise HTTPException("nobody_ticked", 422)
        set_extra_time(connection, chosen, float(share))
        request.note(connection, "extra time", people=chosen, share=str(share))
    if request.form.text("back") == "person":
        return redirect(f"/desk/people/{chosen[0]}")
    return redirect("/desk/people")


ROUTES = (
    Route(
        "/desk/people/extra-time", change_extra_time, Permission.PEOPLE_ADD, takes_forms=True, has_page=False
    ),
)
