"""What tests in a browser share, and those of a driver in its own process."""

import pytest
from driver_process import WatchedLink
from headless_browser import find_browser


@pytest.fixture(scope="session")
def chromium():
    """The path of a Chromium; without one a test is skipped."""
    path = find_browser()
    if path is None:
        pytest.skip("no Chromium on the PATH")
    return path


@pytest.fixture
def link(device):
    """The way to a module's driver."""
    with WatchedLink(device.port) as link:
        yield link
    link.check_limits()
