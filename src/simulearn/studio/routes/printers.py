"""Printers that come with SimuLearn, and profiles that people bring."""

from functools import cache
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from pydantic import BaseModel, ConfigDict

from simulearn.errors import InputError
from simulearn.fabricate import (
    Printer,
    load_printer,
    model_number,
    printers,
    profile_text,
    read_profile,
)
from simulearn.material import load_material
from simulearn.studio.answers import PrinterFacts, Printers
from simulearn.studio.bodies import JsonRoute, json_response
from simulearn.studio.problems import Problem
from simulearn.studio.routes.designs import BUSY
from simulearn.studio.turns import Turns

MATERIAL = "pla-hot-water"  # whose nozzle a printer has that does not name its own
MEDIA_TYPE = "application/toml"
PROFILE: dict[int | str, Any] = {
    200: {"content": {MEDIA_TYPE: {"schema": {"type": "string"}}}, "description": "The profile."},
    404: {"description": "No printer of this name comes with SimuLearn."},
}

PrinterName = Annotated[str, Path(description="as /api/printers names it", max_length=80)]

router = APIRouter(route_class=JsonRoute, tags=["prints"])


class ProfileBody(BaseModel):
    """The text of a printer's profile, TOML."""

    model_config = ConfigDict(strict=True, extra="forbid")

    profile: str


@router.get("/api/printers", response_model=Printers)
async def printers_() -> Any:
    """Return the printers that come with SimuLearn."""
    return _printers()


@router.get("/api/printers/{name}", response_class=Response, responses=PROFILE)
async def profile_of(name: PrinterName) -> Response:
    """Return the profile of a printer that comes with SimuLearn, to be changed and used."""
    if name not in printers():
        text = f"no printer of this name is known; known are {', '.join(printers())}"
        raise Problem(404, "printer-unknown", text, "name")
    return Response(profile_text(name), media_type=MEDIA_TYPE)


@router.post("/api/profile", response_model=PrinterFacts, responses=BUSY)
async def profile(body: ProfileBody, request: Request) -> Response:
    """Return the printer that a profile describes; it is read, not kept."""
    turns: Turns = request.app.state.turns
    return await turns.run(request, lambda _: json_response(facts_of(read_profile(body.profile))))


def chosen(printer: str | None, profile: str | None) -> Printer:
    """Return the printer of a request, which names one or brings its profile.

    Raises:
        InputError: there is none, there are two, its name is unknown, or its profile is wrong.
    """
    if (printer is None) == (profile is None):
        text = "give printer, the name of one, or profile, the text of one; not both"
        raise InputError(text, "printer", "printer")
    if profile is not None:
        return read_profile(profile)
    if printer not in printers():
        text = f'printer "{printer}" is not known; known are {", ".join(printers())}'
        raise InputError(text, "printer-unknown", "printer")
    return load_printer(printer)


def facts_of(printer: Printer) -> dict[str, Any]:
    """Return what people want to know of a printer before they print, as plain data."""
    return {
        "name": printer.name,
        "title": printer.title,
        "firmware": printer.firmware,
        "sources": printer.sources,
        "tried": printer.tried,
        "formats": _formats(printer),
        "bed": printer.bed.model_dump(mode="json"),
        "reach": printer.reach.model_dump(mode="json"),
        "nozzle": printer.print.get("nozzle", load_material(MATERIAL).print.nozzle),
        "filament": printer.extruder.filament,
        "nozzle_most": printer.temperature.nozzle_most,
        "bed_most": printer.temperature.bed_most,
    }


def _formats(printer: Printer) -> list[str]:
    """Return the endings of the files that a printer takes."""
    try:
        model_number(printer)
    except InputError:
        return ["gcode"]
    return ["gcode.3mf", "gcode"]


@cache
def _printers() -> dict[str, Any]:
    return {"printers": [facts_of(load_printer(name)) for name in printers()]}
