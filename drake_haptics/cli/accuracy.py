"""`drake-haptics accuracy`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from drake_haptics.analysis.jobs.study import StudyError
from drake_haptics.cli.command_help import CommandWithExamples
from drake_haptics.cli.completion import complete_scene, complete_setting
from drake_haptics.cli.console import make_console, progress_bar
from drake_haptics.cli.endings import ExitCode, naming
from drake_haptics.cli.options import (
    FiniteRange,
    file_option,
    json_option,
    load_set_scene,
    require_writable,
    set_option,
    write_call,
    write_json,
)
from drake_haptics.common.errors import HapticsError, SceneError
from drake_haptics.evaluation.accuracy import budget, report
from drake_haptics.evaluation.accuracy.costs import measure_p99
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy
from drake_haptics.evaluation.accuracy.knobs import list_settings
from drake_haptics.evaluation.accuracy.page import write_accuracy_page
from drake_haptics.evaluation.accuracy.peers.run import add_peers
from drake_haptics.evaluation.accuracy.setting import Setting, read_setting
from drake_haptics.evaluation.accuracy.study import run_accuracy_study
from drake_haptics.report.page import check_page_path
from drake_haptics.scene.scene_file import write_scene
from drake_haptics.scene.schema import Scene
from drake_haptics.scene.validation import check_values
from drake_haptics.simulation.run import RunError


def print_study(console: Console, study: AccuracyStudy) -> None:
    """Prints the verdict, the price list, its knees, and notes on them."""
    for sentence in report.describe_verdict(study):
        console.print(sentence, style="bold")
    console.print(report.describe_reference(study), style="dim")
    console.print()
    console.print(_make_table(study))
    console.print()
    for sentence in report.describe_knees(study):
        console.print(f"Knee: {sentence}")
    for sentence in report.describe_peers(study):
        console.print(f"Beside it: {sentence}")
    for column in report.get_columns(study):
        console.print(f"{column.head}, {column.unit}: {column.meaning}", style="dim")
    console.print(f"{report.SCENE_MARK} the scene as it is", style="dim")
    if models := report.describe_models(study):
        words = f"differences of model, not errors: {'; '.join(models)}"
        console.print(f"{report.MODEL_MARK} {words}", style="dim")
    for sentence in report.describe_missing(study):
        console.print(f"not measured: {sentence}", style="dim")
    console.print(report.describe_machine(study), style="dim")


def _make_table(study: AccuracyStudy) -> Table:
    columns = report.get_columns(study)
    table = Table(box=None, padding=(0, 1, 0, 0), pad_edge=False)
    # In a narrow terminal labels wrap and figures do not.
    table.add_column("setting")
    for column in columns:
        table.add_column(f"{column.head}\n{column.unit}", justify="right", no_wrap=True)
    for knob, rows in report.group_rows(study):
        table.add_row(Text(knob, style="bold"))
        for row in rows:
            table.add_row(
                Text(report.make_label(row)), *report.make_cells(row, columns)
            )
    return table


@click.command(cls=CommandWithExamples)
@click.argument("scene", default="cup_spoon", shell_complete=complete_scene)
@click.option(
    "--quick",
    is_flag=True,
    help="Measure less: one setting of each key, once, in the motion's first second,"
    " and no other library.",
)
@click.option(
    "--only",
    "words",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_setting,
    help="Measure this setting alone, such as contact.tolerance_m=0.0005; once more for"
    " each further key of it. `scene` is the scene as it is. Writes no page.",
)
@click.option(
    "--instructions", is_flag=True, help="Also count the core's, with valgrind."
)
@click.option("--no-peers", is_flag=True, help="Leave other libraries out.")
@file_option(
    "--out",
    help="The page; its picture is written beside it.  [default: SCENE-accuracy.html]",
)
@set_option
@file_option("--store", help="Keep results here, and continue from them.")
@click.option(
    "--budget-us",
    type=FiniteRange(0, min_open=True),
    metavar="N",
    help="Instead of a page: pick the most accurate setting whose ticks take at most N"
    " µs, 99th percentile, and write it as a scene file.",
)
@file_option("--write", help="That file.  [default: SCENE-N-us.yaml]")
@json_option()
def accuracy(
    scene: str,
    quick: bool,
    words: tuple[str, ...],
    instructions: bool,
    no_peers: bool,
    out: Path | None,
    settings: tuple[str, ...],
    store: Path | None,
    budget_us: float | None,
    write: Path | None,
    json_file: str | None,
) -> None:
    """Measure what each step of accuracy costs in time, on this machine.

    SCENE is the name of a shipped scene (see `drake-haptics scenes`) or a scene file;
    cup_spoon if not given. The hand moves along its path once. Every setting of every
    knob answers the same motion, is compared with exact contacts, and is timed. Prints
    the price list and writes a page with a picture. Some minutes.
    """
    if budget_us is None and write is not None:
        raise click.UsageError("--write needs --budget-us")
    if budget_us is not None and (out is not None or words):
        raise click.UsageError("--budget-us goes with neither --out nor --only")
    if words and out is not None:
        raise click.UsageError("--only writes no page: leave --out away")
    chosen, name = load_set_scene(scene, settings), Path(scene).stem
    page = out or Path(f"{name}-accuracy.html")
    file = write or Path(f"{name}-{budget_us:g}-us.yaml" if budget_us else "")
    if budget_us is not None:
        require_writable(file, "--write")
    elif not words:
        require_writable(page, "--out")
    asked = _find_settings(chosen, words)

    def measure(
        show: Callable[[str, float], None], asked: list[Setting] | None
    ) -> AccuracyStudy:
        return run_accuracy_study(
            chosen,
            name,
            settings=asked,
            store=store,
            progress=show,
            quick=quick,
            count_instructions=instructions,
        )

    try:
        with progress_bar() as show, naming(name, SceneError):
            if budget_us is None:
                check_page_path(page)
                study = measure(show, asked)
                if not (quick or no_peers or words):
                    study = add_peers(study, chosen, progress=show)
                if asked is not None:
                    _require_measured(study, asked)
                else:
                    show("drawing the page", 1.0)
                    call = write_call("accuracy", scene, settings)
                    write_accuracy_page(
                        study, page, f"{call} --quick" if quick else call
                    )
            else:
                choice = budget.choose_setting(
                    chosen,
                    budget_us,
                    make_study=partial(measure, show),
                    measure_p99=measure_p99,
                    progress=show,
                    runs=1 if quick else budget.RUNS,
                )
    except (ValueError, RunError, StudyError) as error:
        raise HapticsError(str(error)) from error
    if budget_us is None:
        _show_study(study, None if words else page, json_file)
    else:
        _show_choice(choice, chosen, name, file, json_file)


def _find_settings(scene: Scene, words: tuple[str, ...]) -> list[Setting] | None:
    """Returns the setting that --only names; None for the settings of all knobs."""
    if not words:
        return None
    with naming("--only"):
        setting = read_setting(words, list_settings(scene))
        check_values(setting.apply(scene))
    return [setting]


def _require_measured(study: AccuracyStudy, settings: list[Setting]) -> None:
    """Raises HapticsError if the requested setting could not be measured."""
    for row in study.rows:
        if row.setting in settings and row.failure_reason:
            raise HapticsError(
                f"--only: {report.name_setting(row)}: {row.failure_reason}"
            )


def _show_study(study: AccuracyStudy, page: Path | None, json_file: str | None) -> None:
    write_json(study.to_json_data(), json_file)
    if json_file == "-":
        return
    console = make_console(markup=False)
    print_study(console, study)
    if page is not None:
        console.print(f"Wrote {page} and {page.with_suffix('.png')}.", soft_wrap=True)


def _show_choice(
    choice: budget.BudgetChoice,
    scene: Scene,
    name: str,
    file: Path,
    json_file: str | None,
) -> None:
    """Prints the outcome for a budget, and writes the scene that meets it."""
    if choice.holds:
        write_scene(choice.scene, file, budget.describe_file(choice, scene, name))
    write_json(budget.to_budget_data(choice, scene), json_file)
    if json_file != "-":
        console = make_console(markup=False)
        console.print(budget.describe_outcome(choice, name), style="bold")
        if not choice.holds:
            for sentence in budget.describe_help(choice):
                console.print(sentence)
        else:
            for sentence in budget.describe_sacrifices(choice, scene):
                console.print(f"given up: {sentence}")
            console.print(f"Wrote {file}: drake-haptics run {file}", soft_wrap=True)
    if not choice.holds:
        raise click.exceptions.Exit(ExitCode.NO)
