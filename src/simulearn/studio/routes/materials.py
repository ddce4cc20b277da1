"""Materials that come with SimuLearn, and those that people bring."""

from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from pydantic import BaseModel, ConfigDict

from simulearn.errors import InputError
from simulearn.material import Material, load_material, material_text, materials_of, names
from simulearn.simulate.learned import Learned
from simulearn.studio.answers import Materials
from simulearn.studio.bodies import JsonRoute, OwnMaterials, json_response
from simulearn.studio.problems import Problem
from simulearn.studio.routes.designs import BUSY
from simulearn.studio.simulations import engine_of
from simulearn.studio.turns import Turns

MEDIA_TYPE = "application/toml"
TEXT: dict[int | str, Any] = {
    200: {"content": {MEDIA_TYPE: {"schema": {"type": "string"}}}, "description": "The material."},
    404: {"description": "No material of this name comes with SimuLearn."},
}

MaterialName = Annotated[str, Path(description="as /api/materials names it", max_length=80)]

router = APIRouter(route_class=JsonRoute, tags=["materials"])


class MaterialsBody(BaseModel):
    """The texts of materials, TOML."""

    model_config = ConfigDict(strict=True, extra="forbid")

    materials: OwnMaterials


@router.get("/api/materials", response_model=Materials)
def materials() -> Any:
    """Return the material systems that come with SimuLearn."""
    return _materials()


@router.get("/api/materials/{name}", response_class=Response, responses=TEXT)
async def text_of(name: MaterialName) -> Response:
    """Return the text of a material that comes with SimuLearn, to be changed and used."""
    if name not in names():
        text = f"no material of this name is known; known are {', '.join(names())}"
        raise Problem(404, "material-unknown", text, "name")
    return Response(material_text(name), media_type=MEDIA_TYPE)


@router.post("/api/materials", response_model=Materials, responses=BUSY)
async def own_materials(body: MaterialsBody, request: Request) -> Response:
    """Return the materials that some texts describe; they are read, not kept."""
    turns: Turns = request.app.state.turns
    return await turns.run(request, lambda _: json_response(_facts(body.materials)))


def _facts(texts: list[str]) -> dict[str, Any]:
    return {"materials": [facts_of(one) for one in materials_of(texts).values()]}


def facts_of(material: Material) -> dict[str, Any]:
    """Return what people want to know of a material before they use it, as plain data."""
    return {
        **material.model_dump(
            mode="json", include={"name", "title", "section", "limits", "scatter"}
        ),
        "strain": material.shrinkage.active,
        "curl": material.shrinkage.curl,
        "learned": _learned(material),
    }


def _learned(material: Material) -> dict[str, str]:
    """Return whether the default model answers for a material."""
    try:
        engine = engine_of("learned")
    except InputError as error:  # there is no model: finite elements answer all the same
        return {"knows": "no", "message": str(error)}
    remark = engine.remark(material) if isinstance(engine, Learned) else None
    if remark is None:
        return {"knows": "inside", "message": ""}
    knows = "outside" if remark.code == "material-beyond" else "no"
    return {"knows": knows, "message": remark.message}


@cache
def _materials() -> dict[str, Any]:
    return {"materials": [facts_of(load_material(name)) for name in names()]}
