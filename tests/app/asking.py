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


def changed(value, changes):
    """Return a value of a page after the changes of a message, as a browser does."""
    if isinstance(changes, list):
        return changes[0]
    inside = {key: changed(value[key if isinstance(value, dict) else int(key)], part) for key, part in changes.items()}
    if isinstance(value, dict):
        return {**value, **inside}
    return [inside.get(str(index), part) for index, part in enumerate(value)]


def read_message(text, shown):
    """Read a message of the server, with the values after its changes of those that the page has `shown`."""
    message = json.loads(text)
    message |= {name: changed(shown[name], part) for name, part in message.pop("changes", {}).items()}
    shown.update(message)
    return message


def does(page, what, **words):
    """Send one request to a page; return its messages as one."""
    number, answer, shown = page.channel.number + 1, {}, dict(page.channel._sent)
    page.channel.write = lambda text: answer.update(read_message(text, shown))
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
    """Return a part of a page as text, such as "wear-numbers"; empty before it is shown."""
    content = page.channel.shown_value(f"#{name}") or ""
    return content if isinstance(content, str) else json.dumps(content, ensure_ascii=False)


def blocks(page, name, kind):
    """Return the blocks of a kind in a part of a page, such as the "charts" of "press-charts"."""
    content = page.channel.shown_value(f"#{name}")
    return [block for block in content if isinstance(block, dict) and block["kind"] == kind]


def numbers(page, name):
    """Return the values of the numbers in a part of a page by their names."""
    rows = [row for block in blocks(page, name, "numbers") for row in block["rows"]]
    return {key: value for key, _, _, _, _, value, _ in rows if value is not None}


def cells(page, name):
    """Return the texts of the first table in a part of a page, with its heads."""
    table = blocks(page, name, "table")[0]
    rows = [table["heads"], *(row["cells"] if isinstance(row, dict) else row for row in table["rows"])]
    return [[cell if isinstance(cell, str) else cell[0] for cell in row] for row in rows]
