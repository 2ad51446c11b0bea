"""What tests in a browser share."""

import pytest
from headless_browser import find_browser


@pytest.fixture(scope="session")
def chromium():
    """The path of a Chromium; without one a test is skipped."""
    path = find_browser()
    if path is None:
        pytest.skip("no Chromium on the PATH")
    return path
