"""A server that is slow, away, or asked by a foreign page."""

import re
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

import pytest
from playwright.sync_api import expect

import gestures as do

SIMULATE = "**/api/simulate"
TOP = (32, 65)  # mm, on beam 11


def shown(page):
    """Return what the page says of the shape: how far it rises, and its size."""
    words = do.shape(page).locator(".shape-title, .shape-size")
    return [text.strip() for text in words.all_inner_texts()]


def test_the_last_change_wins_over_slow_answers(page, studio):
    do.opened(page, studio.url)
    before = shown(page)
    waiting = []
    page.route(SIMULATE, lambda route: waiting.append(route))
    do.click(page, TOP)
    with page.expect_request(SIMULATE):
        page.keyboard.press("-")
    do.says(page, "Updating…")
    expect(do.shape(page).get_by_text("updating", exact=True)).to_be_visible()
    page.keyboard.press("-")
    page.keyboard.press("-")
    assert len(waiting) == 1  # one question at a time
    with page.expect_request(SIMULATE):
        waiting.pop().continue_()
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("25 % top"))
    do.says(page, "Updating…")  # what has come is of an earlier design
    waiting.pop().continue_()
    do.simulated(page)
    do.saved(page)
    other = do.opened(page.context.new_page(), page.url)  # simulates the last design alone
    assert shown(page) == shown(other) != before
    expect(do.shape(page).get_by_text("updating", exact=True)).to_be_hidden()


def test_an_edit_undone_at_once_is_saved(page, studio):
    do.opened(page, studio.url)
    page.get_by_label("Name of the design").fill("Mine")
    do.saved(page)
    do.click(page, TOP)
    page.keyboard.press("-")
    page.keyboard.press("Control+z")
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("100 % top"))
    do.saved(page)


def test_without_a_server_work_goes_on(page, studio, forgiven):
    do.opened(page, studio.url)
    page.get_by_label("Name of the design").fill("Away")
    do.saved(page)
    forgiven.append("ERR_INTERNET_DISCONNECTED")
    page.context.set_offline(True)
    do.click(page, TOP)
    page.keyboard.press("-")
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("75 % top"))
    expect(do.status(page)).to_contain_text("Server offline")
    do.says(page, "Waiting for the server")
    expect(page.get_by_role("banner").get_by_text("Offline: kept in this browser")).to_be_visible()
    length = page.get_by_label("Length of beam 11")
    length.fill("7")  # and not yet entered
    page.context.set_offline(False)
    do.simulated(page)
    do.saved(page)
    expect(do.status(page)).not_to_contain_text("Server offline")
    expect(length).to_be_focused()
    expect(length).to_have_value("7")
    length.press_sequentially("0")
    length.press("Enter")
    do.placed(do.beam(page, 11), 70)
    do.saved(page)


def test_what_was_drawn_offline_is_there_after_a_reload(page, studio, forgiven):
    forgiven.append("ERR_FAILED")
    do.opened(page, studio.url)
    page.get_by_label("Name of the design").fill("Before")
    do.saved(page)
    page.route("**/api/documents/**", lambda route: route.abort())
    do.click(page, TOP)
    page.keyboard.press("-")
    expect(page.get_by_text("Offline: kept in this browser").first).to_be_visible()
    page.reload()
    expect(do.beam(page, 11)).to_have_accessible_name(re.compile("75 % top"))
    page.unroute("**/api/documents/**")
    do.saved(page)


@pytest.fixture
def foreign():
    """The address of a page of another site on this machine."""

    class Empty(BaseHTTPRequestHandler):
        def do_GET(self):
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<!doctype html><title>foreign</title>")

        def log_message(self, *_):
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Empty)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()
    server.server_close()
    thread.join()


@pytest.mark.parametrize("kind", ["text/plain", "application/json"])
def test_a_foreign_page_changes_nothing(page, studio, foreign, forgiven, kind):
    forgiven += ["CORS policy", "ERR_FAILED", "status of 403"]
    page.goto(foreign)
    statuses = []
    page.on("response", lambda response: statuses.append(response.status))
    ask = """async ([url, kind]) => {
      try {
        await fetch(url, { method: "POST", body: "{}", headers: { "Content-Type": kind } });
        return "answered";
      } catch (error) {
        return error.name;
      }
    }"""
    assert page.evaluate(ask, [f"{studio.url}/api/simulate", kind]) == "TypeError"
    assert 200 not in statuses
