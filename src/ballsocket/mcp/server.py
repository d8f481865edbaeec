"""Server of the tools on standard input and output, with the official SDK of the Model Context Protocol."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mcp_types as types
from mcp.server.lowlevel import Server
from mcp.server.stdio import stdio_server

from ..core.executors.processes import available_cores
from ..version import __version__
from .call import command_line
from .run import CallResult, run
from .tools import TOOLS, Commands, schema

INSTRUCTIONS = (
    "Contact of a ball in a socket of nearly its own radius: hip implants, ball joints, pivots. Numbers are text with "
    "a unit ('16 mm', '3 kN', '1 GPa', '45 deg') or without a unit in mm, N, MPa, degrees. Every answer has 'valid' "
    "(the results are in the valid range of their models), 'error' (estimated relative errors), 'notes', 'sources' and "
    "'next': useful commands that may follow, whose options are the arguments of these tools."
)


@dataclass(frozen=True)
class ToolCalls:
    """Calls of tools; at most one runs per core.

    Parameters
    ----------
    folder : Path
        Folder of the files to read and write.
    longest : float
        Time limit of a call in seconds, without the time in the queue.
    commands : mapping
        Functions of the commands by name.
    program : sequence of str
        Arguments of Python that run a command, before its name.
    """

    folder: Path
    longest: float
    commands: Commands
    program: Sequence[str]
    _slots: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(available_cores()))

    async def call(self, name: str, arguments: Mapping[str, Any]) -> CallResult:
        """Call a tool, and return its answer or the reason of a refusal."""
        try:
            command = command_line(name, arguments, self.folder, self.commands)
        except (ValueError, OSError) as error:
            return CallResult(None, " ".join(str(error).split()))
        async with self._slots:
            return await run([*self.program, *command], self.folder, self.longest)


def server(folder: Path, longest: float, commands: Commands, program: Sequence[str]) -> Server[Any]:
    """Return a server of the tools; see `ToolCalls` for the parameters."""
    calls = ToolCalls(folder, longest, commands, program)

    async def list_tools(context: Any, request: Any) -> types.ListToolsResult:
        """Return the tools with their schemas."""
        return types.ListToolsResult(tools=[_tool(name, commands) for name in TOOLS])

    async def call_tool(context: Any, request: types.CallToolRequestParams) -> types.CallToolResult:
        """Call a tool."""
        return _tool_result(await calls.call(request.name, request.arguments or {}))

    return Server(
        "ballsocket", version=__version__, instructions=INSTRUCTIONS, on_list_tools=list_tools, on_call_tool=call_tool
    )


async def serve(folder: Path, longest: float, commands: Commands, program: Sequence[str]) -> None:
    """Serve the tools until standard input closes; see `ToolCalls` for the parameters."""
    tool_server = server(folder, longest, commands, program)
    async with stdio_server() as (requests, answers):
        await tool_server.run(requests, answers, tool_server.create_initialization_options())


def _tool(name: str, commands: Commands) -> types.Tool:
    """Return a tool in the types of the SDK."""
    tool = TOOLS[name]
    hints = types.ToolAnnotations(read_only_hint=not tool.writes, destructive_hint=False, open_world_hint=False)
    return types.Tool(name=name, description=tool.description, input_schema=schema(tool, commands), annotations=hints)


def _tool_result(result: CallResult) -> types.CallToolResult:
    """Return the result of a call in the types of the SDK."""
    texts = [result.refusal] if result.refusal else []
    texts += [json.dumps(result.answer, ensure_ascii=False)] if result.answer is not None else []
    return types.CallToolResult(
        content=[types.TextContent(type="text", text=text) for text in texts],
        structured_content=result.answer,
        is_error=bool(result.refusal),
    )
