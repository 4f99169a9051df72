"""Somebody who practises with plain forms: what they type, and what the page then says."""

import re
from html import unescape

from coursework.kinds.choices import cases_of

BOX = "a-"  #: before the names of boxes


def right_answer(variant, part):
    """A right answer as a box takes it."""
    value = variant.key.reference[part.quantity]
    if part.choices and part.sort.box == "several":
        return ", ".join(variant.letters(part)[case] for case in sorted(cases_of(value)))
    if part.choices:
        return variant.letters(part)[str(value)]
    return next(s.answer for s in part.sort.spellings(part, value, str) if isinstance(s.answer, str))


def words_of(html):
    """The text of a piece of a page."""
    text = re.sub(r"<(script|style|select).*?</\1>", "", html, flags=re.DOTALL)
    return " ".join(unescape(re.sub(r"<[^>]+>", " ", text)).split())


class Practising:
    """A variant of an exercise in somebody's browser."""

    def __init__(self, class_, browser, exercise):
        self.class_, self.browser = class_, browser
        self.address = browser.get(f"/practice/{exercise}").headers["location"]
        self.seal = browser.seal
        self.variant = class_.site.variant(exercise, int(self.address.rpartition("/")[2]), "en")

    def page(self):
        return self.browser.get(self.address).text

    def send(self, typed=(), below="", **fields):
        """A form as a browser sends it, and the page that it leads to; what stands in its hidden fields comes
        from the page."""
        versions = unescape(re.search(r'name="versions" value="([^"]*)"', self.page())[1])
        boxes = {BOX + name: text for name, text in dict(typed).items()}
        data = {"_seal": self.seal, "versions": versions, **boxes, **fields}
        reply = self.browser.post(self.address + below, data=data)
        return self.browser.get(reply.headers["location"]) if reply.status_code == 303 else reply

    def told(self, html, part):
        """What is said of an answer."""
        found = re.search(rf'<div id="told-{BOX}{part}".*?</div>', html, re.DOTALL)
        return words_of(found[0])

    def box(self, html, part):
        """What stands in a box of words."""
        found = re.search(
            rf'<input type="text" id="answer-{BOX}{part}"[^>]*?(?: value="([^"]*)")? inputmode', html
        )
        return unescape(found[1] or "")
