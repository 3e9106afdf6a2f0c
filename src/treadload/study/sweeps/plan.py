"""What a study would solve, without solving it."""

from __future__ import annotations

from collections.abc import Sequence

from treadload.case import Case
from treadload.case.file import FilePart
from treadload.case.keys import with_values
from treadload.errors import InputError
from treadload.study.plan import plan_case, plan_life
from treadload.study.sweeps.asked import asked_for, kind_of
from treadload.study.sweeps.design import Design
from treadload.study.sweeps.sweep import varied

# Cases that are read to see whether they can be.
_TRIED = 1000


def plan_sweep(case: FilePart, design: Design, fields: Sequence[str] = ()) -> str:
    """What `sweep` would do, as text: the cases, what is kept, those that cannot be read, and the plan of the first.

    Reads the tire. Raises InputError where no case can be read.
    """
    kind_of(case)
    asked = asked_for(fields, case)
    lines = [f"cases     {design.count}", *varied(design)]
    kept = "the numbers of every case" + "".join(f", {one.label}" for one in asked)
    lines.append(f"kept      {kept}")
    plan, wrong = "", []
    tried = min(design.count, _TRIED)
    for number in range(tried):
        if number in design.faults:
            wrong.append(f"{design.named(number)}: {design.faults[number]}")
            continue
        try:
            one = type(case).from_dict(
                with_values(case.given(), design.at(number)), folder=case.folder, name=design.said(number)
            )
            if not plan:
                told = plan_case(one) if isinstance(one, Case) else plan_life(one)  # type: ignore[arg-type]
                plan = f"the first of them, {design.said(number)}:\n{told}"
        except InputError as error:
            wrong.append(str(error))
    if not plan:
        raise InputError(wrong[0])
    if wrong:
        lines.append(f"warning: {len(wrong)} of the first {tried} cases will fail, the first: {wrong[0]}")
    lines += ["", plan]
    if isinstance(case, Case):
        lines.append("a study solves no slices and no bowl unless it is asked for them, and so takes less than that")
    return "\n".join(lines)
