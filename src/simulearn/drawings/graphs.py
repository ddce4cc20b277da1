"""Graphs in JSON: nodes with places, and edges between them.

Nodes are a list or an object by name (`node`, `nodes`, `vertex`, `vertices`, `points`, `joints`);
edges are pairs, objects with source and target, or an object of neighbours by node. Faces are lists
of nodes; each side of a face is an edge.
"""

from collections.abc import Iterator
from itertools import chain
from typing import Any

from simulearn.drawings.points import MOST_SEGMENTS, Points, is_point, too_many
from simulearn.errors import InputError
from simulearn.grid.arrays import shown

Place = tuple[float, float, float]

NODES = ("node", "nodes", "vertex", "vertices", "points", "joints")
EDGES = ("edge", "edges", "links", "lines", "adjacency", "beams")
FACES = ("face", "faces")
PLACES = ("pos", "position", "xyz", "point", "coordinates", "location", "data", "attributes")
NAMES = ("id", "key", "name", "index")
ENDS = (("source", "target"), ("start", "end"), ("from", "to"), ("u", "v"), ("a", "b"))


def is_graph(parts: dict[str, Any]) -> bool:
    """Return whether an object, its keys in lower case, holds nodes, and edges or faces."""
    nodes = _first(parts, NODES)
    edges = _first(parts, EDGES) or _first(parts, FACES)
    return nodes is not None and edges is not None and not _lines_of_points(parts[edges])


def _first(parts: dict[str, Any], names: tuple[str, ...]) -> str | None:
    return next((n for n in names if isinstance(parts.get(n), (list, dict)) and parts[n]), None)


def _lines_of_points(edges: Any) -> bool:
    """Return whether edges are lines by their places, and no pairs of nodes."""
    first = edges[0] if isinstance(edges, list) else None
    return isinstance(first, list) and bool(first) and all(map(is_point, first))


def edges_of(
    parts: dict[str, Any], points: Points, messages: list[str], inside: str
) -> Iterator[tuple[list[Place], str]]:
    """Yield the two ends of each edge and where it is written.

    Args:
        parts: the object, its keys in lower case.
        points: reads the places of nodes.
        messages: what is to be reported is added.
        inside: where the object is, with a point at its end.

    Raises:
        InputError: a node has no place, or an edge names a node that does not exist.
    """
    key = _first(parts, NODES)
    nodes = _nodes(parts, parts[key or ""], points, f"{inside}{key}")
    edges, faces = _first(parts, EDGES), _first(parts, FACES)
    if edges is None and faces is not None:
        messages.append("the faces of the mesh give the lines: each side is one")
    pairs = _pairs(parts[edges], edges) if edges else _sides(parts[faces or ""], faces or "")
    listed = isinstance(parts[key or ""], list)
    for count, (ends, where) in enumerate(pairs):
        if count >= MOST_SEGMENTS:
            raise too_many()
        for end in ends:
            if _name(end) not in nodes:
                raise _unknown(end, f"{inside}{where}", nodes, listed)
        one, other = (nodes[_name(end)] for end in ends)
        yield [one, other], where


def _unknown(end: Any, where: str, nodes: dict[str, Place], listed: bool) -> InputError:
    """Return the error of an edge that names a node that does not exist."""
    text = f"{where} names the node {shown(end)}, which does not exist"
    if listed and str(len(nodes)) == _name(end):
        text += f"; nodes are numbered 0 to {len(nodes) - 1}; do the edges count from 1?"
    return InputError(text, "edge", where)


def _name(value: Any) -> str:
    """Return what names a node: numbers count as in text, 1.0 as 1."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return str(value)


def _nodes(parts: dict[str, Any], value: Any, points: Points, where: str) -> dict[str, Place]:
    """Return the places of nodes by name; those of a list go by their numbers, too."""
    if isinstance(value, dict):
        default = _default(parts)
        return {
            str(name): points.point(_place(node, default, f"{where}.{name}"), f"{where}.{name}")
            for name, node in value.items()
        }
    places, named = {}, {}
    for k, node in enumerate(value):
        at = f"{where}[{k}]"
        place = points.point(_place(node, {}, at), at)
        places[str(k)] = place
        if (name := _own_name(node)) is not None:
            if name in named:
                raise InputError(f"{at}: there are two nodes {shown(name)}", "node", at)
            named[name] = place
    if named and len(named) < len(places):
        raise InputError(f"{where}: some nodes have names, some have none", "node", where)
    return named or places


def _own_name(node: Any) -> str | None:
    """Return the name that a node has in itself."""
    if not isinstance(node, dict):
        return None
    for holder in (node, node.get("data")):
        if isinstance(holder, dict):
            for key in NAMES:
                if key in holder and not isinstance(holder[key], (dict, list)):
                    return _name(holder[key])
    return None


def _default(parts: dict[str, Any]) -> dict[str, Any]:
    """Return the attributes that nodes have where they do not say so."""
    for key in ("default_node_attributes", "default_vertex_attributes", "dna", "dva"):
        if isinstance(parts.get(key), dict):
            found: dict[str, Any] = parts[key]
            return {axis: found[axis] for axis in "xyz" if axis in found}
    return {}


def _place(node: Any, default: dict[str, Any], where: str) -> Any:
    """Return the point that a node is or holds."""
    if is_point(node):
        return node
    if isinstance(node, dict):
        for key in PLACES:
            if is_point(node.get(key)):
                return node[key]
        if is_point(both := {**default, **node}):
            return both
    text = f"{where} has no place; a node is [x, y], [x, y, z] or an object with x and y"
    raise InputError(text, "node", where)


def _pairs(value: Any, key: str) -> Iterator[tuple[tuple[Any, Any], str]]:
    """Yield the two names of each edge, and where it is written."""
    if isinstance(value, dict):  # neighbours by node
        seen = set()
        for one, others in value.items():
            if not isinstance(others, (dict, list)):
                raise InputError(f"{key}.{one} is no list of nodes", "edge", key)
            for other in others:
                pair = frozenset((str(one), _name(other)))
                if pair not in seen:
                    seen.add(pair)
                    yield (one, other), f"{key}.{one}.{_name(other)}"
        return
    for k, edge in enumerate(value):
        where = f"{key}[{k}]"
        if isinstance(edge, dict) and isinstance(edge.get("data"), dict):
            edge = edge["data"]
        if isinstance(edge, dict):
            names = {str(name).casefold(): name for name in edge}
            ends = next((two for two in ENDS if set(two) <= set(names)), None)
            if ends is not None:
                yield (edge[names[ends[0]]], edge[names[ends[1]]]), where
                continue
        elif isinstance(edge, list) and edge and all(isinstance(n, dict) for n in edge):
            # Neighbours in the order of the nodes.
            for other in edge:
                if "id" in other and k <= _number(other["id"]):
                    yield (k, other["id"]), where
            continue
        elif isinstance(edge, list) and len(edge) >= 2:
            yield (edge[0], edge[1]), where
            continue
        elif isinstance(edge, list) and key == "adjacency":
            continue
        text = f"{where} is {shown(edge)}; an edge names two nodes, as in [0, 1] or source, target"
        raise InputError(text, "edge", where)


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else float("inf")


def _sides(value: Any, key: str) -> Iterator[tuple[tuple[Any, Any], str]]:
    """Yield the sides of faces, each once."""
    seen = set()
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for k, face in items:
        where = f"{key}[{k}]"
        if not isinstance(face, list) or len(face) < 2:
            raise InputError(f"{where} is {shown(face)}; a face is a list of nodes", "edge", where)
        for one, other in zip(face, chain(face[1:], face[:1]), strict=True):
            pair = frozenset((_name(one), _name(other)))
            if len(pair) == 2 and pair not in seen:
                seen.add(pair)
                yield (one, other), where
