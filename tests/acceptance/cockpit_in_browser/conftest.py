"""A run of the cockpit and its page in a browser, for all tests of a file.

The tests of a file go on from one another.
"""

import pytest
from cockpit_page import PRESS, CockpitRun, Page
from headless_browser import HeadlessBrowser

# Fewer pixels: without a graphics card each takes its time.
WIDE = {"width": 1200, "height": 750, "deviceScaleFactor": 0.75, "mobile": False}
# Keeps the page's way to the run, so that a test can put words into it.
HOOK = """
  window.ways = [];
  const Way = window.WebSocket;
  window.WebSocket = class extends Way {
    constructor(url) { super(url); ways.push(this); }
  };
"""


@pytest.fixture(scope="module")
def run(chromium, tmp_path_factory):
    """The ball that is pressed onto the block."""
    file = tmp_path_factory.mktemp("cockpit") / "press.yaml"
    file.write_text(PRESS)
    run = CockpitRun(file)
    yield run
    run.close()


@pytest.fixture(scope="module")
def page(chromium, run):
    """Its page, open."""
    with HeadlessBrowser(chromium) as browser:
        browser.call("Emulation.setDeviceMetricsOverride", **WIDE)
        browser.call("Page.addScriptToEvaluateOnNewDocument", source=HOOK)
        browser.open(run.url)
        page = Page(browser)
        page.wait_for("document.getElementById('gate').className == 'chip simulated'")
        page.evaluate("document.querySelectorAll('.panel').forEach(p => p.open = true)")
        yield page
