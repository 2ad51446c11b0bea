"""All that README and front page say to type works, and what they show is so."""

import json
import re
import shlex
import signal
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from accuracy_samples import make_study
from click.testing import CliRunner
from held_samples import analyze_sample
from markdown_page import PROGRAM, find_blocks, find_span_commands, find_spans

from drake_haptics import find_scene, load_scene
from drake_haptics.cli import main
from drake_haptics.evaluation.benchmark.benchmark import QUICK

ROOT = Path(__file__).parents[2]
# The installed command, beside the interpreter.
COMMAND = Path(sys.executable).with_name(PROGRAM)
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = find_blocks(README)
FRONT_BLOCKS = find_blocks((ROOT / "docs" / "index.md").read_text(encoding="utf-8"))
SETUP, *SHELLS = [block for block in BLOCKS if block.language == "sh"]
(TWO_TERMINALS,) = [b for b in SHELLS if b.text.startswith(f"{PROGRAM} device ")]
# Each block is a sequence; a command in a sentence stands by itself.
SEQUENCES = [block.commands for block in SHELLS if block is not TWO_TERMINALS]
SEQUENCES += [[command] for command in find_span_commands(README)]
# Each program, with what it prints.
SNIPPETS = [
    pytest.param(page, block, shown.text, id=f"{page}, line {block.line}")
    for page, blocks in {"README.md": BLOCKS, "index.md": FRONT_BLOCKS}.items()
    for block, shown in pairwise(blocks)
    if block.language == "python"
]
# What measures for minutes is only begun; its own tests let it end.
SHORTER = {
    "accuracy": ["--no-peers"],
    "bench": ["--quick"],
    "paper": ["--quick", "table1"],
}
# What takes half a minute: test_cli_stability.py lets it analyze a scene.
ANALYSIS = "drake_haptics.cli.stability.analyze_scene"
# What takes minutes: test_cli_accuracy.py lets it measure one.
STUDY = "drake_haptics.cli.accuracy.run_accuracy_study"
# Fifteen loops over a motion: evaluation/benchmark/test_loop.py lets them touch.
EFFORT = "drake_haptics.cli.bench.QUICK"
# Other programs that sentences name, and that no test here runs.
OTHER_PROGRAMS = {
    "make docs",  # test_docs_site.py
    "make tutorials",  # its notebooks: test_tutorials.py
    "python docs/generate/make_meshes.py",  # docs/shapes/test_shapes.py
    "run",  # the command in short
}


def shorten(command):
    """Returns the arguments of a command that shows no page and soon ends."""
    program, *arguments = shlex.split(command)
    assert program == PROGRAM, "the only program beside make"
    if arguments[0] == "run":
        if "--duration" in arguments:
            arguments[arguments.index("--duration") + 1] = "0.3"
        else:
            arguments += ["--duration", "0.3"]
        if "--headless" not in arguments and "mouse:" not in arguments:
            arguments.append("--headless")
    else:
        arguments += SHORTER.get(arguments[0], [])
    return arguments


@pytest.mark.parametrize("commands", SEQUENCES, ids=lambda commands: commands[0])
def test_commands_run(commands, tmp_path, monkeypatch):
    # Files that the command reads are in the checkout; what it writes goes elsewhere.
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(ANALYSIS, lambda *_, **__: analyze_sample())
    monkeypatch.setattr(STUDY, lambda *_, **__: make_study())
    monkeypatch.setattr(EFFORT, replace(QUICK, loop_s=0.2))
    for command in commands:
        arguments = shorten(command)
        result = CliRunner().invoke(main, arguments)
        assert result.exit_code == 0, result.output
        for option in ("--record", "--json", "--log", "--write-scene"):
            if option in arguments:
                file = Path(arguments[arguments.index(option) + 1])
                assert file.stat().st_size > 0


def test_two_commands_close_a_loop_over_two_processes(tmp_path):
    first, second = (shlex.split(line)[1:] for line in TWO_TERMINALS.commands)
    assert second[-1] == "udp://127.0.0.1:7400", "the port that the first one has"
    # The one of the README may be taken here.
    driver = subprocess.Popen(
        [COMMAND, *first, "--port", "0"], stdout=subprocess.PIPE, text=True
    )
    try:
        address = None
        while address is None:
            address = re.search(r"udp://[\d.:]+", driver.stdout.readline())
        second[-1] = address.group()
        file = tmp_path / "figures.json"
        subprocess.run(
            [COMMAND, *second, "--headless", "--duration", "2", "--json", file],
            check=True,
            timeout=300,
        )
        figures = json.loads(file.read_text())
        assert figures["device"]["received"] > 100
        assert figures["max_force_N"] > 0.3, "the spoon has met the cup"
    finally:
        driver.send_signal(signal.SIGINT)
        assert driver.wait(120) == 0


def test_two_commands_set_up_and_no_other_does():
    assert SETUP.commands == ["make demo", "make test"]
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for command in SETUP.commands:
        assert re.search(rf"^{command.split()[1]}:", makefile, re.MULTILINE)


def test_every_block_is_of_a_kind_that_is_tested():
    for blocks in (BLOCKS, FRONT_BLOCKS):
        kinds = [block.language for block in blocks]
        assert set(kinds) <= {"sh", "python", "text"}
        for i, kind in enumerate(kinds):
            if kind == "text":
                assert kinds[i - 1] == "python", "shows what the snippet prints"
            if kind == "python":
                assert kinds[i + 1] == "text"


def test_every_program_in_a_sentence_is_run_somewhere():
    programs = "drake-haptics|make|pip|python|cmake|git|run|bash|sh|cc"
    named = {x for x in find_spans(README) if re.match(rf"({programs})( |$)", x)}
    named -= {*find_span_commands(README), *SETUP.commands, PROGRAM}
    assert named == OTHER_PROGRAMS


@pytest.mark.parametrize("name", sorted({*re.findall(r"`(--[\w-]+)", README)}))
def test_options_in_sentences_are_those_of_a_command(name):
    with main.make_context(PROGRAM, ["run", "--help"], resilient_parsing=True) as ctx:
        options = {
            option
            for command in main.list_commands(ctx)
            for parameter in main.get_command(ctx, command).params
            for option in parameter.opts
        }
    assert name in options


@pytest.mark.parametrize(("page", "snippet", "shown"), SNIPPETS)
def test_snippets_print_what_is_shown(page, snippet, shown, capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    code = "\n" * snippet.line + snippet.text
    exec(compile(code, page, "exec"), {"__name__": "readme"})
    printed = capsys.readouterr().out
    number = re.compile(r"\d+\.?\d*")
    assert number.sub("", printed) == number.sub("", shown)
    # Of other processors the last digit may differ by one.
    for here, there in zip(number.findall(printed), number.findall(shown), strict=True):
        last_digit = 10.0 ** -len(there.partition(".")[2])
        assert float(here) == pytest.approx(float(there), abs=1.01 * last_digit)


def test_the_programs_are_short():
    most = {"README.md": 17, "index.md": 10}
    for page, snippet, _ in (case.values for case in SNIPPETS):
        assert len([x for x in snippet.text.splitlines() if x.strip()]) <= most[page]


def test_the_die_lies_in_the_cup_and_not_on_its_hull():
    (text,) = (b.text for b in BLOCKS if "die lies" in b.text and b.language == "text")
    height_mm, force_N = map(float, re.findall(r"\d+\.\d+", text))
    assert force_N == pytest.approx(0.1 * 9.81, abs=0.006)
    # Its corners, 14 mm from the middle, are over a bottom that rises from 5 to 6 mm at
    # 22 mm, within the tolerance of 2 mm. The rim is at 72 mm.
    bottom_mm = 5.0 + 14.1 / 22.0
    assert bottom_mm + 10.0 < height_mm < bottom_mm + 10.0 + 2.0


def test_the_softest_contact_of_the_example_gives_way_by_its_spring():
    """That is the force over the stiffness, less the tolerance, or not at all."""
    (text,) = (b.text for b in FRONT_BLOCKS if b.language == "text")
    tolerance_m = load_scene(find_scene("cup_spoon")).contact.tolerance_m
    for line in text.splitlines():
        stiffness, force_N, deep_mm = map(float, re.findall(r"\d+\.?\d*", line))
        assert deep_mm <= 1e3 * max(0.0, force_N / stiffness - tolerance_m) + 0.1


@pytest.mark.parametrize("target", re.findall(r"\]\(([^)#:]+)\)", README))
def test_links_lead_somewhere(target):
    assert (ROOT / target).exists()
