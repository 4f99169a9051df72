"""A text in which variables alone stand is filled in as the template engine would."""

import jinja2
from tables import each_row

from coursework.course.texts import _Filled

VALUES = {"r1": "228,6 mm", "n": 3, "none_of_it": "x"}
FILLED = [
    "{{ r1 }}",
    "a {{r1}} b {{  n }}\n",
    "# {{ n }}\n\n$\\frac{1}{2}$ {{ none_of_it }}\n",
    "{ {{ n }} }",
]
OTHER = [
    "{{ r1 | upper }}",
    "{{ n + 1 }}",
    "{{- n }}",
    "{% if n %}a{% endif %}",
    "{# note #}{{ n }}",
    "{{{ n }}}",
    "{{ true }}",
    "{{ None }}",
    "{{ n }} {{ 'x' }}",
    "{{ n",
]


@each_row("text", FILLED)
def test_a_text_of_variables_is_filled_in_as_the_engine_does(text):
    assert _Filled.fits(text)
    environment = jinja2.Environment(keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
    assert _Filled(text).render(VALUES) == environment.from_string(text).render(VALUES)


@each_row("text", OTHER)
def test_any_other_text_is_left_to_the_engine(text):
    assert not _Filled.fits(text)


def test_every_statement_that_is_filled_in_reads_as_the_engine_has_it(course):
    environment = jinja2.Environment(keep_trailing_newline=True, undefined=jinja2.StrictUndefined)
    filled = 0
    for name in course.names:
        variant = course[name].variant(1)
        for lang in course[name].languages:
            text = course[name].texts.file("exercises", lang).read_text("utf-8-sig")
            if _Filled.fits(text):
                filled += 1
                values = variant.in_language(lang).printed
                assert _Filled(text).render(values) == environment.from_string(text).render(values)
    assert filled
