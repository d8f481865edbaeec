"""Promised names, parameters, units, commands, options, and keys of files and of JSON."""

from .data.make_promised import missing, present, promised


def test_all_promised_names_exist():
    assert missing(promised(), present()) == []


def test_broken_promises_are_named():
    now = present()
    now["units"]["force"] = "kN"
    now["commands"]["press"].remove("--json")
    del now["parameters"]["Joint"]
    gone = ["commands: press: --json", "parameters: Joint", "units: force: 'N', now 'kN'"]
    assert sorted(missing(promised(), now)) == gone
