"""Commands as tools for AI assistants, with the official SDK of the Model Context Protocol.

`tools` lists the tools with their arguments; `call` runs one of them in a process with limits. The SDK is optional, and
imported when a server starts.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..version import __version__

if TYPE_CHECKING:
    import mcp_types as types
    from mcp.server.lowlevel import Server

    from .tools import Commands

INSTRUCTIONS = (
    "Contact of a ball in a socket of nearly its own radius: hip implants, ball joints, pivots. Numbers are text with "
    "a unit ('16 mm', '3 kN', '1 GPa', '45 deg') or without a unit in mm, N, MPa, degrees. Every answer has 'valid' "
    "(the results are in the valid range of their models), 'error' (estimated relative errors), 'notes', 'sources' and "
    "'next': useful commands that may follow, whose options are the arguments of these tools."
)


def make_server(folder: Path, longest: float, commands: Commands, program: Sequence[str]) -> Server[Any]:
    """Return a server of the tools; see `ToolCalls` for the parameters."""
    import mcp_types as types
    from mcp.server.lowlevel import Server

    from .call import ToolCalls
    from .tools import TOOLS, schema

    calls = ToolCalls(folder, longest, commands, program)

    async def list_tools(context: Any, request: Any) -> types.ListToolsResult:
        tools = []
        for name, tool in TOOLS.items():
            hints = types.ToolAnnotations(read_only_hint=not tool.writes, destructive_hint=False, open_world_hint=False)
            described = {"description": tool.description, "input_schema": schema(tool, commands)}
            tools.append(types.Tool(name=name, **described, annotations=hints))
        return types.ListToolsResult(tools=tools)

    async def call_tool(context: Any, request: types.CallToolRequestParams) -> types.CallToolResult:
        result = await calls.call(request.name, request.arguments or {})
        texts = [result.refusal] if result.refusal else []
        texts += [json.dumps(result.answer, ensure_ascii=False)] if result.answer is not None else []
        return types.CallToolResult(
            content=[types.TextContent(type="text", text=text) for text in texts],
            structured_content=result.answer,
            is_error=bool(result.refusal),
        )

    return Server(
        "ballsocket", version=__version__, instructions=INSTRUCTIONS, on_list_tools=list_tools, on_call_tool=call_tool
    )


async def serve(folder: Path, longest: float, commands: Commands, program: Sequence[str]) -> None:
    """Serve the tools until standard input closes; see `ToolCalls` for the parameters."""
    from mcp.server.stdio import stdio_server

    tool_server = make_server(folder, longest, commands, program)
    async with stdio_server() as (requests, answers):
        await tool_server.run(requests, answers, tool_server.create_initialization_options())
