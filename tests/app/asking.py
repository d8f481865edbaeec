"""What a browser says to a page, and what it is answered, without a browser."""

import json
from base64 import b64decode


def does(page, what, **words):
    """Somebody does something on a page; the message with which it answers."""
    last = json.loads(page.channel.ears.value or '{"n": 0}')["n"]
    page.channel.ears.value = json.dumps({"n": last + 1, "do": what, **words})
    answer = json.loads(page.channel.mouth.value)
    assert answer["n"] == last + 1
    return answer


def edits(page, name, value):
    return does(page, "edit", name=name, value=value)


def saved(page, kind):
    return b64decode(does(page, "save", kind=kind)["file"]["content"])


def trouble(page):
    return page.channel.told("#trouble") or ""
