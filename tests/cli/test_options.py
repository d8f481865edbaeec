"""Groups of options: dataclasses in the signature of a command, single options in its help."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from ballsocket.cli.options import expand_groups


@dataclass(frozen=True, kw_only=True)
class Pair:
    one: Annotated[str | None, typer.Option(help="The first of two")] = None
    other: Annotated[int, typer.Option("--second", min=1, help="The second of two")] = 2


@pytest.fixture
def called():
    """A command with a group between an argument and an option, and what it was called with."""
    app, calls = typer.Typer(rich_markup_mode=None), []

    @app.command()
    @expand_groups
    def both(
        *,
        name: Annotated[str, typer.Argument(help="Of it")],
        pair: Annotated[Pair, "here"],
        last: Annotated[bool, typer.Option(help="The last one")] = False,
    ) -> None:
        """What it does."""
        calls.append((name, pair, last))

    def call(*words: str) -> tuple[str, list[tuple[str, Pair, bool]]]:
        done = CliRunner().invoke(app, words, env={"COLUMNS": "100"})
        return done.output, calls

    return call


@pytest.mark.parametrize(
    ("words", "given"),
    [
        (("it",), ("it", Pair(), False)),
        (("--one", "1", "it", "--second", "3"), ("it", Pair(one="1", other=3), False)),
        (("--last", "--second", "3", "it"), ("it", Pair(other=3), True)),
    ],
)
def test_options_of_a_command_fill_the_group(called, words, given):
    assert called(*words)[1] == [given]


def test_help_shows_the_options_of_a_group_in_its_position(called):
    shown = called("--help")[0]
    texts = (
        "What it does.",
        "Of it",
        "--one",
        "here: the first of two",
        "--second",
        "here: the second of two",
        "--last",
    )
    places = [shown.index(text) for text in texts]
    assert places == sorted(places)


def test_options_of_a_group_have_their_limits(called):
    shown, calls = called("it", "--second", "0")
    assert "--second" in shown
    assert not calls
