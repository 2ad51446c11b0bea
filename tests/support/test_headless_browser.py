"""The browser that tests look through stands a page that goes while it is asked."""

import functools
import http.server
import threading

import pytest
from headless_browser import HeadlessBrowser, PageGoneError, find_browser


class Server(http.server.SimpleHTTPRequestHandler):
    """Serves a folder without a word."""

    def log_message(self, format, *args):
        """Nothing to tell."""


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """One with a page; only one that is served can load itself again."""
    if find_browser() is None:
        pytest.skip("no Chromium on the PATH")
    folder = tmp_path_factory.mktemp("page")
    (folder / "index.html").write_text("<p>A page.</p>")
    serve = functools.partial(Server, directory=folder)
    server = http.server.ThreadingHTTPServer(("localhost", 0), serve)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with HeadlessBrowser(find_browser()) as browser:
        browser.open(f"http://localhost:{server.server_port}/")
        yield browser
    server.shutdown()
    server.server_close()


def test_a_page_that_goes_before_it_answers_is_told_from_other_failures(browser):
    with pytest.raises(PageGoneError):
        browser.call(
            "Runtime.evaluate",
            expression="location.reload(); new Promise(() => 0)",
            awaitPromise=True,
        )
    with pytest.raises(RuntimeError) as caught:
        browser.evaluate("nothing.there")
    assert caught.type is RuntimeError


def test_waiting_goes_on_over_a_change_of_page(browser, monkeypatch):
    browser.evaluate("window.isOld = true")
    ask = browser.evaluate

    def ask_a_page_that_goes(expression):
        """The first question is never answered."""
        monkeypatch.setattr(browser, "evaluate", ask)
        return browser.call(
            "Runtime.evaluate",
            expression="location.reload(); new Promise(() => 0)",
            awaitPromise=True,
        )

    monkeypatch.setattr(browser, "evaluate", ask_a_page_that_goes)
    browser.wait_for("!window.isOld")
    assert browser.evaluate("document.readyState") in ("interactive", "complete")
