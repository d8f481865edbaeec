"""What a browser says to a page, and what it is answered, without a browser."""

import json
from base64 import b64decode


def does(page, what, **words):
    """Somebody does something on a page; the messages with which it answers, as one."""
    last, answer = json.loads(page.channel.inbox.value or '{"n": 0}')["n"], {}

    def hear(attribute, old, new):
        answer.update(json.loads(new))

    page.channel.outbox.on_change("value", hear)
    page.channel.inbox.value = json.dumps({"n": last + 1, "do": what, **words})
    page.channel.outbox.remove_on_change("value", hear)
    assert answer["n"] == last + 1
    return answer


def edits(page, name, value):
    return does(page, "edit", name=name, value=value)


def saved(page, kind):
    return b64decode(does(page, "save", kind=kind)["file"]["content"])


def trouble(page):
    return page.channel.shown_value("#trouble") or ""
