"""The pages of figures, as a browser shows them on a desk and on a phone."""

import time
from contextlib import closing

import numpy as np
import pytest
from accuracy_samples import make_peers, make_study
from headless_browser import HeadlessBrowser
from held_samples import analyze_sample
from mesh_samples import l_prism
from paper_samples import make_evaluation
from waiting import wait_until

from drake_haptics.analysis.stability_page import write_stability_page
from drake_haptics.evaluation.accuracy.page import write_accuracy_page
from drake_haptics.evaluation.paper.report import write_paper_page
from drake_haptics.geometry.decomposition.decompose import decompose
from drake_haptics.geometry.decomposition.viewer import DecompositionViewer
from drake_haptics.geometry.mesh.mesh import Mesh


@pytest.fixture(
    scope="module", params=[(1280, False), (390, True)], ids=["desk", "phone"]
)
def browser(chromium, request):
    width, is_phone = request.param
    with HeadlessBrowser(chromium) as browser:
        browser.resize(width, height=900, is_phone=is_phone)
        browser.is_phone = is_phone
        yield browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Holds the pages, which need no file beside them."""
    folder = tmp_path_factory.mktemp("pages")
    study = make_study(peers=make_peers())
    write_accuracy_page(study, folder / "accuracy.html", "cup_spoon")
    write_stability_page(analyze_sample(), "hammer_block", folder / "stability.html")
    write_paper_page(make_evaluation(), folder / "paper.html")
    result = decompose(Mesh.from_arrays(*l_prism()), cache=False)
    with closing(DecompositionViewer(result)) as viewer:
        viewer.write_html(folder / "pieces.html")
    for picture in folder.glob("*.png"):
        picture.unlink()
    return folder


def check_page(browser, path, *, tables, pixels=1200):
    """Opens a page and checks what is asked of each."""
    browser.open(path.as_uri())
    assert browser.evaluate("document.querySelectorAll('table').length") == tables
    # Nothing reaches beyond the window's side; what is wider scrolls by itself.
    assert browser.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    # The pictures' words can be read: none is shown at less than half its size.
    assert browser.evaluate(
        f"[...document.images].every(i => i.naturalWidth > {pixels} && i.width > 700)"
    )
    # Head and cells of each column begin or end at the same place.
    assert browser.evaluate(
        "[...document.querySelectorAll('table')].every(table => {"
        "  const rows = [...table.rows].filter(row => row.cells.length > 1);"
        "  return [...rows[0].cells].every((head, i) => rows.every(row =>"
        "    getComputedStyle(row.cells[i]).textAlign"
        "      == getComputedStyle(head).textAlign));"
        "})"
    )
    colors = browser.screenshot() @ [1 << 16, 1 << 8, 1]
    assert len(np.unique(colors)) > 50
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


def test_the_page_on_accuracy_is_readable(browser, folder):
    check_page(browser, folder / "accuracy.html", tables=2)
    assert browser.evaluate("document.title") == "What accuracy costs in cup_spoon"
    # A bar is as wide as its share of the cell says.
    assert browser.evaluate(
        "getComputedStyle(document.querySelector('td.bar.time')).backgroundSize"
    ).startswith("77.4%")
    # A shadow at the side says that there is more, and goes where there is not.
    assert (measure_right_edge(browser, 0) < 200.0) == browser.is_phone
    assert measure_right_edge(browser, 9999) > 235.0


def test_the_page_on_stability_is_readable(browser, folder):
    check_page(browser, folder / "stability.html", tables=4)
    assert browser.evaluate("document.title") == "Stability of hammer_block"


def test_the_page_on_the_papers_figures_is_readable(browser, folder):
    check_page(browser, folder / "paper.html", tables=8, pixels=900)
    assert browser.evaluate(
        "[...document.querySelectorAll('.mark')].every(m => m.scrollWidth <="
        " m.clientWidth && ['agrees', 'better', 'differs', 'not measured']"
        ".includes(m.innerText))"
    )


def test_the_pieces_of_a_mesh_are_seen_whole(browser, folder):
    browser.open((folder / "pieces.html").as_uri())

    def find_drawn():
        """Returns the columns below the caption that are not background alone."""
        seen = browser.screenshot()[120:].astype(int)
        return np.flatnonzero((np.ptp(seen, axis=2) > 40).any(axis=0))

    wait_until(lambda: len(find_drawn()) > 100, lambda: time.sleep(0.2))
    drawn, width = find_drawn(), browser.screenshot().shape[1]
    assert drawn[0] > 0 and drawn[-1] < width - 1
    assert np.ptp(drawn) > width / 3
    assert browser.errors == []
