"""What the package promises to keep, as it is now: `python tests/data/make_promised.py` writes `promised.json`.

Run when something is added that is to stay. What would go is named, and not taken out: that is for a new major version.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from enum import EnumType
from inspect import signature
from pathlib import Path
from typing import Any

import typer

import ballsocket as bs
from ballsocket.cli.json_answers import add_provenance
from ballsocket.cli.root import app, load_commands
from ballsocket.core.quantities import QUANTITIES
from ballsocket.files.schema import Table
from ballsocket.files.schema_keys import keys_of
from ballsocket.mcp.tools import file_table

PROMISED = Path(__file__).with_name("promised.json")
LOAD = {"force": 3000.0}
FILES = {"joint": "joint file", "study": "study file", "hip": "hip file", "identify": "file of data"}
FILES["evidence"] = "question of evidence"


def main() -> None:
    now = present()
    gone = missing(promised(), now)
    if gone:
        sys.exit("promised, and not there:\n" + "\n".join(gone))
    PROMISED.write_text(json.dumps(now, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")


def promised() -> dict[str, Any]:
    return json.loads(PROMISED.read_text(encoding="utf-8"))


def present() -> dict[str, Any]:
    """Names, parameters, units, commands and their options, keys of JSON and of joint files, statuses."""
    hip = bs.joints["hip-36"]
    answer = bs.compare(hip, **LOAD).summary()
    things = {name: getattr(bs, name) for name in bs.__all__}
    tilted = bs.Sphere(ring_width=0.1).press(hip, tilt=0.5, **LOAD)
    return {
        "names of ballsocket": sorted(bs.__all__),
        "names of ballsocket.hip": sorted(bs.hip.__all__),
        "parameters": {
            name: _parameters(thing)
            for name, thing in sorted(things.items())
            if callable(thing) and not isinstance(thing, EnumType)  # theirs are Python's, and differ by its version
        },
        "models": sorted([*bs.catalogue, "fem", "sphere"]),
        "presets": {"joints": sorted(bs.joints), "materials": sorted(bs.materials)},
        "units": {each.name: each.unit for each in QUANTITIES.values()},
        "statuses": {status.name: int(status) for status in bs.Status},
        "commands": _commands(),
        "keys of files": {title: _keys(file_table(kind)) for kind, title in FILES.items()},
        "keys of JSON": {
            "of every command": sorted(add_provenance({}, ())),
            "of an answer": sorted(answer),
            "of a joint": sorted(answer["joint"]),
            "of a contact": sorted(answer["results"][0]),
            "of a tilted contact": sorted(tilted.to_dict()),
        },
    }


def _keys(table: type[Table]) -> dict[str, list[str]]:
    """Return the keys of a kind of file by the names of its tables, and the tables at its top."""
    keys = defaultdict(set, top=set(table.__struct_encode_fields__))
    for key in keys_of(table):
        keys[key.table.strip("[]") or "top"].add(key.name)
    return {name: sorted(names) for name, names in keys.items()}


def _parameters(thing: Any) -> list[str]:
    try:
        return sorted(name for name in signature(thing).parameters if not name.startswith("_"))
    except ValueError:
        return []


def _commands() -> dict[str, list[str]]:
    load_commands()
    group = typer.main.get_command(app)
    return {
        name: sorted(option for parameter in command.params for option in parameter.opts if option.startswith("--"))
        for name, command in group.commands.items()  # type: ignore[attr-defined]
    }


def missing(said: Any, now: Any, path: str = "") -> list[str]:
    """What is promised and is not so, each by the path to it."""
    if isinstance(said, dict):
        lost = [f"{path}{key}" for key in said if key not in now]
        return lost + [each for key in said if key in now for each in missing(said[key], now[key], f"{path}{key}: ")]
    if isinstance(said, list):
        return [f"{path}{one}" for one in said if one not in now]
    return [] if said == now else [f"{path}{said!r}, now {now!r}"]


if __name__ == "__main__":
    main()
