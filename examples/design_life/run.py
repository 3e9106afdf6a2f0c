"""How long does a road last under mixed traffic, where does it fail first, and what would change that?

A bituminous structure of the French kind, 6 cm of BBSG3 on 15 cm of GB3 on a platform PF3, under single front axles,
driven axles with dual wheels and tridems of trailers that roll straight, brake and turn, over the temperatures of
twelve months. The case stands in design.toml; its traffic and temperatures are assumed. The result is one page:
life.html.

    python examples/design_life/run.py [folder]

The same without Python: treadload life design.toml -o life.nc; treadload report life.nc -o life.html
"""

import sys
from pathlib import Path

import treadload as tl

DESIGN = Path(__file__).parent / "design.toml"


def main(folder: Path, spacing: float | None = None, workers: int | None = None) -> tl.steps.Result:
    folder.mkdir(parents=True, exist_ok=True)
    case = tl.Case.from_toml(DESIGN)
    if spacing is not None:
        case = case.model_copy(update={"spacing": spacing})
    result = tl.run(case, workers=workers)
    print(result.summary())
    tl.save_results(result, folder / "life.nc")
    tl.report(result, folder / "life.html")
    check(result)
    print(f"\nthe page: {folder / 'life.html'}")
    return result


def check(result: tl.steps.Result) -> None:
    """What the page says must follow from the laws alone, whatever the numbers."""
    life, traffic = result.life, result.life.traffic
    data = life.dataset
    # The years are those in which the growing traffic makes the passes that the damage allows.
    for criterion in life.criteria:
        passes = float(data["life_passes"].sel(criterion=criterion.name))
        assert abs(traffic.passes(life.years(criterion.name)) / passes - 1) < 1e-9
    # Shares of classes and seasons, and of orientations, are parts of one damage.
    assert abs(data["damage_share"].sum(("axle_class", "season")) - 1).max() < 1e-9
    assert abs(data["orientation_damage"].sum("orientation") - 1).max() < 1e-9
    # Life goes like the law's strain to the power -1/b = 5, as it goes like one over the passes.
    found = result.sensitivity.dataset["elasticity"]
    strength = float(found.sel(input=f"strength of {life.governing}"))
    assert abs(strength / (-5 * float(found.sel(input="passes"))) - 1) < 1e-6
    # The French laws include the wander of traffic: their lives are of one track; the other is printed too.
    for name, held in (("base, bottom-up", True), ("surface, top-down", False), ("platform, rutting", True)):
        row = data.sel(criterion=name)
        still, wide = float(row["life_years_without_wander"]), float(row["life_years_with_wander"])
        print(f"{name}: {still:.1f} years in one track, {wide:.1f} with wander on top")
        assert life.years(name) == (still if held else wide)
        assert still < wide
    # The base fails first, from below, and later than the design life.
    assert life.governing == "base, bottom-up"
    assert life.years(life.governing) > traffic.years
    assert life.stats["responses"] < life.stats["combinations"]


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("design_life"))
