#! python3
"""SimuLearn in Rhino 8: the shape that picked curves take in hot water, drawn into the model.

Run it with Rhino's command ScriptEditor. It asks the studio, which must run on this machine: start
it with `simulearn studio`. Nothing has to be installed in Rhino. All that touches Rhino is in the
class Rhino8, at the end.

Actuators are read from the name of a curve's layer, such as `top 0.5`, `bottom 75%` or `passive`,
or from the curve's user text `actuator`, which goes before: `0.5`, `-0.5` or `top 0.5`.
"""

from __future__ import annotations  # Rhino 8 has Python 3.9

import contextlib
import json
import math
import os
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator, Sequence
from typing import Any

PORTS = range(8765, 8786)  # that the studio takes, the first first
NEAR = 0.3  # s to wait for a port of this machine
PATIENCE = 600  # s for an answer; the first one on a machine compiles for a minute or two
LAST = 11  # the frame at the end; 0 is flat
REACH = 10.0  # mm between a picked point and the joint that it stands for
STEP = 5.0  # mm along a beam between the corners of a mesh
KEY = "actuator"  # user text of a curve
LAYER = "SimuLearn"  # all that is drawn lies below it
ACTIONS = ("Simulate", "Validate", "Rank", "Gcode", "Options", "Exit")
NOT_RUNNING = (
    "The studio is not running on this machine. Start it in a terminal: simulearn studio "
    "(and set SIMULEARN_STUDIO to its address if it is elsewhere)."
)

# Colours of the actuators, as in the studio: red, green, blue from 0 to 1.
TOP, BOTTOM, PASSIVE = (0.835, 0.369, 0.0), (0.0, 0.447, 0.698), (0.863, 0.863, 0.863)
JOINT, FIXED, GHOST = (0.651, 0.651, 0.651), (0.227, 0.227, 0.227), (0.941, 0.941, 0.941)
PALEST = 0.42

# A section's corners: right-bottom, left-bottom, right-top, left-top. Around it in six points, of
# which two are on the middle plane; each side belongs to the bottom (-1) or the top half (1).
RING = ((0, 0), (1, 1), (1, 3), (3, 3), (2, 2), (0, 2))
HALF = (-1, -1, 1, 1, 1, -1)


Point = Sequence[float]


class Refused(Exception):  # noqa: N818
    """The studio says that a request is wrong, or cannot be reached."""


class Studio:
    """The studio at an address.

    Args:
        address: such as http://127.0.0.1:8765.
    """

    def __init__(self, address: str) -> None:
        self.address = address.rstrip("/")
        # This machine is never reached through a proxy.
        self._opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))

    def get(self, path: str, patience: float = PATIENCE) -> Any:
        """Return the answer at a path."""
        return self._send(urllib.request.Request(self.address + path), patience)

    def post(self, path: str, body: Any) -> Any:
        """Return the answer to a body."""
        head = {"Content-Type": "application/json", "Accept": "application/json"}
        data = json.dumps(body).encode("utf-8")
        return self._send(urllib.request.Request(self.address + path, data, head), PATIENCE)

    def _send(self, request: urllib.request.Request, patience: float) -> Any:
        try:
            with self._opener.open(request, timeout=patience) as answer:
                return json.loads(answer.read().decode("utf-8"))
        except urllib.error.HTTPError as error:
            raise Refused(_why(error)) from error
        except (OSError, ValueError) as error:
            raise Refused("The studio does not answer any more; is it still running?") from error


def _why(error: urllib.error.HTTPError) -> str:
    """Return what a problem of the studio says."""
    try:
        problem = json.loads(error.read().decode("utf-8"))
        return str(problem["detail"])
    except (OSError, ValueError, KeyError, TypeError):
        return f"the studio answers with status {error.code}"


def find(ports: Sequence[int] = PORTS, address: str | None = None) -> Studio | None:
    """Return the studio that runs on this machine; None if there is none.

    Args:
        ports: where to look.
        address: where it is, if that is known; else the variable SIMULEARN_STUDIO says it.
    """
    address = address or os.environ.get("SIMULEARN_STUDIO")
    addresses = [address] if address else [f"http://127.0.0.1:{port}" for port in ports]
    for one in addresses:
        if not address and not _is_open(one):
            continue
        studio = Studio(one)
        try:
            version = studio.get("/api/version", patience=10)
        except Refused:
            continue
        if isinstance(version, dict) and "engines" in version and "api" in version:
            return studio
    return None


def _is_open(address: str) -> bool:
    """Return whether a port of this machine is open; some systems take seconds to say no."""
    port = int(address.rpartition(":")[2])
    try:
        with socket.create_connection(("127.0.0.1", port), timeout=NEAR):
            return True
    except OSError:
        return False


def layer_of(curve: dict[str, Any]) -> str:
    """Return the layer that says a curve's actuator: from its user text, else its own.

    Args:
        curve: a dict with layer and text.
    """
    text = (curve.get("text") or "").strip()
    if not text:
        return curve.get("layer") or ""
    try:
        ratio = float(text.replace(",", "."))
    except ValueError:
        return text
    if ratio == 0:
        return "passive"
    return "{} {:.6f}".format("top" if ratio > 0 else "bottom", abs(ratio))


def model_of(
    curves: list[dict[str, Any]], units: str, fixed: Point | None = None
) -> tuple[dict[str, Any], int]:
    """Return what the studio receives of curves, and how many are not straight.

    Args:
        curves: dicts with points (None where a curve is not straight), layer, text, colour, name.
        units: name of the model's unit.
        fixed: a point at the joint that is held.
    """
    straight = [curve for curve in curves if curve["points"]]
    lines = [
        {
            "points": curve["points"],
            "layer": layer_of(curve),
            "colour": curve.get("colour"),
            "name": curve.get("name") or "",
        }
        for curve in straight
    ]
    return {"lines": lines, "units": units, "fixed": fixed}, len(curves) - len(straight)


def tint(ratio: float) -> Point:
    """Return the colour of an actuator."""
    if ratio == 0:
        return PASSIVE
    hue = TOP if ratio > 0 else BOTTOM
    depth = PALEST + (1 - PALEST) * abs(ratio)
    return tuple(1 - depth * (1 - part) for part in hue)


def surface(
    result: dict[str, Any], frame: int, pale: bool = False
) -> tuple[list[Point], list[tuple[int, int, int, int]], list[tuple[int, ...]]]:
    """Return a frame as quadrilaterals: points, faces and the colours (0 to 255) of the points.

    Args:
        result: of a simulation, as the studio answers.
        frame: which one.
        pale: whether it has no colours.
    """
    points: list[Point] = []
    faces: list[tuple[int, int, int, int]] = []
    colours: list[tuple[int, ...]] = []

    def strip(rows: Sequence[Sequence[Point]], colour: Point) -> None:
        """Add a strip between pairs of points."""
        begin = len(points)
        for pair in rows:
            points.extend(pair)
        for k in range(begin, len(points) - 2, 2):
            faces.append((k, k + 1, k + 3, k + 2))
        paint = tuple(round(255 * part) for part in (GHOST if pale else colour))
        colours.extend([paint] * (len(points) - begin))

    grid = result["grid"]
    for sections, ratio in zip(result["beams"][frame], grid["actuators"]):  # noqa: B905
        for begin, end, active in _parts(ratio):
            count = max(1, math.ceil((end - begin) * _length(sections) / STEP))
            rings = [_ring(sections, begin + (end - begin) * k / count) for k in range(count + 1)]
            for side in range(6):
                tone = ratio if active and HALF[side] * ratio > 0 else 0
                rows = [(ring[side], ring[(side + 1) % 6]) for ring in rings]
                strip(rows, tint(tone))
    for joint, corners in enumerate(result["joints"][frame]):
        colour = FIXED if joint == grid["fixed"] else JOINT
        a, b, c, d, e, f, g, h = corners
        for rows in ([(e, f), (h, g)], [(b, a), (c, d)], *_sides(corners)):
            strip(rows, colour)
    return points, faces, colours


def _sides(corners: Sequence[Point]) -> Iterator[list[tuple[Point, Point]]]:
    """Return the four sides of a joint as two pairs of points each."""
    for k in range(4):
        other = (k + 1) % 4
        yield [(corners[k], corners[other]), (corners[k + 4], corners[other + 4])]


def _parts(ratio: float) -> list[tuple[float, float, bool]]:
    """Return the stretches of a beam (begin, end, whether the actuator is there)."""
    size = abs(ratio)
    stops = sorted({0.0, (1 - size) / 2, (1 + size) / 2, 1.0})
    return [
        (a, b, size > 0 and abs(a + b - 1) < size)
        for a, b in zip(stops, stops[1:])  # noqa: B905, RUF007
    ]


def _ring(sections: Sequence[Sequence[Point]], t: float) -> list[Point]:
    """Return the six points around a beam at t from 0 to 1, on parabolas through its sections."""
    weights = (2 * (t - 0.5) * (t - 1), 4 * t * (1 - t), 2 * t * (t - 0.5))
    corners = [
        [sum(w * s[c][k] for w, s in zip(weights, sections)) for k in range(3)]  # noqa: B905
        for c in range(4)
    ]
    return [[(corners[a][k] + corners[b][k]) / 2 for k in range(3)] for a, b in RING]


def _length(sections: Sequence[Sequence[Point]]) -> float:
    """Return the length of a beam, mm."""
    ends = [[sum(c[k] for c in section) / 4 for k in range(3)] for section in sections]
    return math.dist(ends[0], ends[1]) + math.dist(ends[1], ends[2])


def placed(model: dict[str, Any], points: Sequence[Point]) -> list[Point]:
    """Return points of a result in the model.

    Args:
        model: the studio's answer about a grid.
        points: mm, seen from the fixed joint.
    """
    origin, axes, mm = model["origin"], model["axes"], model["mm"]
    return [
        [origin[k] + sum(p[i] * axes[i][k] for i in range(3)) / mm for k in range(3)]
        for p in points
    ]


def inside(model: dict[str, Any], point: Point) -> list[float]:
    """Return a point of the model as results have it: mm, seen from the fixed joint."""
    apart = [point[k] - model["origin"][k] for k in range(3)]
    return [model["mm"] * sum(apart[k] * model["axes"][i][k] for k in range(3)) for i in range(3)]


def place_of(model: dict[str, Any], where: str) -> Any:
    """Return the point of a message: its joint, the middle of its beam, else None."""
    word, _, number = where.partition(" ")
    joints, beams = model["joints"], model["grid"]["beams"]
    if word == "joint" and number.isdigit() and int(number) < len(joints):
        return joints[int(number)]
    if word == "beam" and number.isdigit() and int(number) < len(beams):
        a, b = (joints[k] for k in beams[int(number)])
        return [(a[k] + b[k]) / 2 for k in range(3)]
    return None


def goal_of(model: dict[str, Any], point: Point, target: Point) -> dict[str, Any]:
    """Return a goal for the joint nearest to a point.

    Raises:
        Refused: the nearest joint is too far away.
    """
    here = inside(model, point)
    joints = [inside(model, joint) for joint in model["joints"]]
    away = [math.dist(joint[:2], here[:2]) for joint in joints]
    nearest = away.index(min(away))
    if away[nearest] > REACH:
        raise Refused(
            f"that point is {away[nearest]:.3g} mm from the nearest joint of the flat grid; "
            f"pick one that is at most {REACH:g} mm away"
        )
    return {"vertex": ["joint", nearest, "centre"], "target": inside(model, target)}


class Session:
    """One run of the script.

    Args:
        host: Rhino, or what stands for it; see Rhino8.
        studio: that is asked.
    """

    def __init__(self, host: Any, studio: Studio) -> None:
        self.host, self.studio = host, studio
        self.curves: list[dict[str, Any]] = []
        self.fixed: Point | None = None
        self.frame, self.engine = LAST, "learned"

    def run(self) -> None:
        """Pick curves, and do what is chosen until there is nothing more to do."""
        self.curves = self.host.pick()
        if not self.curves:
            self.host.say("No curves were picked.")
            return
        if not self.studio.get("/api/version")["ready"]:
            self.host.say("The studio prepares itself; the first answer may take two minutes.")
        while True:
            action = self.host.choose("SimuLearn", ACTIONS, "Simulate")
            if action in (None, "Exit"):
                return
            try:
                with self.host.undo(f"SimuLearn {action}"):
                    getattr(self, action.lower())()
            except Refused as error:
                self.host.say(str(error))

    def model(self) -> dict[str, Any]:
        """Return the grid that the picked curves show, and say what was mended."""
        body, curved = model_of(self.curves, self.host.units(), self.fixed)
        if curved:
            self.host.say(f"{curved} curves are not straight and were left out.")
        model = self.studio.post("/rhino/grid", body)
        for remark in model["remarks"]:
            self.host.say(remark["text"])
        self.host.clear(f"{LAYER}::messages")
        loud = [one for one in model["remarks"] if not one["quiet"]]
        self._dots([(one["text"], one["point"]) for one in loud])
        return model

    def simulate(self) -> None:
        """Draw the shape that the grid takes, and the flat grid as a ghost."""
        model = self.model()
        self._draw(model, model["grid"], "shape")

    def validate(self) -> None:
        """Say what is wrong with the grid and mark where."""
        model = self.model()
        report = self.studio.post("/api/validate", model["grid"])
        dots = []
        for kind, messages in (("error", report["errors"]), ("warning", report["warnings"])):
            for one in messages:
                self.host.say("{}: {}".format(kind, one["message"]))
                place = place_of(model, one["where"])
                dots += [(one["message"], place)] if place else []
        self._dots(dots)
        words = "can be printed and simulated" if not report["errors"] else "is not valid"
        self.host.say(f"The grid {words}.")

    def rank(self) -> None:
        """Ask for points and targets, and draw the suggestion that is chosen."""
        model, goals = self.model(), []
        while True:
            point = self.host.point("Joint of the flat grid that shall move (Enter when done)")
            target = point and self.host.point("Where it shall come")
            if not target:
                break
            goals.append(goal_of(model, point, target))
        if not goals:
            raise Refused("No goals were set.")
        task = {"schema": "simulearn.task/1", "grid": model["grid"], "goals": goals}
        ranking = self.studio.post("/api/rank", task)
        self.host.say("Now the error is {:.3g} mm.".format(ranking["error_mm"]))
        best = ranking["best"]
        for k, one in enumerate(best, 1):
            self.host.say("{}: {} ({:.3g} mm)".format(k, one["words"], one["error_mm"]))
        names = [f"Suggestion{k}" for k in range(1, len(best) + 1)]
        name = self.host.choose("Draw which", (*names, "None"), names[0] if names else "None")
        if name in names:
            grid = best[names.index(name)]["grid"]
            self._draw(model, grid, "suggestion")
            self._skeleton(model, grid)

    def gcode(self) -> None:
        """Write the file that prints the grid."""
        model = self.model()
        names = [one["name"] for one in self.studio.get("/api/printers")["printers"]]
        # The name of an option in Rhino has letters and digits only.
        options = {name.replace("-", ""): name for name in names}
        option = self.host.choose("Printer", tuple(options), next(iter(options)))
        if option not in options:
            return
        body = {"grids": [model["grid"]], "printer": options[option]}
        answer = self.studio.post("/api/gcode", body)
        for one in answer["warnings"]:
            self.host.say("warning: {}".format(one["message"]))
        path = self.host.save("Save G-code", answer["file"])
        if path is None:
            return
        with open(path, "w", encoding="utf-8", newline="\n") as file:  # noqa: PTH123
            file.write(answer["gcode"])
        self.host.say(
            "{}: {:.0f} min, {:.1f} m of filament, {:.0f} g".format(
                path,
                answer["seconds"] / 60,
                answer["filament_mm"] / 1000,
                answer["filament_g"],
            )
        )

    def options(self) -> None:
        """Ask for the frame, the engine and the joint that is held."""
        self.frame = self.host.integer("Frame (0 is flat, 11 the end)", self.frame, 0, LAST)
        engines = tuple(self.studio.get("/api/version")["engines"])
        self.engine = self.host.choose("Engine", engines, self.engine) or self.engine
        fixed = self.host.point("Joint that is held (Enter: the one in the middle)")
        self.fixed = list(fixed) if fixed else None

    def _draw(self, model: dict[str, Any], grid: dict[str, Any], layer: str) -> None:
        """Draw a grid's shape in the chosen frame, and the flat grid."""
        body = {"grids": [grid], "engine": self.engine}
        result = self.studio.post("/api/simulate", body)["results"][0]
        if result["schema"].startswith("simulearn.failure"):
            hint = f"; {result['hint']}" if result["hint"] else ""
            raise Refused(result["message"] + hint)
        for one in result["warnings"]:
            self.host.say("warning: {}".format(one["message"]))
        if not result["stable"]:
            self.host.say("warning: the shape is in unstable balance and may snap into another")
        if result["bound_mm"] is not None:
            bound = result["bound_mm"]
            self.host.say(f"Nine of ten such shapes are off by less than {bound:.2g} mm.")
        for name, frame, pale in ((layer, self.frame, False), ("flat", 0, True)):
            self.host.clear(f"{LAYER}::{name}")
            points, faces, colours = surface(result, frame, pale)
            self.host.mesh(f"{LAYER}::{name}", placed(model, points), faces, colours)

    def _skeleton(self, model: dict[str, Any], grid: dict[str, Any]) -> None:
        """Draw the axes of a grid on layers that say their actuators, to be picked again."""
        self.host.clear(f"{LAYER}::suggestion axes")
        fixed = grid["joints"][grid["fixed"]]
        joints = [[x - fixed[0], y - fixed[1], 0.0] for x, y in grid["joints"]]
        for (a, b), ratio in zip(grid["beams"], grid["actuators"]):  # noqa: B905
            name = layer_of({"text": str(ratio)}).rstrip("0").rstrip(".")
            ends = placed(model, [joints[a], joints[b]])
            self.host.polyline(f"{LAYER}::suggestion axes::{name}", ends)

    def _dots(self, dots: Sequence[tuple[str, Point]]) -> None:
        for text, point in dots:
            self.host.dot(f"{LAYER}::messages", text, point)


def main(host: Any, studio: Studio | None = None) -> None:
    """Run the script.

    Args:
        host: Rhino, or what stands for it.
        studio: that is asked; the one that runs on this machine if not given.
    """
    studio = studio or find()
    if studio is None:
        host.say(NOT_RUNNING)
        return
    try:
        Session(host, studio).run()
    except Refused as error:
        host.say(str(error))


class Rhino8:
    """Rhino: what is picked, asked, said and drawn. Nothing else of the script knows Rhino."""

    def __init__(self) -> None:
        import Rhino  # type: ignore[import-not-found]
        import rhinoscriptsyntax  # type: ignore[import-not-found]
        import scriptcontext  # type: ignore[import-not-found]

        self._rs, self._doc, self._app = rhinoscriptsyntax, scriptcontext.doc, Rhino.RhinoApp

    def units(self) -> str:
        """Return the name of the model's unit, such as Millimeters."""
        return str(self._doc.ModelUnitSystem)

    def pick(self) -> list[dict[str, Any]]:
        """Return the selected curves, those that are picked, or those on layers that are chosen."""
        rs = self._rs
        found = rs.GetObjects("Axes of the beams (Enter to choose layers)", 4, False, True)
        if not found:
            names = [name for name in rs.LayerNames() or [] if not name.startswith(LAYER)]
            chosen = rs.MultiListBox(names, "Layers with the axes of the beams", "SimuLearn")
            found = [one for name in chosen or [] for one in rs.ObjectsByLayer(name) or []]
        return [self._curve(one) for one in found if rs.IsCurve(one)]

    def _curve(self, one: Any) -> dict[str, Any]:
        rs = self._rs
        try:
            points = rs.PolylineVertices(one)
        except ValueError:  # it is none
            straight = rs.IsCurveLinear(one)
            points = [rs.CurveStartPoint(one), rs.CurveEndPoint(one)] if straight else None
        colour = rs.ObjectColor(one)
        return {
            "points": points and [[p.X, p.Y, p.Z] for p in points],
            "layer": rs.ObjectLayer(one),
            "text": rs.GetUserText(one, KEY),
            "colour": f"#{colour.R:02x}{colour.G:02x}{colour.B:02x}",
            "name": rs.ObjectName(one) or "",
        }

    def choose(self, question: str, options: Sequence[str], default: str) -> str | None:
        """Return one of the options, or None."""
        given = self._rs.GetString(question, default, list(options))
        given = default if given == "" else given
        return next((one for one in options if given and one.lower() == given.lower()), None)

    def integer(self, question: str, default: int, low: int, high: int) -> int:
        """Return a number; the default where none is given."""
        given = self._rs.GetInteger(question, default, low, high)
        return default if given is None else int(given)

    def point(self, question: str) -> Point | None:
        """Return a point, or None."""
        given = self._rs.GetPoint(question)
        return [given.X, given.Y, given.Z] if given else None

    def save(self, question: str, name: str) -> str | None:
        """Return where a file is to be saved, or None."""
        return self._rs.SaveFileName(question, "G-code (*.gcode)|*.gcode||", None, name, "gcode")

    def say(self, text: str) -> None:
        """Write a line into the command history."""
        self._app.WriteLine(text)

    @contextlib.contextmanager
    def undo(self, name: str) -> Iterator[None]:
        """Make all that is drawn one step that can be undone."""
        record = self._doc.BeginUndoRecord(name)
        try:
            yield
        finally:
            self._doc.EndUndoRecord(record)

    def clear(self, layer: str) -> None:
        """Delete what was drawn before on a layer and those below it."""
        names = [one for one in self._rs.LayerNames() or [] if one.startswith(layer)]
        for name in names:
            if name == layer or name.startswith(f"{layer}::"):
                self._rs.DeleteObjects(self._rs.ObjectsByLayer(name) or [])

    def mesh(
        self, layer: str, points: Sequence[Point], faces: Sequence[Any], colours: Sequence[Any]
    ) -> None:
        """Draw a mesh."""
        self._put(layer, self._rs.AddMesh(points, faces, None, None, colours))

    def polyline(self, layer: str, points: Sequence[Point]) -> None:
        """Draw a polyline."""
        self._put(layer, self._rs.AddPolyline(points))

    def dot(self, layer: str, text: str, point: Point) -> None:
        """Draw a text dot."""
        self._put(layer, self._rs.AddTextDot(text, point))

    def _put(self, layer: str, one: Any) -> None:
        """Put an object on a layer, which is made with all above it."""
        if not self._rs.IsLayer(layer):
            self._rs.AddLayer(layer)
        self._rs.ObjectLayer(one, layer)


if __name__ == "__main__":
    main(Rhino8())
