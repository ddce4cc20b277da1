"""What stands for Rhino 8: its modules for scripts, over a model of rhino3dm.

The functions have the names, parameters and returns that Rhino's own module rhinoscriptsyntax has
for CPython (McNeel, rhinoscriptsyntax, folder python3, MIT licence).
"""

import sys
import types
from types import SimpleNamespace

import rhino3dm


class Rhino:
    """A model, the answers of a person in their order, and what was written.

    Args:
        units: of the model.
        answers: to the questions of the script; a callable is called when it is asked.
    """

    def __init__(self, units="Millimeters", answers=()):
        self.file = rhino3dm.File3dm()
        self.file.Settings.ModelUnitSystem = getattr(rhino3dm.UnitSystem, units)
        self.answers, self.written, self.records = list(answers), [], []
        self.dots, self.selected = [], None
        self._layers = {}

    # What a person does

    def layer(self, path, colour=(0, 0, 0, 255)):
        """Return the index of a layer, made with those above it."""
        if path not in self._layers:
            parent, _, name = path.rpartition("::")
            layer = rhino3dm.Layer()
            layer.Name, layer.Color = name, colour
            if parent:
                layer.ParentLayerId = self.file.Layers[self.layer(parent)].Id
            self._layers[path] = self.file.Layers.Add(layer)
        return self._layers[path]

    def draw(self, curve, layer="lines", text=None):
        """Draw a curve, with the user text of an actuator."""
        attributes = rhino3dm.ObjectAttributes()
        attributes.LayerIndex = self.layer(layer)
        if text is not None:
            attributes.SetUserString("actuator", text)
        return self.file.Objects.AddCurve(curve, attributes)

    def objects(self, layer):
        """Return the geometry on a layer and those below it."""
        return [
            one.Geometry
            for one in self.file.Objects
            if self._path(one) == layer or self._path(one).startswith(f"{layer}::")
        ]

    def layers_used(self):
        return {self._path(one) for one in self.file.Objects}

    def _path(self, one):
        return next(p for p, k in self._layers.items() if k == one.Attributes.LayerIndex)

    def _answer(self, question):
        answer = self.answers.pop(0)
        return answer(question) if callable(answer) else answer

    def _object(self, one):
        return self.file.Objects.FindId(str(one))

    # rhinoscriptsyntax

    def GetObjects(
        self, message=None, filter=0, group=True, preselect=False, select=False, objects=None,
        minimum_count=1, maximum_count=0, custom_filter=None,
    ):  # fmt: skip
        assert filter == 4
        assert preselect
        chosen = self.selected if self.selected is not None else self._answer(message)
        return chosen or None

    def LayerNames(self, sort=False):
        return list(self._layers)

    def ObjectsByLayer(self, layer_name, select=False):
        return [
            str(one.Attributes.Id) for one in self.file.Objects if self._path(one) == layer_name
        ]

    def MultiListBox(self, items, message=None, title=None, defaults=None):
        assert all(not name.startswith("SimuLearn") for name in items)
        return self._answer(message)

    def IsCurve(self, object_id):
        return isinstance(self._object(object_id).Geometry, rhino3dm.Curve)

    def PolylineVertices(self, curve_id, segment_index=-1):
        curve = self._object(curve_id).Geometry
        line = curve.TryGetPolyline() if curve.IsPolyline() else None
        if line is None:
            raise ValueError("curve_id does not reference a polyline")
        return list(line)

    def IsCurveLinear(self, object_id, segment_index=-1):
        return self._object(object_id).Geometry.IsLinear(1e-9)

    def CurveStartPoint(self, curve_id, segment_index=-1, point=None):
        return self._object(curve_id).Geometry.PointAtStart

    def CurveEndPoint(self, curve_id, segment_index=-1, point=None):
        return self._object(curve_id).Geometry.PointAtEnd

    def ObjectLayer(self, object_id, layer=None):
        one = self._object(object_id)
        before = self._path(one)
        if layer:
            assert layer in self._layers, layer
            # rhino3dm changes no attributes of what is in a file, so it is added anew.
            attributes = rhino3dm.ObjectAttributes()
            attributes.LayerIndex = self._layers[layer]
            geometry = one.Geometry.Duplicate()
            self.file.Objects.Delete(one.Attributes.Id)
            self.file.Objects.Add(geometry, attributes)
            if isinstance(geometry, rhino3dm.TextDot):
                self.dots.append((geometry.Text, geometry.Point))
        return before

    def ObjectColor(self, object_ids, color=None):
        layer = self.file.Layers[self._object(object_ids).Attributes.LayerIndex]
        return SimpleNamespace(**dict(zip("RGBA", layer.Color, strict=True)))

    def ObjectName(self, object_id, name=None):
        return self._object(object_id).Attributes.Name or None

    def GetUserText(self, object_id, key=None, attached_to_geometry=False):
        return self._object(object_id).Attributes.GetUserString(key) or None

    def GetString(self, message=None, defaultString=None, strings=None):
        for name in strings:
            assert name.isascii()
            assert name.isalnum()  # else Rhino takes no option of this name
            assert not name[0].isdigit()
        return self._answer(message)

    def GetInteger(self, message=None, number=None, minimum=None, maximum=None):
        return self._answer(message)

    def GetPoint(self, message=None, base_point=None, distance=None, in_plane=False):
        given = self._answer(message)
        return None if given is None else rhino3dm.Point3d(*given)

    def SaveFileName(self, title=None, filter=None, folder=None, filename=None, extension=None):
        given = self._answer(title)
        return None if given is None else str(given / filename)

    def DeleteObjects(self, object_ids):
        for one in object_ids:
            self.file.Objects.Delete(self._object(one).Attributes.Id)
        return len(object_ids)

    def AddMesh(
        self, vertices, face_vertices, vertex_normals=None, texture_coordinates=None,
        vertex_colors=None,
    ):  # fmt: skip
        mesh = rhino3dm.Mesh()
        for a, b, c in vertices:
            mesh.Vertices.Add(a, b, c)
        for face in face_vertices:
            mesh.Faces.AddFace(*face)
        assert len(vertex_colors) == len(vertices)
        for red, green, blue in vertex_colors:
            assert all(isinstance(part, int) for part in (red, green, blue))
            mesh.VertexColors.Add(red, green, blue)
        return self._added(mesh)

    def AddPolyline(self, points, replace_id=None):
        line = rhino3dm.Polyline()
        for point in points:
            line.Add(*point)
        return self._added(line.ToPolylineCurve())

    def AddTextDot(self, text, point):
        assert isinstance(text, str)
        return self._added(rhino3dm.TextDot(text, rhino3dm.Point3d(*point)))

    def _added(self, geometry):
        attributes = rhino3dm.ObjectAttributes()
        attributes.LayerIndex = self.layer("Default")
        return self.file.Objects.Add(geometry, attributes)

    def IsLayer(self, layer):
        return layer in self._layers

    def AddLayer(self, name=None, color=None, visible=True, locked=False, parent=None):
        self.layer(name)
        return name

    # scriptcontext.doc and Rhino.RhinoApp

    @property
    def ModelUnitSystem(self):
        return str(self.file.Settings.ModelUnitSystem).rpartition(".")[2]

    def BeginUndoRecord(self, name):
        self.records.append([name, False])
        return len(self.records) - 1

    def EndUndoRecord(self, number):
        self.records[number][1] = True
        return True

    def WriteLine(self, text):
        assert isinstance(text, str)
        self.written.append(text)


def installed(monkeypatch, rhino):
    """Make `import Rhino`, `rhinoscriptsyntax` and `scriptcontext` find a model."""
    syntax = types.ModuleType("rhinoscriptsyntax")
    for name in dir(Rhino):
        if name[0].isupper() and callable(getattr(rhino, name)):
            setattr(syntax, name, getattr(rhino, name))
    context = types.ModuleType("scriptcontext")
    context.doc = rhino
    app = types.ModuleType("Rhino")
    app.RhinoApp = rhino
    monkeypatch.setitem(sys.modules, "rhinoscriptsyntax", syntax)
    monkeypatch.setitem(sys.modules, "scriptcontext", context)
    monkeypatch.setitem(sys.modules, "Rhino", app)
