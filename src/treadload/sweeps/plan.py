"""What a study would solve, without solving it."""

from __future__ import annotations

from collections.abc import Sequence

from treadload.case import Case
from treadload.case.keys import with_values
from treadload.errors import InputError
from treadload.steps.chain import plan as plan_of_case
from treadload.sweeps.design import Design
from treadload.sweeps.selection import check_varied, selectors_for
from treadload.sweeps.sweep import varied

# Cases that are read to see whether they can be.
_TRIED = 1000


def plan_sweep(case: Case, design: Design, fields: Sequence[str] = ()) -> str:
    """What `sweep` would do, as text: the cases, what is kept, those that cannot be read, and the plan of the first.

    Reads the tire. Raises InputError where no case can be read.

    >>> wheel = {"tire": {"profile": "315/80R22.5", "inflation_pressure": "8 bar"}, "spacing": "12 mm"}
    >>> wheel["rolling"] = {"normal_load": "32.5 kN", "friction": 0.7}
    >>> case = tl.Case.from_dict(wheel | {"pavement": {"structure": "6 BBSG3 / 15 GB3 / PF3", "temperature": 15}})
    >>> plan = tl.sweeps.plan_sweep(case, tl.sweeps.from_texts(case, ["normal_load=20e3:40e3:3"]))
    >>> print(plan.splitlines()[1])
    varied    rolling.normal_load: 20000 to 40000 N, 3 values
    """
    check_varied(case)
    readings = selectors_for(fields, case)
    lines = [f"cases     {design.count}", *(f"varied    {text}" for text in varied(design))]
    kept = "the numbers of every case" + "".join(f", {reading.label}" for reading in readings)
    lines.append(f"kept      {kept}")
    plan, wrong = "", []
    tried = min(design.count, _TRIED)
    for number in range(tried):
        if number in design.faults:
            wrong.append(f"{design.named(number)}: {design.faults[number]}")
            continue
        try:
            case_at = type(case).from_dict(
                with_values(case.as_tables(), design.at(number)), folder=case.folder, name=design.words_of(number)
            )
            if not plan:
                plan = f"the first of them, {design.words_of(number)}:\n{plan_of_case(case_at)}"
        except InputError as error:
            wrong.append(str(error))
    if not plan:
        raise InputError(wrong[0])
    if wrong:
        lines.append(f"warning: {len(wrong)} of the first {tried} cases will fail, the first: {wrong[0]}")
    lines += ["", plan]
    if any(step.is_quiet for step in case.steps):
        lines.append("a study solves no slices and no bowl unless it is asked for them, and so takes less than that")
    return "\n".join(lines)
