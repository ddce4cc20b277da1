"""From the goals of a task file to goals as the search takes them; surfaces and curves are read."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from simulearn.errors import InputError, Message
from simulearn.grid import Grid
from simulearn.inverse.clear import ClearOf, ClearOfItself, courses
from simulearn.inverse.goalfile import OF, CurveFile, Goal, Motion, SurfaceFile
from simulearn.inverse.goals import Goals, Part
from simulearn.inverse.kinds import Apart, AtPoints, OnSet, Wanted
from simulearn.inverse.naming import face_of, vertex_of
from simulearn.inverse.turning import Angle, Direction
from simulearn.inverse.vertex import Vertex
from simulearn.material import load_material
from simulearn.rigid import Place
from simulearn.surfaces import (
    Curve,
    Plane,
    Surface,
    mended_surface,
    read_curve,
    read_surface,
    surface_of_heights,
)

SQUARE = 1e-6  # by which a rotation's rows may be off
WHAT = ", ".join(OF)


@dataclass
class Shapes:
    """The surfaces and curves of a task, each read once.

    Attributes:
        folder: that their files are seen from; None where no file may be named.
        found: by the key and place of the goal.
        warnings: about them.
    """

    folder: Path | None = None
    found: dict[str, Surface | Curve] = field(default_factory=dict)
    warnings: list[Message] = field(default_factory=list)

    @property
    def digest(self) -> str:
        """SHA-256 of all of them; "" of none."""
        if not self.found:
            return ""
        digest = sha256()
        for where, shape in sorted(self.found.items()):
            digest.update(where.encode())
            parts = [shape.vertices, shape.faces] if isinstance(shape, Surface) else [shape.points]
            for part in parts:
                digest.update(np.ascontiguousarray(part).tobytes())
        return digest.hexdigest()

    def surface(self, said: SurfaceFile, where: str) -> Surface:
        """Return a surface in its place.

        Raises:
            InputError: it cannot be read, may not be named or is not said; one line says where.
        """
        if where not in self.found:
            given = [name for name in ("file", "heights", "vertices") if getattr(said, name)]
            if len(given) != 1:
                has = " and ".join(given) or "no shape"
                text = f"{where} has {has}; it has one of file, heights, and vertices with faces"
                raise InputError(text, "task", where)
            surface = self._read(where, lambda: self._surface(said, given[0], where))
            self.found[where] = surface.placed(_place(said.place, f"{where}.place"))
        known = self.found[where]
        assert isinstance(known, Surface)
        return known

    def curve(self, said: CurveFile, where: str) -> Curve:
        """Return a curve in its place; raises as `surface` does."""
        if where not in self.found:
            if (said.file is None) == (said.points is None):
                has = "no shape" if said.file is None else "both"
                text = f"{where} has {has}; it has one of file and points"
                raise InputError(text, "task", where)
            curve = self._read(where, lambda: self._curve(said, where))
            self.found[where] = curve.placed(_place(said.place, f"{where}.place"))
        known = self.found[where]
        assert isinstance(known, Curve)
        return known

    def _surface(self, said: SurfaceFile, by: str, where: str) -> Surface:
        _only(said, where, OF_SURFACE[by])
        if said.file is not None:
            return read_surface(self._path(said.file, where), said.unit)
        if said.heights is not None:
            if said.x is None or said.y is None:
                text = "heights come with x and y, each from where to where"
                raise InputError(text, "task", where)
            x, y = (said.x[0], said.x[1]), (said.y[0], said.y[1])
            return surface_of_heights(said.heights, x, y, said.step)
        return mended_surface(
            np.array(said.vertices, float), np.array(said.faces or [], np.int64).reshape(-1, 3)
        )

    def _curve(self, said: CurveFile, where: str) -> Curve:
        if said.file is not None:
            return read_curve(self._path(said.file, where), said.unit)
        points = np.array(said.points, float)
        apart = np.linalg.norm(np.diff(points, axis=0), axis=1) > 0
        return Curve(points[np.r_[True, apart]])

    def _read(self, where: str, make: Any) -> Any:
        try:
            shape = make()
        except InputError as error:
            if str(error).startswith(where):
                raise
            if error.code == "unit-name":
                text = f"{where}.unit is wrong: {error}"
                raise InputError(text, "task", f"{where}.unit") from error
            raise InputError(f"{where}: {error}", error.code, where) from error
        self.warnings += [
            Message(one.code, where, f"{where}: {one.message}") for one in shape.warnings
        ]
        return shape

    def _path(self, file: str, where: str) -> Path:
        if self.folder is None:
            text = (
                f"{where}.file names a file, which cannot be read from here; give the shape itself "
                "(heights, or vertices and faces, or points)"
            )
            raise InputError(text, "surface-path", f"{where}.file")
        return self.folder / file


OF_SURFACE = {
    "file": ("file", "unit", "place"),
    "heights": ("heights", "x", "y", "step", "place"),
    "vertices": ("vertices", "faces", "place"),
}


def goals_of(said: Sequence[Goal], grid: Grid, shapes: Shapes, free: bool = False) -> Goals:
    """Return the goals of a task.

    Args:
        said: as in the file.
        grid: the design to begin with.
        shapes: the surfaces and curves that are known already, to which new ones are added.
        free: whether the shape may be placed anywhere.

    Raises:
        InputError: a goal wants nothing or what does not exist; one line says which.
    """
    parts: list[Part] = []
    for k, goal in enumerate(said):
        agree(goal, f"goals[{k}]")
        parts += _parts(goal, f"goals[{k}]", grid, shapes)
    if not sum(float(part.weights.sum()) for part in parts) > 0:
        raise InputError("goals all have the weight 0; at least one counts", "task", "goals")
    return Goals.together(_merged(parts), Place() if free else None)


def rows_of(goal: Goal, grid: Grid) -> int:
    """Return how many goals an entry stands for: one for each vertex or face."""
    if goal.vertices is not None and "vertices" in OF[goal.wanted] and goal.distance is None:
        return len(_vertices(goal, "goals", grid))
    return len(goal.faces) if goal.direction is not None and goal.faces else 1


def agree(goal: Goal, where: str) -> None:
    """Make sure that the keys of a goal go together.

    Raises:
        InputError: they do not; one line says which.
    """
    wanted = [key for key in OF if getattr(goal, key) is not None]
    if len(wanted) != 1:
        what = f"wants {' and '.join(wanted)}" if wanted else "says not what is wanted"
        raise InputError(f"{where} {what}; a goal has one of {WHAT}", "task", where)
    (key,) = wanted
    whose = [name for name in ("vertex", "vertices", "face", "faces") if getattr(goal, name)]
    allowed = OF[key]
    if len(whose) != bool(allowed) or (whose and whose[0] not in allowed):
        needed = " or ".join(allowed) or "neither vertices nor faces: it is about all beams"
        has = " and ".join(whose) or "no vertex and no face"
        raise InputError(f"{where} has {has}; with {key} it has {needed}", "task", where)
    if not goal.slide and key not in ("surface", "curve", "plane"):
        text = f"{where}.slide is false; only on a surface, curve or plane a vertex can slide"
        raise InputError(text, "task", f"{where}.slide")
    if goal.clearance is not None and key != "away_from":
        text = f"{where}.clearance is of what is to be kept away from; it comes with away_from"
        raise InputError(text, "task", f"{where}.clearance")


def _parts(goal: Goal, where: str, grid: Grid, shapes: Shapes) -> list[Part]:
    key = goal.wanted
    if key in ("direction", "angle"):
        return _turning(goal, where, grid)
    if key == "away_from":
        return [_clear(goal, where, grid, shapes)]
    vertices = _vertices(goal, where, grid)
    weights = np.full(len(vertices), goal.weight)
    if goal.distance is not None:
        if len(vertices) != 2 or vertices[0] == vertices[1]:
            text = f"{where}.vertices are two, between which the distance is"
            raise InputError(text, "task", f"{where}.vertices")
        return [Part(Apart(goal.distance), vertices, weights[:1])]
    wanted: Wanted
    if goal.target is not None:
        wanted = AtPoints(np.tile(np.array(goal.target, float), (len(vertices), 1)))
    elif goal.surface is not None:
        wanted = OnSet(shapes.surface(goal.surface, f"{where}.surface"), "surface", goal.slide)
    elif goal.curve is not None:
        wanted = OnSet(shapes.curve(goal.curve, f"{where}.curve"), "curve", goal.slide)
    else:
        assert goal.plane is not None
        normal = _unit(goal.plane.normal, f"{where}.plane.normal")
        wanted = OnSet(Plane.of(goal.plane.point, normal), "plane", goal.slide)
    return [Part(wanted, vertices, weights)]


def _vertices(goal: Goal, where: str, grid: Grid) -> tuple[Vertex, ...]:
    if goal.vertices == "joints":
        return tuple(Vertex("joint", k) for k in range(len(grid.joints)))
    if goal.vertices == "beams":
        return tuple(Vertex("beam", b, None, 1) for b in range(len(grid.beams)))
    if goal.vertex is not None:
        return (vertex_of(goal.vertex, f"{where}.vertex", grid),)
    names = goal.vertices or []
    return tuple(vertex_of(one, f"{where}.vertices[{k}]", grid) for k, one in enumerate(names))


def _turning(goal: Goal, where: str, grid: Grid) -> list[Part]:
    names = goal.faces or []
    faces = [face_of(one, f"{where}.faces[{k}]", grid) for k, one in enumerate(names)]
    if goal.face is not None:
        faces = [face_of(goal.face, f"{where}.face", grid)]
    weight = np.array([goal.weight])
    if goal.angle is not None:
        if len(faces) != 2:
            text = f"{where}.faces are two, between which the angle is"
            raise InputError(text, "task", f"{where}.faces")
        wanted = Angle((faces[0], faces[1]), float(np.radians(goal.angle)))
        return [Part(wanted, faces[0].vertices + faces[1].vertices, weight)]
    unit = _unit(goal.direction or [], f"{where}.direction")
    return [Part(Direction(face, unit), face.vertices, weight) for face in faces]


def _clear(goal: Goal, where: str, grid: Grid, shapes: Shapes) -> Part:
    section = load_material(grid.material).section
    radius = float(np.hypot(section.width, section.thickness)) / 2
    clearance = goal.clearance or 0.0
    wanted: Wanted
    if isinstance(goal.away_from, SurfaceFile):
        place = f"{where}.away_from"
        surface = shapes.surface(goal.away_from, place)
        text = f"{place} is no closed body; both sides of it are kept clear"
        said = Message("surface-open", place, text)
        if not surface.closed and said not in shapes.warnings:
            shapes.warnings.append(said)
        wanted = ClearOf(surface, clearance, radius)
    else:
        wanted = ClearOfItself(grid.beams, clearance, radius)
    return Part(wanted, courses(len(grid.beams)), np.array([goal.weight]))


def _merged(parts: Sequence[Part]) -> list[Part]:
    """Return the parts, points that follow each other as one."""
    merged: list[Part] = []
    for part in parts:
        last = merged[-1] if merged else None
        if last and isinstance(last.wanted, AtPoints) and isinstance(part.wanted, AtPoints):
            merged[-1] = Part(
                AtPoints(np.concatenate([last.wanted.targets, part.wanted.targets])),
                last.vertices + part.vertices,
                np.concatenate([last.weights, part.weights]),
            )
        else:
            merged.append(part)
    return merged


def _place(said: Motion | None, where: str) -> Place:
    if said is None:
        return Place()
    turn = np.eye(3) if said.turn is None else np.array(said.turn, float)
    if np.abs(turn @ turn.T - np.eye(3)).max() > SQUARE or np.linalg.det(turn) < 0:
        text = f"{where}.turn is no rotation: rows of length 1, at right angles, right-handed"
        raise InputError(text, "task", f"{where}.turn")
    return Place(turn, np.array(said.shift or [0.0] * 3, float))


def _unit(vector: Sequence[float], where: str) -> NDArray[np.float64]:
    array = np.array(vector, float)
    length = float(np.linalg.norm(array))
    if not length > 0:
        raise InputError(f"{where} is {list(vector)}; it has a length", "task", where)
    return array / length


def _only(said: SurfaceFile, where: str, keys: Sequence[str]) -> None:
    for name in SurfaceFile.model_fields:
        if name not in keys and getattr(said, name) is not None:
            text = f"{where}.{name} does not go with {keys[0]}; with it go {', '.join(keys[1:])}"
            raise InputError(text, "task", f"{where}.{name}")
