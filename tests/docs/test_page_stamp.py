"""Each page with figures says at which commit they were made; one command makes all."""

from __future__ import annotations

import re
import subprocess

import page_stamp
import pytest
from make_figures import FIGURES
from page_stamp import (
    ROOT,
    STAMP,
    describe_commit,
    make_stamp,
    with_amendment,
    with_stamp,
)

# Sums up other pages, and measures nothing.
SUMS = "docs/generate/numerics_table.py"
MADE = {figures.generator: figures for figures in FIGURES}


@pytest.mark.parametrize("generator", sorted(MADE.keys() - {SUMS}))
def test_a_page_says_at_which_commit_its_figures_were_made(generator):
    page = (ROOT / MADE[generator].page).read_text(encoding="utf-8")
    found = [m for m in STAMP.finditer(page) if m["generator"] == generator]
    assert len(found) == 1
    kind = subprocess.run(
        ["git", "-C", str(ROOT), "cat-file", "-t", found[0]["commit"]],
        capture_output=True,
        text=True,
    )
    # A shallow clone has not all of them.
    assert kind.stdout.strip() in ("commit", "")


def test_every_program_that_writes_figures_is_among_those_of_the_one_command():
    for file in (ROOT / "docs" / "generate").glob("*.py"):
        writes = re.search(
            r'(?m)^ +(write_page|\w+_parts)\(|"--write"|make_parser\(__doc__',
            file.read_text(),
        )
        shared = ("page_parts.py", "page_stamp.py", "press_page.py", "make_figures.py")
        if writes and file.name not in shared:
            assert file.relative_to(ROOT).as_posix() in MADE
    for figures in FIGURES:
        assert (ROOT / figures.page).is_file()
        assert (ROOT / figures.generator).is_file()


def test_a_stamp_replaces_its_own_and_stands_beside_those_of_others():
    one, other = (ROOT / f"docs/generate/{x}.py" for x in ("one", "other"))
    old = make_stamp(one, "`0123456` of 2001-02-03")
    new = make_stamp(one, "`89abcde` of 2004-05-06, with changes")
    beside = make_stamp(other, "`0123456` of 2001-02-03")
    assert STAMP.fullmatch(old) and STAMP.fullmatch(new)
    page = with_stamp(with_stamp("text\n", old), beside)
    assert page == f"text\n\n{old}\n{beside}\n"
    assert with_stamp(page, new) == f"text\n\n{beside}\n{new}\n"


def test_a_stamp_tells_which_figures_were_made_again_later():
    generator = ROOT / "docs/generate/one.py"
    first = make_stamp(generator, "`0123456` of 2001-02-03")
    page = with_stamp("text\n", first)
    for commit in ("`89abcde` of 2004-05-06", "`fedcba9` of 2005-06-07, with changes"):
        page = with_amendment(page, make_stamp(generator, commit), "all but times")
        amended = page.splitlines()[-1]
        assert STAMP.fullmatch(amended)["commit"] == "0123456"
        assert amended == f"{first[:-1]}; all but times at commit {commit}."
    # All of them are made at once again.
    assert with_stamp(page, first) == with_stamp("text\n", first)


def test_sources_that_were_changed_since_the_commit_are_told(monkeypatch):
    said = {"log": "`0123456` of 2001-02-03", "status": ""}
    monkeypatch.setattr(page_stamp, "_git", lambda what, *_: said[what])
    assert describe_commit() == "`0123456` of 2001-02-03"
    said["status"] = " M docs/generate/page_stamp.py"
    assert describe_commit() == "`0123456` of 2001-02-03, with changes"
