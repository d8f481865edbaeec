"""Command line of ballsocket: the table of its commands, each of which is imported when it is called."""

from .root import ENTRIES, CommandEntry, main

ENTRIES.update(  # in the order in which `ballsocket --help` lists them
    {
        "press": CommandEntry("ballsocket.cli.press", "Press a ball into its socket under one load."),
        "curve": CommandEntry("ballsocket.cli.press", "Press a joint in equal steps from zero to a load."),
        "film": CommandEntry("ballsocket.cli.film", "Compute the lubricating film between ball and socket."),
        "orient": CommandEntry("ballsocket.cli.orient", "Map edge distance and peak pressure over cup orientations."),
        "map": CommandEntry("ballsocket.cli.design", "Map the contact over two parameters of a joint."),
        "optimise": CommandEntry("ballsocket.cli.design", "Find the best joint within limits, for one goal or two."),
        "sensitivity": CommandEntry("ballsocket.cli.design", "Compute which parameter's scatter matters most."),
        "study": CommandEntry("ballsocket.cli.study", "Press a joint at every point of a study file."),
        "hip": CommandEntry("ballsocket.cli.hip", "Simulate wear of a hip over millions of gait cycles."),
        "planning": CommandEntry("ballsocket.cli.planning", "Read landmarks, liner, head and worn bore of a hip."),
        "models": CommandEntry("ballsocket.cli.lists", "List contact models with their ranges and sources."),
        "presets": CommandEntry("ballsocket.cli.lists", "List materials and joints by name, with their sources."),
        "cite": CommandEntry("ballsocket.cli.lists", "Print the BibTeX references of models, materials and joints."),
        "identify": CommandEntry("ballsocket.cli.identify", "Identify a joint or its wear coefficient from data."),
        "calibrate": CommandEntry("ballsocket.cli.identify", "Fit a foundation modulus to the exact solution."),
        "build-tables": CommandEntry(
            "ballsocket.cli.identify", "Build the tables of the model `tabulated`.", hidden=True
        ),
        "evidence": CommandEntry("ballsocket.cli.evidence", "Write or check an evidence pack for a computed number."),
        "deck": CommandEntry("ballsocket.cli.export", "Write a finite-element input file for CalculiX or Abaqus."),
        "fmu": CommandEntry("ballsocket.cli.export", "Write a joint as a functional mock-up unit (FMI)."),
        "export": CommandEntry("ballsocket.cli.export", "Write a joint as a force element for another program."),
        "schema": CommandEntry("ballsocket.cli.lists", "Print the JSON schema of a kind of input file."),
        "app": CommandEntry("ballsocket.cli.servers", "Open the explorer, an interactive page, in a browser."),
        "serve-mcp": CommandEntry("ballsocket.cli.servers", "Offer the commands to AI assistants (MCP)."),
        "reproduce": CommandEntry("ballsocket.cli.evidence", "Recompute the results of Heß & Forsbach 2021."),
    }
)

__all__ = ["main"]
