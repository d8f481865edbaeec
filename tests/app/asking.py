"""Requests of a browser to a page, and its answers, without a browser."""

import json
from base64 import b64decode
from html import escape

from ballsocket.app.session import Page


def opened(link):
    """A page as a browser has it after loading."""
    page = Page(link)
    page._refresh()
    return page


def does(page, what, **words):
    """Send one request to a page; return its messages as one."""
    number, answer = page.channel.number + 1, {}
    page.channel.write = lambda text: answer.update(json.loads(text))
    page.channel.receive({"n": number, "do": what, **words})
    assert answer["n"] == number
    return answer


def edits(page, name, value):
    return does(page, "edit", name=name, value=value)


def saved(page, kind):
    return b64decode(does(page, "save", kind=kind)["file"]["content"])


def trouble(page):
    """Return what a page says is wrong: at the top of the answers, or beside its inputs."""
    errors = [f"<p>{escape(refusal['error'])}</p>" for _, refusal in page.channel._refused.values()]
    return "".join([page.channel.shown_value("#trouble") or "", *errors])


def told(page, name):
    """Return a part of a page, such as "wear-numbers"; empty before it is shown."""
    return page.channel.shown_value(f"#{name}") or ""
