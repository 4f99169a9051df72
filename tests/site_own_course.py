"""A class whose course is a folder of its own, with one mechanism, for tests of pages that write into it."""

from site_people import HOME, Class

from coursework import open_course
from coursework.authoring.linkage_files import new_linkage
from coursework.site.application import application
from coursework.site.frame.settings import Site


class OwnCourse(Class):
    """A class whose course is a folder of its own, with one mechanism; ``folder`` is that of its
    exercises."""

    def __init__(self, folder):
        new_linkage(folder / "course", "toggle", "toggle", ["fr", "en"])
        super().__init__(f"sqlite:///{folder}/site.db")
        course = open_course(folder / "course")
        self.site = Site(course, self.site.store, self.site.entrance, HOME, lambda: self.at)
        self.app = application(self.site)
        self.folder = folder / "course" / "exercises"
