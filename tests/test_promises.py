"""What is promised to stay is there: names, parameters, units, commands, options, keys of files and of JSON."""

from .data.make_promised import missing, present, promised


def test_what_is_promised_is_there():
    assert missing(promised(), present()) == []


def test_a_promise_that_is_broken_is_named():
    now = present()
    now["units"]["force"] = "kN"
    now["commands"]["press"].remove("--json")
    del now["parameters"]["Joint"]
    assert sorted(missing(promised(), now)) == [
        "commands: press: --json",
        "parameters: Joint",
        "units: force: 'N', now 'kN'",
    ]
