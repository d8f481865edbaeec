"""The command `ballsocket` for tests, called here: without the second that a process takes to start."""

import json
import os
import re
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from subprocess import CompletedProcess
from unittest import mock

from ballsocket.cli import main


def run(*words: str, columns: int = 100, encoding: str = "utf-8", folder: Path | None = None) -> CompletedProcess[str]:
    """What `ballsocket WORDS` returns and prints."""
    out, err = (TextIOWrapper(BytesIO(), encoding=encoding, write_through=True) for _ in range(2))
    status = 0
    with (
        chdir(folder or Path()),
        mock.patch.dict(os.environ, {"COLUMNS": str(columns), "PYTHONIOENCODING": encoding}),
        mock.patch.object(sys, "argv", ["ballsocket", *words]),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        try:
            main()
        except SystemExit as ended:
            status = int(ended.code or 0)
    said, complained = (stream.buffer.getvalue().decode() for stream in (out, err))
    return CompletedProcess(words, status, said, complained)


def printed(*words: str, columns: int = 100, folder: Path | None = None) -> str:
    """What a command prints that succeeds without a message."""
    done = run(*words, columns=columns, folder=folder)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def answer(*words: str, folder: Path | None = None) -> dict:
    """The JSON that a command prints."""
    done = run(*words, "--json", folder=folder)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def refusal(*words: str, folder: Path | None = None) -> str:
    """The line that refuses words of a command, which prints nothing else."""
    done = run(*words, folder=folder)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert re.fullmatch("ballsocket: .*\n", done.stderr)
    return done.stderr
