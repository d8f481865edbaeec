"""Pages from templates: every text is escaped, and a missing value is an error."""

import pytest
from jinja2 import UndefinedError

from ballsocket.reports import pages

UNSAFE = "<script>alert('&')</script>"
SAFE = "&lt;script&gt;alert(&#39;&amp;&#39;)&lt;/script&gt;"


@pytest.mark.parametrize(
    "html",
    [
        pages.table([UNSAFE], [], ""),
        pages.table(["head"], [[UNSAFE]], "text"),
        pages.items([UNSAFE]),
        pages.items([], UNSAFE),
        pages.picture(b"", UNSAFE),
        pages.picture(b"", "title", UNSAFE),
        pages.render_page("page.html", UNSAFE, {}),
        pages.render_page("page.html", "title", {"one": (UNSAFE, "")}),
        pages.render_part("press.html", "lede", UNSAFE, "3 N", "exact", ("verdict", "holds"), []),
        pages.render_part("press.html", "lede", "3 MPa", "3 N", "exact", (UNSAFE, "holds"), []),
        pages.render_part("press.html", "answers", [((UNSAFE,), ())], ()),
        pages.render_part("press.html", "answers", (), (UNSAFE,)),
        pages.render_part("press.html", "origin", UNSAFE, "", ""),
        pages.render_part("press.html", "design", "", [(UNSAFE, "")]),
        pages.render_page("joint_report.html", "title", {}, lede="", logo="", details=[("customer", UNSAFE)]),
    ],
)
def test_texts_are_escaped(html):
    assert SAFE in html
    assert "<script" not in html


def test_html_of_a_section_is_not_escaped_again_and_a_missing_value_is_an_error():
    assert "<p>5 &lt; 6</p>" in pages.render_page("page.html", "title", {"one": ("One", "<p>5 &lt; 6</p>")})
    with pytest.raises(UndefinedError):
        pages.render_page("joint_report.html", "title", {"origin": ("Origin", "")})
    with pytest.raises(UndefinedError, match="unknown"):
        pages.render_page("page.html", "title", {"unknown": ("Section without HTML or block", None)})
