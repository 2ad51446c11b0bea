"""A page and its picture are two files."""

from pathlib import Path

import pytest

from drake_haptics.report.paths import check_page_path


@pytest.mark.parametrize("name", ["page.html", "page", "page.png.html"])
def test_a_page_may_be_called_so(name):
    check_page_path(Path("folder.png") / name)


def test_a_page_that_would_be_its_own_picture_is_refused():
    with pytest.raises(ValueError, match=r"page must not be called page\.png"):
        check_page_path(Path("folder") / "page.png")
