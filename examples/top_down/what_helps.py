"""What would help a motorway, an exit curve and a bus stop: each change by one step, solved anew and ranked.

A month is one season here, in place of four parts of its days, which takes a quarter of the time; the motorway takes
some hundred lives' worth of contacts and responses all the same. Tires are the half-space of the case files.

    python examples/top_down/what_helps.py [folder] [place ...]
"""

import sys
from collections.abc import Sequence
from pathlib import Path

import treadload as tl

HERE = Path(__file__).parent
PLACES = ("motorway", "exit_curve", "bus_stop")


def main(
    folder: Path, places: Sequence[str] = PLACES, spacing: str = "6 mm", only: Sequence[str] = ()
) -> dict[str, tl.life.Remedies]:
    """The remedies of places. only: kinds of them; all if left out."""
    folder.mkdir(parents=True, exist_ok=True)
    answers = {}
    for place in places:
        case = tl.Case.from_toml(
            HERE / f"{place}.toml",
            changes=[f'spacing="{spacing}"', "climate.parts_of_day=1", f"remedies.only={list(only)}"],
        )
        result = tl.run(case, leave_out=("sensitivity", "growth"))
        answers[place] = result.remedies
        tl.save_results(result, folder / f"{place}_remedies.nc")
        result.remedies.plot.tornado().savefig(folder / f"{place}_remedies.png")
        print(f"{case.title}\n{result.remedies}\n")
    check(answers)
    return answers


def check(answers: dict[str, tl.life.Remedies]) -> None:
    """What must hold whatever the numbers: the ranking is one, and of thicker layers the road lasts longer."""
    for answer in answers.values():
        won = answer.dataset["years_won"]
        assert (won.diff("remedy") <= 0).all()
        thicker = [name for name in won["remedy"].to_numpy() if "cm more" in name and "GB3" in name]
        assert (won.sel(remedy=thicker) > 0).all()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("top_down"), sys.argv[2:] or PLACES)
