"""Meshcat's pages are completed, whatever else is in them."""

from drake_haptics.common.web_page import extend_page


def test_a_page_is_as_wide_as_its_screen_and_has_more_at_its_end():
    page = "<html><head><title>x</title></head><body><p>scene</p></body></html>"
    done = extend_page(page, "<p>legend</p>")
    assert done.index("<head>") < done.index("device-width") < done.index("<title>")
    assert done.endswith("<p>scene</p><p>legend</p></body></html>")
