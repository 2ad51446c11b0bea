"""The price list fits terminals of 80 and of 100 columns, figures whole."""

import io

import pytest
from accuracy_samples import make_peers, make_row, make_study
from rich.console import Console

from drake_haptics.cli.accuracy_output import print_study

LONG = make_row(
    "contact.[depth]",
    "tracked: the nearest way out [of two]",
    1234.0,
    123.0,
    2.5,
    is_scene=True,
    stiffness=511000.0,
)


@pytest.mark.parametrize("width", [80, 100])
def test_the_price_list_fits(width):
    stream = io.StringIO()
    console = Console(file=stream, width=width, highlight=False, markup=False)
    print_study(console, make_study(LONG, peers=make_peers()))
    text = stream.getvalue()
    assert max(len(line.rstrip()) for line in text.splitlines()) <= width
    assert "contact.[depth]" in text and "[of two]" in " ".join(text.split())
    (line,) = [line for line in text.splitlines() if "1234/2468" in line]
    assert line.split()[-7:] == [
        "1234/2468", "123", "2.500/10.000", "2500.0", "25.0", "2.500", "511000",
    ]  # fmt: skip
    # What a head of two words cannot say is said below.
    words = " ".join(text.split())
    assert "force, N: Difference of the force" in words
    assert "root mean square / largest" in words
