"""Scans of the class on the desk: pictures that tell what is on them, and how they are sent."""

import json

import cv2
from scanned_class import as_picture, read_told
from site_people import TEACHER

from coursework.database.assignments import issued_content
from coursework.issuing.answer_papers import answer_papers
from coursework.site.frame import jobs


def told_by_pictures(monkeypatch):
    """Take what a picture tells for what is read on it, and read it in this process."""
    monkeypatch.setattr("coursework.scanning.pages.read_page", read_told)
    monkeypatch.setattr(jobs, "workers", lambda tasks: 1)


def picture(desk, student, **answers):
    """A scan of somebody's answer page."""
    with desk.site.store.reading() as connection:
        papers = answer_papers(issued_content(connection, desk.number))
    paper = next(p for p in papers.values() if p.student == student and p.size == "a4")
    code = paper.pages(desk.site.course)[0].code_text
    return as_png(json.dumps({"code": code, "answers": answers}).encode())


def as_png(data):
    return cv2.imencode(".png", as_picture(data))[1].tobytes()


def send(desk, *files, who=TEACHER):
    """Send files by their names to the desk."""
    browser = desk.browser(who)
    sent = [("scans", (name, data, "application/octet-stream")) for name, data in files]
    return browser.post(f"/desk/{desk.number}/scans", data={"_seal": browser.seal}, files=sent)
