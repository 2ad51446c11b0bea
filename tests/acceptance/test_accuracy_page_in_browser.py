"""The page on accuracy, as a browser shows it on a desk and on a phone."""

import numpy as np
import pytest
from accuracy_samples import make_peers, make_study
from headless_browser import HeadlessBrowser, find_browser

from drake_haptics.evaluation.accuracy.page import write_accuracy_page


@pytest.mark.parametrize(("width", "is_phone"), [(1280, False), (390, True)])
def test_the_page_is_readable(tmp_path, width, is_phone):
    executable = find_browser()
    if executable is None:
        pytest.skip("no Chromium on the PATH")
    path = tmp_path / "page.html"
    write_accuracy_page(make_study(peers=make_peers()), path, "cup_spoon")
    path.with_suffix(".png").unlink()  # the page needs nothing beside it
    with HeadlessBrowser(executable) as browser:
        browser.resize(width, height=900, is_phone=is_phone)
        browser.open(path.as_uri())
        assert browser.evaluate("document.title") == "What accuracy costs in cup_spoon"
        assert browser.evaluate("document.images[0].naturalWidth") > 1200
        # Nothing reaches beyond the window's side; what is wider scrolls by itself.
        assert browser.evaluate(
            "document.documentElement.scrollWidth <= window.innerWidth"
        )
        # The picture's words can be read: it is never shown at half its size.
        assert browser.evaluate("document.images[0].clientWidth") > 700
        # Head and cells of each column begin or end at the same place.
        assert browser.evaluate(
            "[...document.querySelectorAll('table')].every(table => {"
            "  const rows = [...table.rows].filter(row => row.cells.length > 1);"
            "  return [...rows[0].cells].every((head, i) => rows.every(row =>"
            "    getComputedStyle(row.cells[i]).textAlign"
            "      == getComputedStyle(head).textAlign));"
            "})"
        )
        # A bar is as wide as its share of the cell says.
        assert browser.evaluate(
            "getComputedStyle(document.querySelector('td.bar.time')).backgroundSize"
        ).startswith("77.4%")
        colors = browser.screenshot().reshape(-1, 3)
        assert len(np.unique(colors, axis=0)) > 50
        # A shadow at the side says that there is more, and goes where there is not.
        assert (measure_right_edge(browser, 0) < 200.0) == is_phone
        assert measure_right_edge(browser, 9999) > 235.0
        assert browser.errors == []


def measure_right_edge(browser, scrolled):
    """Returns how bright, of 255, the corner of a picture is that scrolls sideways."""
    x, y = browser.evaluate(
        "(picture => {"
        f"  picture.scrollLeft = {scrolled};"
        "  const box = picture.getBoundingClientRect();"
        "  return [box.right, box.top].map(Math.floor);"
        "})(document.querySelector('.wide'))"
    )
    return browser.screenshot(x - 3, y + 1, 2, 2).mean()
