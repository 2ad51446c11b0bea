"""What is said of a page: where it is, and how to get there over ssh."""

import pytest

from drake_haptics.cli.console import describe_page


def test_at_the_computer_it_is_one_line(monkeypatch):
    monkeypatch.delenv("SSH_CONNECTION", raising=False)
    assert describe_page("http://localhost:7100/") == [
        "Open http://localhost:7100/ to see it."
    ]


@pytest.mark.parametrize("port", [7100, 7102])
def test_a_port_that_another_program_has_is_named(monkeypatch, port):
    monkeypatch.delenv("SSH_CONNECTION", raising=False)
    (line,) = describe_page(f"http://localhost:{port}/", wished_port=7100)
    assert ("Port 7100 is taken" in line) == (port != 7100)


def test_over_ssh_all_ports_are_brought_to_the_other_end(monkeypatch):
    monkeypatch.setenv("SSH_CONNECTION", "10.0.0.2 51000 10.0.0.9 22")
    _, how = describe_page("http://localhost:7101/", ["http://localhost:7003"])
    assert how.endswith("ssh -N -L 7101:localhost:7101 -L 7003:localhost:7003 10.0.0.9")
