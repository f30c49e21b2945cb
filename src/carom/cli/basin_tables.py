"""Tables of basins and gain maps for the terminal."""

from __future__ import annotations

from rich.console import Console

from carom.base.outcome import IRREGULAR_BOUNCING, Outcome
from carom.base.results import table_of
from carom.basins import Basin, GainMap, SmallestUnrecovered
from carom.basins.document import MOTION
from carom.basins.maps import WANTED
from carom.basins.sizes import size_coordinate
from carom.cli.screen import print_table
from carom.cli.tables import print_rows
from carom.disturbances.plans import plan_words
from carom.parameters import Case, in_terms_of
from carom.parameters.formats import format_angle
from carom.studies.wording import Wording, counted, ending_words


def print_basin(screen: Console, basin: Basin, smallest: SmallestUnrecovered | None, contact_free: float) -> None:
    """Print the disturbances tried, where they end, and the smallest that does not come back."""
    screen.print(f"Disturbances: {plan_words(basin.plan, basin.rotor.value('rho'), basin.scales, at=basin.instants)}.")
    note = "Decision time: when the outcome was certain."
    print_table(screen, "", *table_of(MOTION, basin.fractions, basin), note=note)
    screen.print(f"Back to levitation: {basin.share_recovered.words}.")
    if basin.irregular:
        screen.print(f"{IRREGULAR_BOUNCING.capitalize()}: {basin.irregular['survival']}.")
    screen.print(_touching(basin))
    if basin.beyond_model:
        screen.print(
            f"Beyond the model: {basin.beyond_model} of {basin.starts} starts, counted as not coming back. {Outcome.BEYOND_MODEL.meaning}"
        )
    if basin.unresolved:
        screen.print(f"Undecided within the event limit: {basin.unresolved} starts, counted as not coming back.")
    if survived := _losses(basin, smallest, contact_free):
        print_rows(screen, "What is survived", survived)


def print_gains(screen: Console, found: GainMap, case: Case) -> None:
    """Print what a gain map says about the present machine, in the terms of its file."""
    share = found.dataset["recovered"].values
    lost = int((found.dataset["levitates"].values <= 0.0).sum())
    back, of_what = found.present_share, found.population.words
    names = [axis.name for axis in found.axes]
    here = [in_terms_of(case, name, value, digits=5) for name, value in zip(names, found.present, strict=True)]
    ends = [[in_terms_of(case, name, end, digits=5) for end in found.dataset[name].values[[0, -1]]] for name in names]
    spans = (f"{low.field.words} {low.text} to {high.text}" for low, high in ends)
    screen.print(f"Map: {'; '.join(spans)}.")
    screen.print(f"Present machine: {', '.join(f'{each.field.words} {each.text}' for each in here)}; {back.words}.")
    shape = " x ".join(str(size) for size in share.shape)
    reach, sure = (int((found.dataset[name].values >= WANTED).sum()) for name in ("recovered", "recovered_low"))
    varied = " and ".join(each.entry.replace("_", " ") for each in here)
    shown = (
        f" ({back.total} drawn at each), shown with 95 % confidence for {sure or 'none: draw more'}"
        if back.drawn
        else ""
    )
    screen.print(
        f"Of {shape} machines with other {varied}, {reach} of {share.size} bring back at least "
        f"{100 * WANTED:g} % of {of_what}{shown}; {counted(lost, 'machine') if lost else 'none'} cannot levitate."
    )


def _touching(basin: Basin) -> str:
    """Say how many disturbances touched the wall, and how many of these came back."""
    met, back = int(basin.touched.sum()), int((basin.touched & basin.recovered).sum())
    if not met:
        return f"None of the {basin.starts} touched the wall."
    return f"Touched the wall: {met} of {basin.starts}; {back or 'none'} of these came back."


def _losses(basin: Basin, smallest: SmallestUnrecovered | None, contact_free: float) -> list[tuple[str, str]]:
    """From which size on disturbances do not come back, if they have a size; else why nothing was searched."""
    from carom.studies.verdict import SURVIVED, size_cells

    system = basin.rotor.system
    if size_coordinate(basin.plan.model) is None:
        return []
    if smallest is None or contact_free <= 0.0:
        levitates = system.rest_radius < 1.0 and system.decay > 0.0
        why = "no size is known that cannot touch" if levitates else "no stable levitation inside the wall"
        return [(SURVIVED["lost"], f"not searched: {why}")]
    ending = ending_words(smallest.outcome, basin.motions).removeprefix("it ") if smallest.outcome else ""
    cells = size_cells(Wording(basin.scales), smallest, _where(smallest), ending)
    if smallest.all_back is None:
        cells["back"] = "none: even disturbances of size zero do not come back"
    elif smallest.fresh:
        share = f"fewer than {100.0 * smallest.share_below:.2g} % fail, with 95 % confidence"
        cells["back"] += f"; confirmed with {smallest.fresh:,} new ones: {share}"
    elif smallest.size is not None:
        cells["lost"] += "; new samples kept finding smaller ones, so a smaller one is likely"
    return [(SURVIVED[column], cells[column]) for column in SURVIVED if column in cells]


def _where(smallest: SmallestUnrecovered) -> str:
    """The direction of the smallest disturbance that does not come back."""
    if smallest.size is None:
        return ""
    where = f"at {format_angle(smallest.angle or 0.0)}"
    if smallest.kind == "blade-loss":
        return f"{where} from the unbalance before it"
    turned = smallest.instant
    after = "" if turned is None else f" when the shaft has turned by {format_angle(turned)}"
    axis = "the record as it is" if smallest.kind == "base-record" else "the x axis that turns with the shaft"
    return f"{where} from {axis}{after}"
