"""The command `studio` as a user runs it: it starts, answers, and ends at once on Ctrl-C."""

import json
import signal
import socket
import subprocess
import sys
import urllib.request
from contextlib import contextmanager

import pytest

from simulearn.cli import studio
from simulearn.errors import InputError
from simulearn.grid import grid_to_dict, make
from simulearn.studio import serve

NAME = "AbCdEfGhIjKlMnOpQrS-_0"
LONG = 120.0  # s, far more than a start or an end takes
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="there is no Ctrl-C to send")


@contextmanager
def running(*words):
    """Run the command; yield the process and the address that it prints."""
    command = [sys.executable, "-m", "simulearn.cli", "studio", "--no-browser", *map(str, words)]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, encoding="utf-8"
    )
    try:
        line = process.stdout.readline()
        assert "http://" in line, (line, process.stderr.read() if not line else "")
        yield process, next(word for word in line.split() if word.startswith("http://"))
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()


def ended(process, by=signal.SIGINT):
    """Send a signal; return the exit code and what was printed since."""
    process.send_signal(by)
    out, err = process.communicate(timeout=LONG)
    return process.returncode, out, err


def put(address, path, body):
    request = urllib.request.Request(
        address + path,
        json.dumps(body).encode(),
        {"Content-Type": "application/json"},
        method="PUT",
    )
    with urllib.request.urlopen(request) as answer:
        return json.load(answer)


def get(address, path=""):
    with urllib.request.urlopen(address + path) as answer:
        return answer.read()


@pytest.fixture
def taken():
    """A port of this machine that another program listens on."""
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        yield other.getsockname()[1]


@POSIX
def test_it_starts_keeps_documents_through_a_restart_and_ends_at_once(tmp_path):
    document = {
        "schema": "simulearn.document/1",
        "name": "mine",
        "grid": grid_to_dict(make("saddle")),
        "goals": [],
        "printer": "ender-3",
    }
    with running("--port", 0, "--data", tmp_path) as (process, address):
        assert b"<html" in get(address)  # as soon as the address is printed
        body = {"revision": 0, "document": document}
        assert put(address, f"api/documents/{NAME}", body) == {"revision": 1}
        code, out, err = ended(process)
        assert (code, out, err) == (0, "", "stopped\n")
    port = address.rstrip("/").rpartition(":")[2]  # that was just given up
    with running("--port", port, "--data", tmp_path) as (process, address):
        saved = json.loads(get(address, f"api/documents/{NAME}"))
        assert saved == {"revision": 1, "document": document}
        begun = {"grids": [grid_to_dict(make("saddle", (5, 5)))]}
        request = urllib.request.Request(
            f"{address}api/fea", json.dumps(begun).encode(), {"Content-Type": "application/json"}
        )
        with urllib.request.urlopen(request) as answer:
            assert answer.status == 202
        code, out, err = ended(process, signal.SIGTERM)  # while a job runs
        assert (code, out, err) == (0, "", "stopped\n")


def test_a_port_that_was_named_and_is_taken(run, taken, tmp_path):
    code, out, err = run("studio", "--no-browser", "--port", taken, "--data", tmp_path)
    assert (code, out) == (1, "")
    assert f"port {taken} is taken" in err
    assert "without --port" in err


def test_a_port_that_is_not_allowed(run, monkeypatch, tmp_path):
    def refused(*address):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(socket.socket, "bind", refused)
    code, _, err = run("studio", "--no-browser", "--port", 80, "--data", tmp_path)
    assert code == 1
    assert "port 80 is not allowed" in err


@pytest.mark.parametrize("host", ["no such host", "192.0.2.1", "x" * 300])
def test_a_host_that_is_none_of_this_machine(run, host, tmp_path):
    code, _, err = run("studio", "--no-browser", "--host", host, "--data", tmp_path)
    assert code == 1
    assert "host" in err


def test_a_folder_that_cannot_be_written(run, tmp_path):
    (tmp_path / "file").write_text("")
    code, _, err = run("studio", "--no-browser", "--data", tmp_path / "file")
    assert code == 1
    assert "cannot be written" in err


def test_the_usual_port_being_taken_another_is_found(taken, monkeypatch):
    monkeypatch.setattr(serve, "PORT", taken)
    with serve.listen() as found:
        assert found.getsockname()[1] != taken
        assert serve.address_of(found) == f"http://127.0.0.1:{found.getsockname()[1]}/"
        assert serve.is_local(found)


def test_all_addresses_of_this_machine_are_not_only_its_own():
    with serve.listen("0.0.0.0", 0) as everywhere:
        assert not serve.is_local(everywhere)
        assert serve.address_of(everywhere).startswith("http://127.0.0.1:")


@pytest.fixture
def served(monkeypatch):
    """Let the server end as soon as it has started; return the settings that it was given."""
    given = []

    def stand_in(settings, listener, on_start):
        given.append(settings)
        on_start()
        return True

    monkeypatch.setattr(serve, "serve", stand_in)
    return given


def test_who_can_reach_it_is_said(run, served, tmp_path):
    words = ["--host", "0.0.0.0", "--allow", "studio.example", "--data", tmp_path / "new"]
    code, _, err = run("studio", "--no-browser", "--port", 0, *words)
    assert code == 0
    assert "without a password" in err
    (settings,) = served
    assert set(settings.hosts) == {"0.0.0.0", "studio.example"}
    assert settings.data == tmp_path / "new"
    run("studio", "--no-browser", "--port", 0, "--data", tmp_path)
    assert len(served) == 2


def test_the_browser_is_opened_once_the_server_answers(run, served, monkeypatch, tmp_path):
    opened = []
    monkeypatch.setattr(studio, "_open", opened.append)
    _, out, _ = run("studio", "--port", 0, "--data", tmp_path)
    assert opened == [next(word for word in out.split() if word.startswith("http://"))]
    run("studio", "--port", 0, "--no-browser", "--data", tmp_path)
    assert len(opened) == 1


def test_without_a_screen_no_browser_takes_the_terminal(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(studio.webbrowser, "open", lambda address: pytest.fail("it was opened"))
    studio._open("http://127.0.0.1:1/")


def test_a_package_that_is_missing_is_named(run, monkeypatch):
    for name in [name for name in sys.modules if name.startswith(("simulearn.studio", "uvicorn"))]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    code, _, err = run("studio", "--no-browser")
    assert code == 1
    assert "pip install 'simulearn[studio]'" in err


def test_a_server_imports_no_solver_before_it_answers():
    text = (
        "import sys; import simulearn.cli; from simulearn.studio import serve; "
        "from simulearn.studio.app import create_app; create_app(); "
        "heavy = {'jax', 'numba', 'matplotlib', 'skfem', 'trimesh', 'nicegui'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    out = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_errors_of_ports_name_the_port():
    with serve.listen(port=0) as listener, pytest.raises(InputError) as error:
        serve.listen(port=listener.getsockname()[1])
    assert (error.value.code, error.value.where) == ("port-taken", "port")
