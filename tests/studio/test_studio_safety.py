"""What keeps foreign pages and endless requests away from the studio."""

import json
import re

import pytest
from asking import Client, awaited, problem, raw

from simulearn.studio.safety import HEADERS
from simulearn.studio.settings import Settings

GRID = {"joints": []}


@pytest.fixture(scope="module")
def client():
    return Client()


@pytest.mark.parametrize(
    "host", ["localhost", "LOCALHOST:8000", "127.0.0.1", "127.0.0.1:9999", "[::1]", "[::1]:80"]
)
def test_own_names_are_answered(client, host):
    assert client.get("/api/version", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "localhost.evil.example", "127.0.0.1.evil.example:8000", "192.168.1.7", "",
     "evil.example:127.0.0.1", "localhost@evil.example", "0.0.0.0", "[::2]", "::1evil"],
)  # fmt: skip
@pytest.mark.parametrize("path", ["/", "/api/version", "/page/main.js", "/libraries/vue.js"])
def test_foreign_names_are_refused(client, path, host):
    problem(client.get(path, headers={"Host": host}), 400, "host")


def test_the_operator_names_more_hosts():
    served = Client(Settings(hosts=("Studio.Example",)))
    assert served.get("/", headers={"Host": "studio.example:80"}).status_code == 200
    problem(served.get("/", headers={"Host": "192.168.1.7"}), 400, "host")
    open_to_all = Client(Settings(hosts=("0.0.0.0",)))
    assert open_to_all.get("/", headers={"Host": "192.168.1.7:8000"}).status_code == 200
    problem(open_to_all.get("/", headers={"Host": "evil.example"}), 400, "host")


def test_two_hosts_are_none(client):
    headers = [("Host", "localhost"), ("Host", "evil.example")]
    problem(client.request("GET", "/", headers=headers), 400, "host")


FOREIGN = [
    {"Origin": "http://evil.example"},
    {"Origin": "null"},
    {"Origin": "http://127.0.0.1:9000"},  # another port of this machine
    {"Origin": "http://localhost:8000"},  # another name of it
    {"Origin": "http://[bad"},
    {"Sec-Fetch-Site": "cross-site"},
    {"Sec-Fetch-Site": "same-site"},
    {"Origin": "http://127.0.0.1:8000", "Sec-Fetch-Site": "cross-site"},
]


@pytest.mark.parametrize("headers", FOREIGN)
@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH"])
def test_foreign_pages_change_nothing(client, method, headers):
    answer = client.request(method, "/api/validate", json=GRID, headers=headers)
    problem(answer, 403, "foreign-origin")


@pytest.mark.parametrize(
    "headers",
    [{}, {"Origin": "http://127.0.0.1:8000"}, {"Sec-Fetch-Site": "none"},
     {"Origin": "http://127.0.0.1:8000", "Sec-Fetch-Site": "same-origin"}],
)  # fmt: skip
def test_our_page_and_programs_are_answered(client, headers):
    assert client.post("/api/validate", GRID, headers=headers).status_code == 200


def test_a_link_from_another_page_opens_ours(client):
    headers = {"Sec-Fetch-Site": "cross-site", "Sec-Fetch-Mode": "navigate"}
    assert client.get("/", headers=headers).status_code == 200


def test_other_pages_read_nothing(client):
    answer = client.get("/api/version", headers={"Origin": "http://evil.example"})
    assert "access-control-allow-origin" not in answer.headers
    headers = {"Origin": "http://evil.example", "Access-Control-Request-Method": "POST"}
    problem(client.request("OPTIONS", "/api/simulate", headers=headers), 405, "method")


@pytest.mark.parametrize("path", ["/", "/d/abc", "/api/version", "/page/main.js", "/nothing"])
def test_every_answer_has_the_headers(client, path):
    answer = client.get(path)
    for key, value in HEADERS.items():
        assert answer.headers[key] == value
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy


def test_refusals_have_the_headers(client):
    answer = client.get("/", headers={"Host": "evil.example"})
    assert answer.headers["content-security-policy"]


def test_a_body_too_large_is_refused_by_its_length():
    small = Client(Settings(body_bytes=1000))
    problem(small.post_text("/api/validate", b" " * 1001), 413, "too-large")
    assert small.post_text("/api/validate", b"{}" + b" " * 998).status_code == 200


@pytest.mark.parametrize("length", ["-1", "1e3", "99999999999999999999999", "²"])
def test_a_length_that_is_none(client, length):
    answer = client.post_text(
        "/api/validate", b"{}", **{"Content-Length": length.encode("latin-1")}
    )
    assert answer.status_code in (400, 413)
    problem(answer, answer.status_code)


def test_a_body_too_large_is_refused_while_it_arrives():
    small = Client(Settings(body_bytes=1000))
    sent = 0

    async def pieces():
        nonlocal sent
        for _ in range(1000):
            sent += 1
            yield b" " * 100

    answer = small.post_text("/api/validate", pieces())
    problem(answer, 413, "too-large")
    assert sent <= 12  # the rest is not read


def test_files_may_be_larger_than_other_bodies():
    small = Client(Settings(body_bytes=1000, file_bytes=5000))
    headers = {"Content-Type": "application/octet-stream"}
    answer = small.post("/api/open?name=a.json", content=b" " * 4000, headers=headers)
    assert answer.status_code != 413
    answer = small.post("/api/open?name=a.json", content=b" " * 5001, headers=headers)
    problem(answer, 413, "too-large")


@pytest.mark.parametrize(
    "path",
    ["/page/../app.py", "/page/%2e%2e/app.py", "/page/..%2fapp.py", "/libraries/../page/main.js",
     "/page//etc/passwd", "/page/%00", "/libraries/%2fetc%2fpasswd", "/page/"],
)  # fmt: skip
def test_only_files_of_the_page_are_served(client, path):
    plain = re.sub("%(..)", lambda found: chr(int(found[1], 16)), path)
    events = awaited(raw(client.app, "GET", plain, [{"type": "http.request"}]))
    assert events[0]["status"] == 404
    assert json.loads(events[1]["body"])["code"] == "not-found"


def test_files_of_the_page_are_always_the_newest(client):
    first = client.get("/page/main.js")
    assert first.headers["content-type"] == "text/javascript; charset=utf-8"
    assert first.headers["cache-control"] == "no-cache"
    again = client.get("/page/main.js", headers={"If-None-Match": first.headers["etag"]})
    assert again.status_code == 304
    assert again.headers["cache-control"] == "no-cache"
    assert again.content == b""


def test_libraries_are_kept_by_the_browser(client):
    for name in ("vue.js", "three.js"):
        answer = client.get(f"/libraries/{name}")
        assert answer.headers["content-type"] == "text/javascript; charset=utf-8"
        assert "max-age" in answer.headers["cache-control"]
        assert len(answer.content) > 100_000


@pytest.mark.parametrize("path", ["/", "/d/0123456789abcdefghijk_"])
def test_the_page_is_served(client, path):
    answer = client.get(path)
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert answer.headers["cache-control"] == "no-cache"
    assert '<div id="studio">' in answer.text
