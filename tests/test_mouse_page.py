"""The mouse's page is whole, and what is filled in cannot break out."""

import json
import re

from drake_haptics import colors
from drake_haptics.device.mouse_page import make_mouse_page


def read_settings(page):
    """What the page's program is given."""
    return json.loads(re.search(r"const settings = (.*);", page)[1])


def test_nothing_is_left_to_be_filled_in():
    page = make_mouse_page("http://localhost:7000", 8.5, 0.188)
    assert "$" not in page
    assert read_settings(page) == {
        "meshcat": "http://localhost:7000/?tracked_camera=on",
        "maxForce": 8.5,
        "maxTorque": 0.188,
    }


def test_every_colour_that_is_used_is_one_of_the_scheme():
    page = make_mouse_page("http://localhost:7000", 8.5, 0.188)
    given = set(re.findall(r"--([a-z]+): ", page))
    assert set(re.findall(r"var\(--([a-z]+)\)", page)) == given
    red, green, blue = (round(255 * x) for x in colors.COUPLING_LINE[:3])
    assert f"--force: rgb({red} {green} {blue} / 1)" in page


def test_an_address_cannot_end_the_program():
    address = 'http://localhost/"</script><script>alert(1)</script>'
    page = make_mouse_page(address, 1.0, 1.0)
    assert page.count("</script>") == 1
    assert read_settings(page)["meshcat"] == f"{address}/?tracked_camera=on"
