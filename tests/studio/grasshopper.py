"""A client that does what Hops does, as its source says (McNeel, Hops 0.16.14, MIT licence).

What Hops would do is done as strictly as its classes do it: JSON fills objects whose fields have
types, texts lose their quotes and nothing else, geometry comes from archives.
"""

import json
from dataclasses import dataclass, field
from typing import ClassVar
from urllib.parse import urlsplit

import rhino3dm

INT = 2**31 - 1
# Names of the types of Grasshopper's parameters that Hops can make.
PARAMETERS = {
    "Arc", "Boolean", "Box", "Brep", "Circle", "Colour", "Complex", "Culture", "Curve", "Geometry",
    "Guid", "Integer", "Line", "Matrix", "Mesh", "Number", "Plane", "Point", "Rectangle", "Text",
    "Path", "SubD", "Surface", "Time", "Transform", "Vector",
}  # fmt: skip
GEOMETRY = ("Mesh", "PolylineCurve", "NurbsCurve", "LineCurve", "PolyCurve", "Curve", "Brep")
HEADERS = {"content-type": "application/json; charset=utf-8"}

INPUT = {
    "Name": str, "Nickname": str, "ParamType": str, "Description": str, "AtLeast": int,
    "AtMost": int, "TreeAccess": bool, "Default": object, "Minimum": object, "Maximum": object,
}  # fmt: skip
OUTPUT = {"Name": str, "Nickname": str, "ParamType": str}
IO_RESPONSE = {
    "Description": str, "CacheKey": str, "InputNames": [str], "OutputNames": [str], "Icon": str,
    "Inputs": [INPUT], "Outputs": [OUTPUT], "Warnings": [str], "Errors": [str],
}  # fmt: skip
LISTED = {
    "Name": str, "Nickname": str, "Description": str, "ParamType": str, "ResultType": str,
    "AtLeast": int, "AtMost": int, "TreeAccess": bool,
}  # fmt: skip
ENTRY = {
    "Uri": str, "Name": str, "Nickname": str, "Description": str, "Category": str,
    "Subcategory": str, "Inputs": [LISTED], "Outputs": [LISTED], "Icon": str,
}  # fmt: skip
TREE = {"ParamName": str, "InnerTree": {str: [{"type": str, "data": str}]}}
SCHEMA = {
    "absolutetolerance": float, "angletolerance": float, "modelunits": str, "dataversion": int,
    "algo": str, "pointer": str, "cachesolve": bool, "recursionlevel": int, "values": [TREE],
    "warnings": [str], "errors": [str],
}  # fmt: skip

# The axes of a 2x2 grid of 65 mm, and the ratio of each.
CORNERS = [(65.0 * x, 65.0 * y, 0.0) for y in range(3) for x in range(3)]
PAIRS = [
    (0, 1),
    (1, 2),
    (3, 4),
    (4, 5),
    (6, 7),
    (7, 8),
    (0, 3),
    (1, 4),
    (2, 5),
    (3, 6),
    (4, 7),
    (5, 8),
]
RATIOS = [1, 0.5, -0.5, 0, 0.75, -1, 0.25, 0, -0.25, 1, 0, 0.5]


def conform(value, kind, place=""):
    """Raise AssertionError unless JSON has exactly the fields and types of a class."""
    if isinstance(kind, list):
        assert isinstance(value, list), f"{place} is {value!r:.60}, not a list"
        for k, one in enumerate(value):
            conform(one, kind[0], f"{place}[{k}]")
    elif isinstance(kind, dict) and str in kind:
        assert isinstance(value, dict), place
        for key, one in value.items():
            conform(one, kind[str], f"{place}.{key}")
    elif isinstance(kind, dict):
        assert isinstance(value, dict), f"{place} is {value!r:.60}, not an object"
        assert value.keys() == kind.keys(), (place, value.keys() ^ kind.keys())
        for key, one in kind.items():
            conform(value[key], one, f"{place}.{key}")
    elif kind is object:
        assert value is None or isinstance(value, str | int | float), place
    elif kind is int:
        assert type(value) is int, (place, value)
        assert -INT - 1 <= value <= INT, (place, value)
    elif kind is float:
        assert type(value) in (int, float), (place, value)
    else:
        assert type(value) is kind, (place, value)


@dataclass
class Balloon:
    """What a component shows."""

    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


class Hops:
    """A component on the canvas.

    Args:
        ask: a function (method, address, content, headers) that gives an answer of httpx's kind.
        path: what a person typed as its path.
        modelunits: of the open model.
    """

    cache: ClassVar[dict[str, dict]] = {}

    def __init__(self, ask, path, modelunits="Millimeters"):
        self._ask, self.path, self.units = ask, path, modelunits
        self.balloon, self.inputs, self.outputs = Balloon(), None, None
        self.rebuilt = self.requests = 0
        self.values = {}
        self.status = None
        self.load()

    def load(self):
        """Take a path as the address of a server and read its description."""
        response = self._ask("GET", self.path, None, {})
        kind = response.headers["content-type"].partition(";")[0].lower()
        assert "json" in kind, "Hops takes the path for a definition of Grasshopper"
        text = self._ask("GET", self.path, None, {}).text
        if not text:
            self.balloon.errors.append("Path appears valid, but to something that is not Hops")
            return
        io = json.loads(text)
        conform(io, IO_RESPONSE)
        assert io["InputNames"] == [one["Name"] for one in io["Inputs"]]
        assert io["OutputNames"] == [one["Name"] for one in io["Outputs"]]
        self.balloon.errors += io["Errors"]
        self.inputs = {one["Name"]: one for one in io["Inputs"]}
        self.outputs = {one["Name"]: one for one in io["Outputs"]}
        assert len(self.inputs) == len(io["Inputs"])
        assert len(self.outputs) == len(io["Outputs"])
        for one in (*io["Inputs"], *io["Outputs"]):
            assert one["ParamType"] in PARAMETERS, one
        for one in io["Inputs"]:
            if one["Default"] is not None and one["ParamType"] in ("Number", "Integer"):
                float(str(one["Default"]))
            for key in ("Minimum", "Maximum"):
                assert one[key] is None or isinstance(one[key], int | float)

    def access(self, name):
        """Return whether an input takes an item, a list or a tree."""
        one = self.inputs[name]
        if one["TreeAccess"] or one["AtLeast"] == one["AtMost"] == -1:
            return "tree"
        return "item" if one["AtLeast"] == one["AtMost"] == 1 else "list"

    def request(self, given, path="{0}"):
        """Return the body of a request; None where the component would not ask."""
        trees = []
        for name, one in self.inputs.items():
            items = given.get(name)
            default = one["Default"]
            if items is None and default is not None:
                items = [
                    value("System.Int32", default)
                    if one["ParamType"] == "Integer"
                    else value("System.String", default)
                    if one["ParamType"] == "Text"
                    else value("System.Double", float(default))
                ]
            if items is None and one["AtLeast"] > 0:
                self.balloon.warnings.append(f"Input parameter {name} failed to collect data")
                return None
            items = items if items is not None else []
            branches = items if isinstance(items, dict) else {path: items}
            trees.append({"ParamName": name, "InnerTree": branches})
        unknown = given.keys() - self.inputs.keys()
        assert not unknown, unknown
        return {
            "absolutetolerance": 0.001,
            "angletolerance": 1.0,
            "modelunits": self.units,
            "dataversion": 7,
            "algo": None,
            "pointer": urlsplit(self.path).path[1:],
            "cachesolve": True,
            "values": trees,
            "warnings": [],
            "errors": [],
        }

    def solve(self, given, path="{0}"):
        """Solve the component and return its outputs as trees of plain values."""
        self.balloon, self.values = Balloon(), {}
        body = self.request(given, path)
        if body is None:
            return self.values
        text = json.dumps(body)
        schema = Hops.cache.get(text)
        if schema is None:
            self.requests += 1
            address = f"http://{urlsplit(self.path).netloc}/solve"
            response = self._ask("POST", address, text, HEADERS)
            self.status = response.status_code
            assert "html" not in response.headers["content-type"]
            schema = json.loads(response.text)
            conform(schema, SCHEMA)
            if schema["values"] and len(schema["values"]) != len(self.outputs):
                self.rebuilt += 1
            elif response.status_code == 200:
                Hops.cache[text] = schema
        for tree in schema["values"]:
            output = self.outputs[tree["ParamName"]]
            self.values[tree["ParamName"]] = {
                tuple(int(k) for k in key.strip("{}").split(";")): [
                    goo(one, output["ParamType"]) for one in items
                ]
                for key, items in tree["InnerTree"].items()
            }
        self.balloon = Balloon(schema["errors"], schema["warnings"])
        return self.values

    def flat(self, name):
        """Return all values of an output in one list."""
        return [one for items in self.values[name].values() for one in items]


def goo(item, parameter):
    """Return what Grasshopper makes of a value."""
    kind, data = item["type"], item["data"].strip('"')
    if kind == "System.Boolean":
        assert parameter == "Boolean"
        return {"true": True, "false": False}[data.lower()]
    if kind in ("System.Double", "System.Int32"):
        assert parameter in ("Number", "Integer")
        return float(data) if kind == "System.Double" else int(data)
    if kind == "System.String":
        assert parameter == "Text"
        if data.strip().startswith("{") and "\\" in data:
            data = data.replace('\\"', '"').replace("\\\\", "\\")
        return data
    if kind == "Rhino.Geometry.Point3d":
        assert parameter == "Point"
        point = json.loads(data)
        conform(point, {"X": float, "Y": float, "Z": float})
        return (point["X"], point["Y"], point["Z"])
    assert kind.startswith("Rhino.Geometry."), kind
    assert kind.rpartition(".")[2] in GEOMETRY, kind
    fields = json.loads(data)
    for one in fields.values():  # Dictionary<string, string>
        assert isinstance(one, str | int), fields.keys()
    found = rhino3dm.CommonObject.Decode(fields)
    assert found is not None
    assert found.IsValid
    assert isinstance(found, {"Curve": rhino3dm.Curve, "Mesh": rhino3dm.Mesh}[parameter])
    return found


def value(kind, data):
    """Return a value as the class ResthopperObject writes it."""
    return {"type": kind, "data": json.dumps(data)}


def numbers(*values):
    return [value("System.Double", float(one)) for one in values]


def text(words):
    return [value("System.String", words)]


def points(*places):
    return [
        value("Rhino.Geometry.Point3d", dict(zip("XYZ", map(float, p), strict=True)))
        for p in places
    ]


def archived(geometry, version=None):
    """Return geometry as Rhino writes it in JSON."""
    fields = geometry.Encode()
    if version is not None:
        fields["archive3dm"] = version
    return value(f"Rhino.Geometry.{type(geometry).__name__}", fields)


def line_curve(a, b):
    return rhino3dm.LineCurve(rhino3dm.Point3d(*a), rhino3dm.Point3d(*b))


def polyline_curve(places):
    line = rhino3dm.Polyline()
    for place in places:
        line.Add(*place)
    return line.ToPolylineCurve()


def line_struct(a, b):
    """Return a Line as Newtonsoft writes the struct, with all its properties."""
    ends = [dict(zip("XYZ", map(float, p), strict=True)) for p in (a, b)]
    more = {"FromX": ends[0]["X"], "ToX": ends[1]["X"], "Length": 1.0, "IsValid": True}
    return value("Rhino.Geometry.Line", {"From": ends[0], "To": ends[1], **more})
