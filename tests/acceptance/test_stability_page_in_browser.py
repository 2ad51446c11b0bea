"""The page on a scene's stability, as a browser shows it."""

import numpy as np
import pytest
from headless_browser import HeadlessBrowser, find_browser
from held_samples import analyze_sample

from drake_haptics.analysis.stability_page import write_stability_page


def test_the_page_is_readable(tmp_path):
    executable = find_browser()
    if executable is None:
        pytest.skip("no Chromium on the PATH")
    path = tmp_path / "page.html"
    write_stability_page(analyze_sample(), "hammer_block", path)
    with HeadlessBrowser(executable) as browser:
        browser.open(path.as_uri())
        assert browser.evaluate("document.title") == "Stability of hammer_block"
        assert browser.evaluate("document.images[0].naturalWidth") > 1200
        # Nothing reaches beyond the window's side.
        assert browser.evaluate(
            "document.documentElement.scrollWidth <= window.innerWidth"
        )
        # Head and cells of each column begin or end at the same place.
        assert browser.evaluate(
            "[...document.querySelectorAll('table')].every(table => {"
            "  const rows = [...table.rows];"
            "  return [...rows[0].cells].every((head, i) => rows.every(row =>"
            "    getComputedStyle(row.cells[i]).textAlign"
            "      == getComputedStyle(head).textAlign));"
            "})"
        )
        assert browser.evaluate("document.querySelectorAll('table').length") == 4
        colors = browser.screenshot().reshape(-1, 3)
        # The verdict's green or yellow, and the picture further down.
        assert len(np.unique(colors, axis=0)) > 50
        assert browser.errors == []
