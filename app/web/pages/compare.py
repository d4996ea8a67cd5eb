"""Comparison page: two experiments side by side."""

from typing import Any

from fastapi import APIRouter, Request
from starlette.responses import Response

from app.experiments.model import Experiment, Status
from app.methods.registry import method
from app.web.deps import ServiceDep, TokenDep
from app.web.form.parameters import SHARED
from app.web.pages.experiment import (
    Tiles,
    View,
    common_context,
    experiment_address,
    parameter_rows,
    subject,
    tiling_note,
)
from app.web.pictures.panes import crop_panes, texture_pane
from app.web.templating import label, render

router = APIRouter(include_in_schema=False)


@router.get("/compare/{first_id}/{second_id}")
def compare(
    request: Request,
    first_id: str,
    second_id: str,
    service: ServiceDep,
    token: TokenDep,
    view: View = "side",
    tiles: Tiles = 2,
) -> Response:
    """Show two experiments beside the sample of the first; one that still runs shows its progress until it is there."""
    both = [service.experiments.get(first_id), service.experiments.get(second_id)]
    first, second = both
    names = [label(experiment.method) for experiment in both]
    samples = dict.fromkeys(subject(service, experiment) for experiment in both)
    same_inputs = first.inputs == second.inputs
    context: dict[str, Any] = {
        "title": f"{' and '.join(names)} of {' and '.join(samples)}",
        "same_phase": same_inputs and _same_phase(first, second),
        "base": f"/compare/{first.id}/{second.id}",
        "view": "side" if view == "steps" else view,
        "tiles": tiles,
    }
    unfinished = next((experiment for experiment in both if experiment.status is not Status.SUCCEEDED), None)
    if unfinished is not None:
        context |= common_context(service, unfinished, token) | {"unfinished": True, "others": []}
        return render(request, "compare.html", context)
    panes = crop_panes(first)
    if not same_inputs:
        panes += crop_panes(second, other=True)
    panes += [texture_pane(run, note=f"seed {run.parameters['seed']}", page=experiment_address(run)) for run in both]
    parameters = [dict(parameter_rows(experiment)) for experiment in both]
    rows = [(name, [values.get(name, "–") for values in parameters]) for name in parameters[0] | parameters[1]]
    context |= {"panes": panes, "experiments": both, "rows": rows, "tiling": tiling_note(both)}
    return render(request, "compare.html", context)


def _same_phase(first: Experiment, second: Experiment) -> bool:
    driven = all(method(experiment.method).phase for experiment in (first, second))
    return driven and all(first.parameters[name] == second.parameters[name] for name in SHARED)
