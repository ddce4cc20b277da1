"""Documents that the page saves: kept through a restart, never overwritten unseen, never lost."""

import copy
import json
import os
import threading

import pytest
from asking import Client, problem

from simulearn.grid import grid_to_dict, make
from simulearn.studio.settings import Settings

NAME = "AbCdEfGhIjKlMnOpQrS-_0"
DOCUMENT = {
    "schema": "simulearn.document/1",
    "name": "Sättel 日本",
    "grid": grid_to_dict(make("saddle")),
    "goals": [{"vertex": ["beam", 3, "middle", 2], "target": [1, 2, 3.5], "weight": 1}],
    "printer": "ender-3",
}

EMPTY = DOCUMENT["grid"] | {"joints": [], "beams": [], "actuators": [], "fixed": 0}


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "data" / "studio"  # made when the first document is saved


@pytest.fixture
def client(folder):
    return Client(Settings(data=folder))


def save(client, revision, document=DOCUMENT, name=NAME):
    body = {"revision": revision, "document": document}
    return client.request("PUT", f"/api/documents/{name}", json=body)


def changed(path, value):
    document = copy.deepcopy(DOCUMENT)
    at = document
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return document


def test_a_document_is_there_after_a_restart(client, folder):
    problem(client.get(f"/api/documents/{NAME}"), 404, "document-unknown")
    assert save(client, 0).json() == {"revision": 1}
    assert save(client, 1, changed(["name"], "two")).json() == {"revision": 2}
    again = Client(Settings(data=folder))
    answer = again.get(f"/api/documents/{NAME}")
    assert answer.json() == {"revision": 2, "document": changed(["name"], "two")}
    assert answer.headers["cache-control"] == "no-store"
    assert save(again, 2).json() == {"revision": 3}
    assert [path.name for path in folder.glob("*.json")] == [f"{NAME}.json"]


def test_without_a_folder_documents_last_as_long_as_the_server():
    client = Client(Settings(data=None))
    assert save(client, 0).json() == {"revision": 1}
    assert client.get(f"/api/documents/{NAME}").json()["document"] == DOCUMENT


def test_another_windows_change_is_not_overwritten(client):
    save(client, 0)
    theirs = changed(["name"], "theirs")
    assert save(client, 1, theirs).json() == {"revision": 2}
    body = problem(save(client, 1, changed(["name"], "mine")), 409, "changed-elsewhere")
    assert (body["revision"], body["document"]) == (2, theirs)
    assert save(client, body["revision"], changed(["name"], "mine")).json() == {"revision": 3}


def test_saving_again_what_is_saved_is_no_conflict(client):
    save(client, 0)
    assert save(client, 0).json() == {"revision": 1}  # the first answer was lost on its way


def test_a_document_whose_file_is_gone_goes_on_where_its_page_is(client, folder):
    save(client, 0)
    (folder / f"{NAME}.json").unlink()
    assert save(client, 5).json() == {"revision": 6}


def test_of_many_at_once_one_comes_through(client):
    save(client, 0)
    statuses = []

    def save_changed(k):
        statuses.append(save(client, 1, changed(["name"], f"window {k}")).status_code)

    threads = [threading.Thread(target=save_changed, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(statuses) == [200] + [409] * 7


@pytest.mark.parametrize(
    "name",
    ["..%2F..%2Fetc%2Fpasswd", "a" * 21, "a" * 23, "a" * 21 + ".", "a" * 21 + "%0A", "é" * 22],
)
def test_a_name_that_is_none_touches_no_file(client, folder, name):
    problem(client.get(f"/api/documents/{name}"), 404)
    problem(save(client, 0, name=name), 404)
    assert not folder.exists()


@pytest.mark.parametrize(
    "document",
    [
        DOCUMENT | {"goals": [], "grid": EMPTY},
        changed(["grid", "joints"], [[0.0, 0.0]] * 9),
        changed(["grid", "material"], "of another place"),
    ],
)
def test_a_drawing_may_be_half_done(client, document):
    assert save(client, 0, document).json() == {"revision": 1}
    assert client.get(f"/api/documents/{NAME}").json()["document"] == document


@pytest.mark.parametrize(
    ("path", "value", "where"),
    [
        (["schema"], "simulearn.document/2", "schema"),
        (["grid", "joints", 3], [1.0], "grid.joints[3]"),
        (["grid", "joints", 3, 0], "1", "grid.joints[3][0]"),
        (["grid", "joints", 3, 0], 1e9, "grid.joints[3][0]"),
        (["grid", "beams", 2], [0, 9], "grid.beams[2]"),
        (["grid", "actuators"], [], "grid.actuators"),
        (["grid", "actuators", 0], 1.5, "grid.actuators[0]"),
        (["grid", "fixed"], 9, "grid.fixed"),
        (["grid", "material"], "/etc/passwd", "grid.material"),
        (["goals", 0, "vertex"], ["joint", 9, "centre"], "goals[0].vertex"),
        (["goals", 0, "target"], [1, 2], "goals[0].target"),
        (["name"], "x" * 201, "name"),
        (["name"], "\ud800", "name"),
        (["more"], 1, "more"),
        (["printer"], 5, "printer"),
        (["printer"], "x" * 81, "printer"),
        (["printer"], {"path": "/etc/passwd"}, "printer.profile"),
        (["printer"], {"profile": "x" * (2**16 + 1)}, "printer.profile"),
    ],
)
def test_what_is_no_document_is_refused(client, folder, path, value, where):
    text = json.dumps({"revision": 0, "document": changed(path, value)})
    kind = {"Content-Type": "application/json"}
    answer = client.request("PUT", f"/api/documents/{NAME}", content=text, headers=kind)
    assert problem(answer, 422, "document")["where"] == where
    assert not folder.exists()


def test_a_document_that_is_too_large_is_refused(folder):
    client = Client(Settings(data=folder, document_bytes=500))
    body = problem(save(client, 0), 413, "document-too-large")
    assert "MiB" in body["detail"]


def test_no_more_documents_than_allowed_and_none_is_deleted(folder):
    client = Client(Settings(data=folder, documents=2))
    names = [f"{k}" * 22 for k in range(3)]
    assert [save(client, 0, name=name).status_code for name in names[:2]] == [200, 200]
    body = problem(save(client, 0, name=names[2]), 507, "documents-full")
    assert str(folder) in body["detail"]
    assert save(client, 1, changed(["name"], "more"), names[0]).json() == {"revision": 2}
    assert len(list(folder.glob("*.json"))) == 2


def test_a_folder_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    client = Client(Settings(data=tmp_path / "file" / "studio"))
    body = problem(save(client, 0), 507, "not-writable")
    assert "cannot be" in body["detail"]
    problem(client.get(f"/api/documents/{NAME}"), 404, "document-unknown")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write")
def test_a_folder_without_permission(folder):
    folder.mkdir(parents=True)
    folder.chmod(0o500)
    problem(save(Client(Settings(data=folder)), 0), 507, "not-writable")


def test_a_full_disk_leaves_the_document_as_it_was(client, folder, monkeypatch):
    save(client, 0)

    def full(handle):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        body = problem(save(client, 1, changed(["name"], "two")), 507, "not-writable")
    assert "No space left" in body["detail"]
    assert client.get(f"/api/documents/{NAME}").json() == {"revision": 1, "document": DOCUMENT}
    assert not [path for path in folder.iterdir() if path.name not in (f"{NAME}.json", ".lock")]


@pytest.mark.parametrize("text", ["", "{", "[]", '{"schema": "simulearn.saved/1", "revision": 1}'])
def test_a_damaged_file_is_said_and_not_replaced(client, folder, text):
    save(client, 0)
    path = folder / f"{NAME}.json"
    path.write_text(text)
    body = problem(client.get(f"/api/documents/{NAME}"), 500, "document-damaged")
    assert str(path) in body["detail"]
    problem(save(client, 1, changed(["name"], "two")), 500, "document-damaged")
    assert path.read_text() == text
