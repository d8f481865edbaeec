"""Graph of the imports inside the package, read from its syntax trees; nothing is imported.

`python -m tests.import_graph hip cup.py` prints the figures of these rooms; without names, of all rooms.

An edge leads from a module to each module it needs:

- every `import` and `from ... import`, at the top, inside a function and under `if TYPE_CHECKING` alike;
- `import_module("...")` and `__import__("...")`, also relative to a package and through a constant of the module;
- every string that is the full path of a module of the package, as in `python -m`, except a name of a logger.

A door is the `__init__.py` of a directory. A name that a door imports from elsewhere counts as an import of the door
*and* of the module the name comes from. A module that is imported through its package counts as itself alone. The doors
that Python runs on the way to a module do not count: otherwise every module would be in a circle with its door.

Importers of a module are the modules that lead to it, doors left out. A module that only doors import is an entry point
of the package, and has none. Floors of a room are the modules on its longest chain of imports, doors left out.
"""

import ast
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

from .rooms import PACKAGE, room_of, rooms, shown, tree_of

PLAIN, TYPES, LAZY, STRING = "import", "for types", "in a function", "by a string"
"""Kinds of edges."""


@dataclass(frozen=True)
class Edge:
    """One import: where it is written, and how."""

    source: str
    target: str
    line: int
    kind: str


@dataclass
class Graph:
    """Modules of a package by dotted names without the package's own, and the imports between them."""

    root: Path
    paths: dict[str, Path] = field(default_factory=dict)
    edges: dict[str, dict[str, Edge]] = field(default_factory=dict)
    unknown: dict[str, list[str]] = field(default_factory=dict)

    def room(self, module):
        """Return the room of a module, such as `hip`, or `cup.py` for one directly in the package."""
        return room_of(self.paths[module], self.root)

    def modules(self, room):
        """Return the modules of a room without its doors."""
        return sorted(name for name in self.paths if self.room(name) == room and not self.is_door(name))

    def rooms(self):
        """Return the names of all rooms."""
        return sorted({self.room(name) for name in self.paths})

    def is_door(self, module):
        """Return True for the `__init__.py` of a directory."""
        return self.paths[module].name == "__init__.py"

    def line(self, edge):
        """Return an import as a line of text that begins with its file and line."""
        return (
            f"{shown(self.paths[edge.source])}:{edge.line}: {edge.source or 'the door'} -> {edge.target} ({edge.kind})"
        )

    def importers(self, module):
        """Return the modules that import a module, doors left out."""
        return sorted(name for name, targets in self.edges.items() if module in targets and not self.is_door(name))

    def doors_of(self, module):
        """Return the doors that import a module."""
        return sorted(name for name, targets in self.edges.items() if module in targets and self.is_door(name))

    def single_importers(self, room):
        """Return the modules of a room with exactly one importer, with that importer."""
        users = {module: self.importers(module) for module in self.modules(room)}
        return {module: names[0] for module, names in users.items() if len(names) == 1}

    def without(self, pairs):
        """Return the graph without some edges, pairs of source and target."""
        edges = {
            name: {target: edge for target, edge in targets.items() if (name, target) not in pairs}
            for name, targets in self.edges.items()
        }
        return Graph(self.root, self.paths, edges, self.unknown)

    def circles(self):
        """Return the groups of modules that import each other, directly or through others."""
        return [sorted(group) for group in components(self.edges) if len(group) > 1]

    def circles_of_rooms(self):
        """Return the groups of rooms that import each other."""
        neighbours = {room: set() for room in self.rooms()}
        for name, targets in self.edges.items():
            neighbours[self.room(name)] |= {self.room(target) for target in targets} - {self.room(name)}
        return [sorted(group) for group in components(neighbours) if len(group) > 1]

    def shortest_circle(self, group):
        """Return the imports of the shortest circle among some modules, as lines of text."""
        ways = [way for start in group if (way := self._way_back(start, group))]
        return [self.line(edge) for edge in min(ways, key=len)]

    def _way_back(self, start, group):
        reached, level = {start: []}, [start]
        while level:
            following = []
            for name in level:
                for target, edge in self.edges[name].items():
                    if target == start:
                        return [*reached[name], edge]
                    if target in group and target not in reached:
                        reached[target] = [*reached[name], edge]
                        following.append(target)
            level = following
        return []

    def longest_chain(self, room):
        """Return the longest chain of modules of a room that import one another, doors left out."""
        modules = set(self.modules(room))
        neighbours = {name: [target for target in self.edges[name] if target in modules] for name in modules}
        best: dict[str, list[str]] = {}
        for group in components(neighbours):  # a module comes after all that it imports
            below = [best[target] for name in group for target in neighbours[name] if target in best]
            chain = [*sorted(group), *max(below, key=len, default=[])]
            best |= dict.fromkeys(group, chain)
        return max(best.values(), key=len, default=[])


def components(neighbours):
    """Return the strongly connected components of a graph, each after all that it leads to (Tarjan 1972)."""
    index, low, stack, done = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(neighbours[node]):
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            position = stack.index(node)
            done.append(stack[position:])
            del stack[position:]

    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(limit, 20 * len(neighbours) + limit))
    try:
        for node in sorted(neighbours):
            if node not in index:
                visit(node)
    finally:
        sys.setrecursionlimit(limit)
    return done


def graph_of(root=PACKAGE):
    """Read the graph of a package."""
    graph = Graph(Path(root))
    for path in sorted(graph.root.rglob("*.py")):
        parts = path.relative_to(graph.root).with_suffix("").parts
        graph.paths[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    for name in graph.paths:
        reader = _Reader(graph, name)
        reader.visit(tree_of(graph.paths[name]))
        graph.edges[name] = reader.edges
        if reader.unknown:
            graph.unknown[name] = reader.unknown
    return graph


class _Reader(ast.NodeVisitor):
    """Imports of one module."""

    def __init__(self, graph, module):
        self.graph, self.module = graph, module
        self.package = module if graph.is_door(module) else module.rpartition(".")[0]
        self.prefix = graph.root.name
        self.edges, self.unknown, self.kind = {}, [], PLAIN

    def add(self, target, line, kind=None):
        if target is not None and target != self.module:
            self.edges.setdefault(target, Edge(self.module, target, line, kind or self.kind))

    def inside(self, kind, nodes):
        before, self.kind = self.kind, self.kind if self.kind == TYPES else kind
        for node in nodes:
            self.visit(node)
        self.kind = before

    def visit_If(self, node):
        if re.fullmatch(r"(\w+\.)?TYPE_CHECKING", ast.unparse(node.test)):
            self.inside(TYPES, node.body)
            self.inside(self.kind, node.orelse)
        else:
            self.generic_visit(node)

    def visit_FunctionDef(self, node):
        self.inside(self.kind, node.decorator_list)
        self.inside(self.kind, [node.args])
        self.inside(LAZY, node.body)

    def visit_AsyncFunctionDef(self, node):
        self.visit_FunctionDef(node)

    def visit_Import(self, node):
        for name in node.names:
            if name.name.split(".")[0] == self.prefix:
                self.add(self.known(name.name), node.lineno)

    def visit_ImportFrom(self, node):
        source = self.source_of(node, self.package)
        for name in node.names if source is not None else ():
            for target in self.origins(source, name.name):
                self.add(target, node.lineno)

    def source_of(self, node, package):
        """Return the module that a `from` names, None where it is of another package."""
        if node.level:
            parts = package.split(".") if package else []
            parts = parts[: len(parts) - node.level + 1]
            return ".".join([*parts, *([node.module] if node.module else [])])
        return self.known(node.module) if node.module and node.module.split(".")[0] == self.prefix else None

    def origins(self, source, name):
        """Return the modules that an imported name needs: its module, or the door and where the door has it from."""
        if source not in self.graph.paths:
            return []
        if not self.graph.is_door(source):
            return [source]
        inner = f"{source}.{name}".strip(".")
        if name in (bound := self.bound(source)):
            origins = self.origins(*bound[name])
            return origins if origins == [inner] else [source, *origins]
        if inner in self.graph.paths:
            return [inner]
        starred = [target for pair in bound.values() for target in self.origins(*pair)] if name == "*" else []
        return [source, *starred]

    def bound(self, door):
        """Return the names that a door imports, with the module and the name each comes from."""
        pairs = {}
        for node in ast.walk(tree_of(self.graph.paths[door])):
            if isinstance(node, ast.ImportFrom) and (origin := self.source_of(node, door)) not in (None, door):
                pairs |= {name.asname or name.name: (origin, name.name) for name in node.names}
        return pairs

    def visit_Call(self, node):
        called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if called in ("import_module", "__import__") and node.args:
            self.by_name(node)
        if called != "getLogger":
            self.generic_visit(node)

    def by_name(self, node):
        """Add what `import_module` imports."""
        argument = node.args[0]
        if isinstance(argument, ast.Name):
            argument = self.constant(argument.id) or argument
        if not (isinstance(argument, ast.Constant) and isinstance(argument.value, str)):
            text = f"{shown(self.graph.paths[self.module])}:{node.lineno}: {ast.unparse(node)}"
            self.unknown.append(text)
        elif argument.value.startswith("."):
            level = len(argument.value) - len(argument.value.lstrip("."))
            relative = ast.ImportFrom(module=argument.value[level:] or None, names=[], level=level)
            anchor = node.args[1] if len(node.args) > 1 else None
            stated = isinstance(anchor, ast.Constant) and isinstance(anchor.value, str)
            package = anchor.value.partition(".")[2] if stated else self.package
            self.add(self.existing(self.source_of(relative, package)), node.lineno, STRING)
        elif argument.value.split(".")[0] == self.prefix:
            self.add(self.known(argument.value), node.lineno, STRING)

    def constant(self, name):
        """Return the constant that a name of the module stands for."""
        for node in ast.walk(tree_of(self.graph.paths[self.module])):
            targets = node.targets if isinstance(node, ast.Assign) else []
            if any(isinstance(target, ast.Name) and target.id == name for target in targets):
                return node.value
        return None

    def visit_Constant(self, node):
        if isinstance(node.value, str) and re.fullmatch(rf"{self.prefix}(\.\w+)+", node.value):
            self.add(self.existing(node.value.partition(".")[2]), node.lineno, STRING)

    def existing(self, name):
        return name if name in self.graph.paths else None

    def known(self, dotted):
        """Return the module of a full dotted name, or the nearest package about it."""
        name = dotted.partition(".")[2]
        while name and name not in self.graph.paths:
            name = name.rpartition(".")[0]
        return name


OLD_PATHS = "core.deprecation"
"""Module with the new paths of moved modules as text; it imports one only where a user gives its old path."""


def without_old_paths(graph):
    """Return the graph without the paths of moved modules that are text in one module."""
    return graph.without({(OLD_PATHS, target) for target in graph.edges[OLD_PATHS]})


def main(words):
    """Print the figures of some rooms."""
    graph = without_old_paths(graph_of())
    for room in words or rooms():
        modules, single, chain = graph.modules(room), graph.single_importers(room), graph.longest_chain(room)
        entries = [name for name in modules if not graph.importers(name)]
        print(
            f"{room}: {len(modules)} modules, {len(single)} with one importer "
            f"({100 * len(single) / max(len(modules), 1):.0f} %), {len(entries)} without, {len(chain)} floors"
        )
        if words:
            print(*(f"  one importer: {name} <- {user}" for name, user in single.items()), sep="\n")
            print("  no importer but doors: " + ", ".join(entries))
            print("  longest chain: " + " -> ".join(chain))
    for group in graph.circles():
        if not words or {graph.room(name) for name in group} & set(words):
            print(f"circle of {len(group)} modules: {', '.join(group[:12])}", *graph.shortest_circle(group), sep="\n  ")


if __name__ == "__main__":
    main(sys.argv[1:])
