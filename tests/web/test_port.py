"""The page's port is one that nobody else has."""

import socket

import pytest

from drake_haptics.common.errors import HapticsError
from drake_haptics.web import link as page_port
from drake_haptics.web.link import FIRST_PORT, open_page_port


def test_the_first_free_one_is_taken(monkeypatch):
    # Where no other program takes any meanwhile.
    with socket.create_server(("127.0.0.1", 0)) as taken:
        monkeypatch.setattr(page_port, "FIRST_PORT", taken.getsockname()[1])
        with open_page_port() as found:
            assert found.getsockname()[1] > taken.getsockname()[1]


def test_it_is_one_of_those_that_are_said():
    with open_page_port() as found:
        assert 7100 == FIRST_PORT <= found.getsockname()[1] < 7200


def test_a_port_in_use_is_refused_with_what_to_do():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(HapticsError, match=rf"port {port} .*Give another one"):
            open_page_port(port)


@pytest.mark.parametrize("port", [-1, 70_000])
def test_a_port_that_is_none_is_refused(port):
    with pytest.raises(HapticsError, match="Give another one"):
        open_page_port(port)


def test_others_on_the_network_do_not_see_it():
    with open_page_port() as listener:
        assert listener.getsockname()[0] == "127.0.0.1"
