"""Documents that the page saves by itself, each under a name that the page has made."""

from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from pydantic import BaseModel, ConfigDict, Field, SkipValidation

from simulearn.studio.bodies import JsonRoute, json_response
from simulearn.studio.documentfile import DocumentFile
from simulearn.studio.documents import Documents
from simulearn.studio.problems import ProblemBody

Name = Annotated[str, Path(description="22 characters of A-Z, a-z, 0-9, - and _", max_length=64)]
Revision = Annotated[int, Field(ge=0, lt=2**53)]

router = APIRouter(route_class=JsonRoute, tags=["documents"])


class SaveBody(BaseModel):
    """A document, and the revision that it was made from: 0 for a new one."""

    model_config = ConfigDict(strict=True, extra="forbid")

    revision: Revision
    document: Annotated[DocumentFile, SkipValidation]


class DocumentSaved(BaseModel):
    """The revision that was saved."""

    revision: int


class DocumentAnswer(DocumentSaved):
    """A saved document."""

    document: DocumentFile


class ChangedElsewhere(ProblemBody):
    """The newer document that another window has saved."""

    revision: int
    document: DocumentFile


@router.get(
    "/api/documents/{name}",
    response_model=DocumentAnswer,
    responses={404: {"description": "No document of this name is saved."}},
)
def read(name: Name, request: Request) -> Response:
    """Return a saved document."""
    documents: Documents = request.app.state.documents
    saved = documents.read(name)
    return _answer({"revision": saved.revision, "document": saved.document})


@router.put(
    "/api/documents/{name}",
    response_model=DocumentSaved,
    responses={
        404: {"description": "A document cannot have this name."},
        409: {"description": "Another window has saved since; `document` is the newer one."},
        507: {"description": "The server keeps no more, or its folder cannot be written."},
    },
)
def save(name: Name, body: SaveBody, request: Request) -> Response:
    """Save a document, unless another window has saved since it was opened."""
    documents: Documents = request.app.state.documents
    return _answer({"revision": documents.write(name, body.revision, body.document)})


def _answer(content: object) -> Response:
    response = json_response(content)
    response.headers["Cache-Control"] = "no-store"
    return response
