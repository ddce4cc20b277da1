"""Rhino files: a layer for each kind of thing, so that a designer takes what is needed.

Layers: `skeleton` the axes of the beams, one layer for each ratio, which can be read again;
`outlines` of the printed parts and `actuators`, closed flat curves; `frames`, a closed mesh each,
of which the last is shown; `targets` of goals; `toolpath`, a layer for each role. Millimetres.
"""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from simulearn.errors import InputError
from simulearn.extras import require
from simulearn.fabricate import Job
from simulearn.files import replacing
from simulearn.grid import Grid, outline
from simulearn.interop.body import body
from simulearn.inverse.clear import ClearOf
from simulearn.inverse.goals import Goals
from simulearn.inverse.kinds import AtPoints, OnSet
from simulearn.palette import BEADS
from simulearn.schedule import SCHEDULE
from simulearn.show import style
from simulearn.simulate import Result, collision_text
from simulearn.surfaces import Curve, Surface

Array = NDArray[np.float64]
Colour = str | tuple[float, float, float]

VERSION = 5  # of Rhino, which later ones read, too; meshes in newer forms take ten times as long
SPACING = 5.0  # mm, length of a mesh's faces along a beam
TARGET = "#009e73"  # of the same palette as the halves
ACTIVE = style.TOP  # an active bead of a toolpath, whichever its half


def write_3dm(
    result: Result, path: Path | str, goals: Goals | None = None, job: Job | None = None
) -> None:
    """Write a result for Rhino.

    Args:
        result: what to write.
        path: the file.
        goals: whose targets to write.
        job: the print of the result's grid, whose toolpath to write; it is moved from the bed to
            where the flat grid is.

    Raises:
        InputError: rhino3dm is not installed, the print is of another grid, or the file cannot be
            written.
    """
    file = _File()
    moved = None if job is None else _on_grid(job, result)
    flat, sections = result.joints[0, :, :4, :2], result.beams[0][:, [0, 2], :2, :2]
    _design(file, result.grid.centred, flat, sections)
    _frames(file, result)
    if goals is not None:
        _targets(file, goals, result)
    if moved is not None:
        _toolpath(file, *moved)
    file.strings(_facts(result))
    file.write(path)


def write_job_3dm(job: Job, path: Path | str) -> None:
    """Write a print for Rhino: the grids where they lie on the bed, and the toolpath.

    Args:
        job: what to write.
        path: the file.

    Raises:
        InputError: rhino3dm is not installed, or the file cannot be written.
    """
    file = _File()
    for name, grid in zip(job.names, job.grids, strict=True):
        shape = outline(grid, job.material.section)
        _design(file, grid, shape.joints, shape.beams, f"{name}: " if len(job.names) > 1 else "")
    _toolpath(file, job, [*range(-1, len(job.grids))], np.eye(2), np.zeros(3))
    needs = job.estimate
    file.strings(
        {
            "printer": job.printer.title,
            "material": job.material.name,
            "seconds": f"{needs.seconds:.0f}",
            "filament": f"{needs.filament_g:.2f} g",
            "warnings": "\n".join(message.message for message in job.warnings) or "none",
        }
    )
    file.write(path)


def _facts(result: Result) -> dict[str, str]:
    """Return what the document says about an answer."""
    bound = "not known" if result.bound_mm is None else f"{result.bound_mm:.3f} mm (9 of 10)"
    snaps = [f"{snap.released:.1%} released, frame {snap.frame}" for snap in result.snaps]
    return {
        "engine": result.engine,
        "material": str(result.material),
        "model": "none" if result.model is None else str(result.model),
        "bound": bound,
        "stable": "yes" if result.stable else "no",
        "snaps": "; ".join(snaps) or "none",
        "collisions": "\n".join(map(collision_text, result.collisions)) or "none",
        "warnings": "\n".join(message.message for message in result.warnings) or "none",
        "fixed joint": str(result.grid.fixed),
    }


def _design(file: "_File", grid: Grid, joints: Array, beams: Array, prefix: str = "") -> None:
    """Add axes, outlines and actuators of a flat grid.

    Args:
        file: to which.
        grid: where it lies.
        joints: (J, 4, 2) corners of its joints.
        beams: (B, [start, end], [right, left], 2) corners of its beams.
        prefix: of the objects' names.
    """
    for b, (ends, ratio) in enumerate(zip(grid.beams, grid.actuators, strict=True)):
        half = "top" if ratio > 0 else "bottom"
        kind = f"{half} {abs(ratio):.6g}" if ratio else "passive"
        red, green, blue = style.tint(ratio).tolist()
        colour = red, green, blue
        name = f"{prefix}beam {b}"
        more = {"ratio": f"{ratio:g}", "start": f"joint {ends[0]}", "end": f"joint {ends[1]}"}
        file.line(f"skeleton::{kind}", grid.joints[ends], name, colour, more)
        ring = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        corners = beams[b]
        file.line("outlines", corners[*ring.T], name, style.JOINT, closed=True)
        if ratio:
            a, z = (1 - abs(ratio)) / 2, (1 + abs(ratio)) / 2
            active = np.stack([(1 - t) * corners[0] + t * corners[1] for t in (a, z)])
            file.line(f"actuators::{kind}", active[*ring.T], name, colour, more, closed=True)
    for j, corners in enumerate(joints):
        fixed = {"fixed": "yes"} if j == grid.fixed else {}
        file.line("outlines", corners, f"{prefix}joint {j}", style.JOINT, fixed, closed=True)


def _frames(file: "_File", result: Result) -> None:
    shape = body(result, SPACING)
    last = len(shape.vertices) - 1
    rows = zip(SCHEDULE.names, SCHEDULE.released, shape.vertices, strict=True)
    for k, (name, released, vertices) in enumerate(rows):
        title = f"frame {k:02d}"
        more = {"frame": name, "released": f"{released:g}", **_facts(result)}
        colour = style.JOINT if k == last else style.PASSIVE
        file.mesh(f"frames::{title}", vertices, shape.quads, title, colour, more, k == last)


def _targets(file: "_File", goals: Goals, result: Result) -> None:
    """Add what is wanted, where the result has it that stays with its fixed joint."""
    back = goals.place(goals.points(result.joints[-1], result.beams[-1])).back
    for part in goals.parts:
        wanted = part.wanted
        if isinstance(wanted, AtPoints):
            rows = zip(part.names, back(wanted.targets), part.weights, strict=True)
            for name, target, weight in rows:
                file.point("targets", target, name, TARGET, {"weight": f"{weight:g}"})
        elif isinstance(wanted, OnSet) and isinstance(wanted.set, Surface):
            _surface(file, "targets", wanted.set.placed(back), wanted.kind)
        elif isinstance(wanted, OnSet) and isinstance(wanted.set, Curve):
            file.line("targets", back(wanted.set.points), wanted.kind, TARGET)
        elif isinstance(wanted, ClearOf):
            _surface(file, "bodies", wanted.surface.placed(back), wanted.kind)


def _surface(file: "_File", layer: str, surface: Surface, name: str) -> None:
    quads = surface.faces[:, [0, 1, 2, 2]]
    file.mesh(layer, surface.vertices, quads, name, TARGET, {}, True)


def _on_grid(job: Job, result: Result) -> tuple[Job, list[int], Array, Array]:
    """Return a print, which of its grids is the result's, and the motion from the bed to it.

    Raises:
        InputError: none of its grids is.
    """
    there = result.grid.centred
    for k, grid in enumerate(job.grids):
        alike = np.array_equal(grid.beams, there.beams)
        if not alike or not np.array_equal(grid.actuators, there.actuators):
            continue
        here = grid.centred.joints
        for turn in (np.eye(2), np.array([[0.0, 1.0], [-1.0, 0.0]])):  # a quarter turn back
            if np.allclose(here @ turn.T, there.joints, atol=1e-6):
                shift = np.append(-turn @ grid.joints[grid.fixed], result.joints[0, ..., 2].min())
                return job, [k, -1] if len(job.grids) == 1 else [k], turn, shift
    raise InputError("the print is of another grid than the result", "job", "job")


def _toolpath(file: "_File", job: Job, grids: Sequence[int], turn: Array, shift: Array) -> None:
    """Add the beads of some grids, -1 being the skirt, turned (2, 2) and then shifted (3,)."""
    for k, layer in enumerate(job.path.layers):
        for bead in layer.beads:
            if bead.grid in grids:
                places = np.c_[bead.points @ turn.T, np.full(len(bead.points), layer.z)] + shift
                more = {"layer": f"{k + 1}", "height": f"{layer.height:g}"}
                more |= {"width": f"{bead.widths.mean():.3g}", "speed": f"{bead.speed:g}"}
                colour = BEADS.get(bead.role, ACTIVE)
                file.line(f"toolpath::{bead.role}", places, bead.part, colour, more)


class _File:
    """A Rhino file in memory; layers are made as they are named."""

    def __init__(self) -> None:
        require("Rhino files need", "rhino3dm")
        self.rhino: Any = import_module("rhino3dm")
        self.model = self.rhino.File3dm()
        self.model.ApplicationName = "SimuLearn"
        self.model.Settings.ModelUnitSystem = self.rhino.UnitSystem.Millimeters
        self.layers: dict[str, int] = {}

    def line(
        self,
        layer: str,
        points: Array,
        name: str,
        colour: Colour,
        more: dict[str, str] | None = None,
        closed: bool = False,
    ) -> None:
        """Add a line through points (n, 2) or (n, 3)."""
        places = np.zeros((len(points), 3))
        places[:, : points.shape[1]] = points
        rows = [self.rhino.Point3d(*place) for place in places.tolist()]
        attributes = self._attributes(layer, name, colour, more)
        if len(rows) == 2:
            self.model.Objects.AddLine(*rows, attributes)
        else:
            self.model.Objects.AddPolyline([*rows, rows[0]] if closed else rows, attributes)

    def mesh(
        self,
        layer: str,
        vertices: Array,
        quads: NDArray[np.int64],
        name: str,
        colour: Colour,
        more: dict[str, str],
        visible: bool,
    ) -> None:
        """Add a mesh of quadrilaterals, on a layer of its own that is visible or not."""
        mesh = self.rhino.Mesh()
        add = mesh.Vertices.Add
        for place in vertices.tolist():
            add(*place)
        face = mesh.Faces.AddFace
        for corners in quads.tolist():
            face(*corners)
        mesh.Normals.ComputeNormals()
        self.model.Objects.AddMesh(mesh, self._attributes(layer, name, colour, more, visible))

    def point(
        self, layer: str, place: Array, text: str, colour: Colour, more: dict[str, str]
    ) -> None:
        """Add a point and a text beside it."""
        at = self.rhino.Point3d(*place.tolist())
        attributes = self._attributes(layer, text, colour, more)
        self.model.Objects.AddPoint(at, attributes)
        self.model.Objects.AddTextDot(text, at, attributes)

    def strings(self, texts: dict[str, str]) -> None:
        """Add what the document says about itself."""
        for key, text in texts.items():
            self.model.Strings[key] = text

    def write(self, path: Path | str) -> None:
        """Write the file."""
        with replacing(path) as temporary:
            if not self.model.Write(str(temporary), VERSION):
                raise InputError(f"{path}: cannot be written")

    def _attributes(
        self,
        layer: str,
        name: str,
        colour: Colour,
        more: dict[str, str] | None = None,
        visible: bool = True,
    ) -> Any:
        attributes = self.rhino.ObjectAttributes()
        attributes.LayerIndex = self._layer(layer, colour, visible)
        attributes.Name = name
        for key, text in (more or {}).items():
            attributes.SetUserString(key, text)
        return attributes

    def _layer(self, path: str, colour: Colour, visible: bool = True) -> int:
        """Return the index of a layer, named with those that it lies in."""
        if path not in self.layers:
            above, _, name = path.rpartition("::")
            layer = self.rhino.Layer()
            layer.Name = name
            layer.Visible = visible
            layer.Color = (*(round(255 * x) for x in to_rgb(colour)), 255)
            if above:
                parent = self._layer(above, style.INK)
                layer.ParentLayerId = self.model.Layers[parent].Id
            self.layers[path] = self.model.Layers.Add(layer)
        return self.layers[path]
