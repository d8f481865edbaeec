"""The tools by the Model Context Protocol, on standard input and output, with the official SDK."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mcp_types as types
from mcp.server.lowlevel import Server
from mcp.server.stdio import stdio_server

from ...core.executors.processes import available_cores
from ...version import __version__
from .call import words_of
from .run import Told, run
from .schema import schema
from .table import TOOLS

INSTRUCTIONS = (
    "Contact of a ball in a socket of nearly its own radius: hip implants, ball joints, pivots. Numbers are text with "
    "a unit ('16 mm', '3 kN', '1 GPa', '45 deg') or bare in mm, N, MPa, degrees. Every answer has 'valid' (may it be "
    "trusted), 'error' (estimated relative errors), 'notes', 'sources' and 'next': commands that may follow, whose "
    "options are the arguments of these tools."
)


@dataclass(frozen=True)
class Calls:
    """Calls of tools, as many at once as there are cores.

    Parameters
    ----------
    folder : Path
        Where files are read and written.
    longest : float
        Seconds that a call may take, when its turn has come.
    """

    folder: Path
    longest: float
    _places: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(available_cores()))

    async def call(self, name: str, arguments: Mapping[str, Any]) -> Told:
        """What a tool answers, or the sentence why it does not."""
        try:
            words = words_of(name, arguments, self.folder)
        except (ValueError, OSError) as error:
            return Told(None, " ".join(str(error).split()))
        async with self._places:
            return await run(words, self.folder, self.longest)


def server(folder: Path, longest: float) -> Server[Any]:
    """The server of the tools."""
    calls = Calls(folder, longest)

    async def listed(context: Any, asked: Any) -> types.ListToolsResult:
        return types.ListToolsResult(tools=[_tool(name) for name in TOOLS])

    async def called(context: Any, asked: types.CallToolRequestParams) -> types.CallToolResult:
        return _result(await calls.call(asked.name, asked.arguments or {}))

    return Server(
        "ballsocket", version=__version__, instructions=INSTRUCTIONS, on_list_tools=listed, on_call_tool=called
    )


async def serve(folder: Path, longest: float) -> None:
    """Answer until nobody asks any more."""
    made = server(folder, longest)
    async with stdio_server() as (asked, answered):
        await made.run(asked, answered, made.create_initialization_options())


def _tool(name: str) -> types.Tool:
    tool = TOOLS[name]
    hints = types.ToolAnnotations(read_only_hint=not tool.writes, destructive_hint=False, open_world_hint=False)
    return types.Tool(name=name, description=tool.what, input_schema=schema(tool), annotations=hints)


def _result(told: Told) -> types.CallToolResult:
    texts = [told.refusal] if told.refusal else []
    texts += [json.dumps(told.answer, ensure_ascii=False)] if told.answer is not None else []
    return types.CallToolResult(
        content=[types.TextContent(type="text", text=text) for text in texts],
        structured_content=told.answer,
        is_error=bool(told.refusal),
    )
