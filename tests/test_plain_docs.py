"""Pages and examples in plain English: no words of a dialect, no sentences over 30 words."""

import pytest

from . import plain_text
from .places import ROOT
from .rooms import shown


@pytest.mark.parametrize("path", plain_text.files(), ids=shown)
def test_pages_and_examples_are_in_plain_english(path):
    """See `plain_text` for the rules; `python -m tests.plain_text PAGE` prints the findings."""
    result = plain_text.findings(path)
    assert not result, "\n".join(map(str, result))


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("page.md", "# Title\n\nThe page says\nso much.\n", [(3, "dialect", "says"), (4, "dialect", "so much")]),
        ("page.md", "- short\n- " + 31 * "word " + "\n", [(2, "long sentence", "31 words")]),
        ("page.md", 20 * "word " + "end.\n" + 20 * "word " + "end; next.\n", []),
        ("page.md", "```python\nsaid = told\n```\n`asked` and [link](told.md), $whom$\n", []),
        ("page.md", "$$\n" + 40 * "x " + "\n$$\n\n$$ said $$\n\nHe asks.\n", [(7, "dialect", "asks")]),
        ("page.md", "| a | b |\n|---|---|\n| " + 20 * "w " + "|" + 20 * "w " + "|\n", []),
        ("page.md", "```{include} told\n```\n\n:::{note}\nHe said it.\n:::\n", [(5, "dialect", "said")]),
        ("page.rst", "Title\n=====\n\n.. code::\n\n   he said\n\nIt tells.\n", [(8, "dialect", "tells")]),
        (
            "page.py",
            '"""A title.\n\nIt asks.\n"""\n\n# it\n# asks\nx = 1\n',
            [(3, "dialect", "asks"), (7, "dialect", "asks")],
        ),
        ("page.toml", "key = 1 # said\n# in a gap\n", [(1, "dialect", "said")]),
    ],
)
def test_findings_have_their_line(tmp_path, name, text, expected):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    result = plain_text.findings(path)
    assert [(finding.line, finding.rule) for finding in result] == [(line, rule) for line, rule, _ in expected]
    assert all(words in finding.text for finding, (_, _, words) in zip(result, expected, strict=True))


def test_every_page_of_the_repository_is_measured():
    names = {shown(path) for path in plain_text.files()}
    assert {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/index.md", "examples/press_a_hip.py"} <= names
    assert all((ROOT / name).is_file() for name in names)
