"""What `drake-haptics accuracy` prints."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from drake_haptics.evaluation.accuracy.budget import (
    BudgetChoice,
    describe_help,
    describe_outcome,
    describe_sacrifices,
)
from drake_haptics.evaluation.accuracy.figures import AccuracyStudy
from drake_haptics.evaluation.accuracy.report import (
    MODEL_MARK,
    SCENE_MARK,
    describe_knees,
    describe_machine,
    describe_missing,
    describe_models,
    describe_peers,
    describe_reference,
    describe_verdict,
    get_columns,
    group_rows,
    make_cells,
    make_label,
)
from drake_haptics.scene.schema import Scene


def print_study(console: Console, study: AccuracyStudy) -> None:
    """Prints verdict, price list, knees, and what to know of them."""
    for sentence in describe_verdict(study):
        console.print(sentence, style="bold")
    console.print(describe_reference(study), style="dim")
    console.print()
    console.print(_make_table(study))
    console.print()
    for sentence in describe_knees(study):
        console.print(f"Knee: {sentence}")
    for sentence in describe_peers(study):
        console.print(f"Beside it: {sentence}")
    for column in get_columns(study):
        console.print(f"{column.head}, {column.unit}: {column.meaning}", style="dim")
    console.print(f"{SCENE_MARK} the scene as it is", style="dim")
    if models := describe_models(study):
        console.print(
            f"{MODEL_MARK} differences of model, not errors: {'; '.join(models)}",
            style="dim",
        )
    for sentence in describe_missing(study):
        console.print(f"not measured: {sentence}", style="dim")
    console.print(describe_machine(study), style="dim")


def print_choice(
    console: Console, choice: BudgetChoice, scene: Scene, name: str
) -> None:
    """Prints what came of a budget, and what is given up for it."""
    console.print(describe_outcome(choice, name), style="bold")
    if not choice.holds:
        for sentence in describe_help(choice):
            console.print(sentence)
        return
    for sentence in describe_sacrifices(choice, scene):
        console.print(f"given up: {sentence}")


def _make_table(study: AccuracyStudy) -> Table:
    columns = get_columns(study)
    table = Table(box=None, padding=(0, 1, 0, 0), pad_edge=False)
    # In a narrow terminal labels take two lines, and figures stay whole.
    table.add_column("setting")
    for column in columns:
        table.add_column(f"{column.head}\n{column.unit}", justify="right", no_wrap=True)
    for knob, rows in group_rows(study):
        table.add_row(Text(knob, style="bold"))
        for row in rows:
            table.add_row(Text(make_label(row)), *make_cells(row, columns))
    return table
