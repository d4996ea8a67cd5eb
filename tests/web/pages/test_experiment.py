"""The page of an experiment in its states, as the server writes it, and what its buttons do."""

import html
import re
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from tests.web.versions import without_versions


def page_of(site: Any, record: dict[str, Any], query: str = "") -> str:
    answer = site.client.get(f"/experiments/{record['id']}{query}")
    assert answer.status_code == 200
    return str(answer.text)


def test_the_finished_page_shows_pictures_record_and_links(site: Any, experiment: dict[str, Any]) -> None:
    text = without_versions(page_of(site, experiment))
    address = f"/api/v1/experiments/{experiment['id']}/outputs"
    for name in ("crop", "texture"):
        assert f'<img src="{address}/{name}"' in text
    for part in ("Time by stage", "Run again", "ADSN with the same phase", "New seed", "toroidal"):
        assert part in text


def test_the_finished_page_says_what_computed_it(site: Any, experiment: dict[str, Any]) -> None:
    text = page_of(site, experiment)
    assert experiment["environment"]["cpu"] in unescape(text)
    assert f"numpy {experiment['environment']['numpy']}" in text


def test_every_download_is_a_file(site: Any, experiment: dict[str, Any]) -> None:
    found = re.findall(r'<a class="button" href="(/api/v1/[^"]+)">', page_of(site, experiment))
    kinds = [site.client.get(address.replace("&amp;", "&")).headers["content-type"] for address in found]
    assert kinds == ["image/png", "image/png", "image/jpeg", "image/webp", "image/tiff", "application/zip"]


def test_the_link_preview_is_the_pair_of_pictures(site: Any, experiment: dict[str, Any]) -> None:
    preview = re.search(r'property="og:image" content="([^"]+)"', page_of(site, experiment))
    assert preview is not None
    assert preview[1].startswith(site.url)
    assert site.client.get(preview[1]).headers["content-type"] == "image/jpeg"


@pytest.mark.parametrize(("view", "count"), [("side", 2), ("flip", 2), ("tiled", 8), ("tiled&tiles=3", 18)])
def test_views_are_pictures_without_a_script(site: Any, experiment: dict[str, Any], view: str, count: int) -> None:
    text = page_of(site, experiment, f"?view={view}")
    stages = text.split('class="panes')[1].split("<template")[0]
    assert stages.count("<img ") == count


def test_steps_are_all_outputs_of_one_texture(site: Any, experiment: dict[str, Any]) -> None:
    text = page_of(site, experiment, "?view=steps")
    steps = text.split('class="steps"')[1].split("</ul>")[0]
    assert steps.count("<img ") == len(experiment["outputs"])


@pytest.fixture(scope="module")
def mixture(site: Any, picture: Callable[..., bytes]) -> dict[str, Any]:
    """The record of a finished mixture of three crops of two samples."""
    other = site.upload(picture(48, 40, seed=9))["id"]
    box = {"x": 4, "y": 2, "width": 24, "height": 20}
    inputs = [{"sample": sample, "crop": box} for sample in ("gravel_gray", other)]
    inputs.append({"sample": "gravel_gray", "crop": {**box, "x": 30}})
    return dict(site.finished(method="mix", inputs=inputs, parameters={"weights": "1,2,1"}))


def test_every_input_is_a_pane_and_in_the_record(site: Any, mixture: dict[str, Any]) -> None:
    text = page_of(site, mixture)
    panes = re.findall(r'<figcaption>(?:<a[^>]*>)?([^<]+?)(?:</a>)? <span class="hint">', text.split("<template")[0])
    assert panes == ["First sample", "Second sample", "Third sample", "Mix"]
    assert text.split('class="panes')[1].split("<template")[0].count('class="meter"') == 4
    assert "<h1>Mix of gravel and a photograph</h1>" in text
    details = text.split('id="details"')[1].split("</table>")[0]
    assert details.count(">4,2,24,20<") == 2
    assert ">30,2,24,20<" in details


def test_further_textures_are_a_gallery_and_no_steps(site: Any, mixture: dict[str, Any]) -> None:
    text = without_versions(page_of(site, mixture, "?view=steps"))
    gallery, steps = (text.split(f'<ul class="{name}')[1].split("</ul>")[0] for name in ("textures", "steps"))
    others = [output["name"] for output in mixture["outputs"] if output["kind"] == "texture"][1:]
    assert len(others) == 3
    for name in others:
        assert f'/outputs/{name}"' in gallery
        assert f'/outputs/{name}"' not in steps
    assert gallery.count('class="meter"') == 3
    assert steps.count("<img ") == len(mixture["outputs"]) - 3


def test_what_the_method_found_is_a_table(site: Any) -> None:
    record = site.finished(method="texton")
    facts = page_of(site, record).split('id="facts"')[1].split("</table>")[0]
    assert len(record["diagnostics"]["facts"]) == facts.count("<tr>") > 0
    for fact in record["diagnostics"]["facts"]:
        assert fact["title"][1:] in html.unescape(facts)


@pytest.mark.parametrize(
    ("run", "words"),
    [
        ({}, "tiles without a seam"),
        ({"parameters": {"add_smooth": True}}, "a seam shows"),
        ({"method": "rayleigh", "parameters": {}}, "tiles without a seam"),
    ],
)
def test_the_page_says_whether_the_texture_tiles(site: Any, run: dict[str, Any], words: str) -> None:
    assert words in page_of(site, site.finished(**run))


def test_only_methods_driven_by_the_same_phase_are_offered_at_it(
    site: Any, experiment: dict[str, Any], mixture: dict[str, Any]
) -> None:
    """And with the inputs that there are; every other method is behind the form."""
    offered = re.findall(r">([^<]+) with the same phase<", page_of(site, experiment))
    assert "ADSN" in offered
    assert not {"DSN", "Mix", "Heeger–Bergen"} & set(offered)
    text = page_of(site, mixture)
    assert "with the same phase" not in text
    assert re.search(r'href="/samples/[^"]+#methods">Change method', text)


def test_methods_without_that_phase_are_compared_without_a_word_of_it(site: Any, experiment: dict[str, Any]) -> None:
    other = site.finished(method="rayleigh", parameters={"seed": experiment["parameters"]["seed"]})
    text = site.client.get(f"/compare/{experiment['id']}/{other['id']}").text
    assert "same phase" not in text


def test_a_waiting_mixture_shows_all_of_its_crops(site: Any, mixture: dict[str, Any]) -> None:
    inputs = mixture["inputs"]
    with site.gate.closed():
        text = page_of(site, site.run(wait=False, method="mix", inputs=inputs, parameters={"seed": 8}).json())
    assert text.split('class="panes')[1].count("<image ") == 3


def test_a_waiting_experiment_looks_again_without_a_script(site: Any) -> None:
    with site.gate.closed():
        record = site.run(wait=False).json()
        text = page_of(site, record)
        assert '<noscript><meta http-equiv="refresh"' in text
        assert 'role="progressbar"' in text
        assert "Cancel" in text
        with site.visitor() as stranger:
            assert "Cancel" not in stranger.get(f"/experiments/{record['id']}").text
        assert site.client.post(f"/experiments/{record['id']}/cancel").status_code == 303
    text = page_of(site, record)
    assert "Cancelled" in text
    assert "refresh" not in text


def test_cancelling_what_finished_deletes_nothing(site: Any) -> None:
    record = site.finished()
    site.client.post(f"/experiments/{record['id']}/cancel")
    assert "Time by stage" in page_of(site, record)


def test_only_its_owner_sees_and_may_use_the_owners_buttons(site: Any) -> None:
    record = site.finished()
    address = f"/experiments/{record['id']}"
    with site.visitor() as stranger:
        assert "Delete it" not in stranger.get(address).text
        assert stranger.post(f"{address}/delete").status_code == 403
        assert stranger.post(f"{address}/unlist").status_code == 403
    assert "Delete it" in page_of(site, record)
    site.client.post(f"{address}/unlist")
    assert 'content="noindex"' in page_of(site, record)
    site.client.post(f"{address}/list")
    assert 'content="noindex"' not in page_of(site, record)
    assert site.client.post(f"{address}/delete").headers["location"] == "/archive"
    gone = site.client.get(address)
    assert gone.status_code == 410
    assert "Deleted" in gone.text


def test_run_again_draws_a_new_seed(site: Any, experiment: dict[str, Any]) -> None:
    answer = site.client.post(f"/experiments/{experiment['id']}/again", data={"method": "rpn", "seed": "new"})
    assert answer.status_code == 303
    record = site.client.get("/api/v1" + answer.headers["location"]).json()
    assert record["inputs"] == experiment["inputs"]
    assert record["parameters"] == experiment["parameters"] | {"seed": record["parameters"]["seed"]}
    assert record["parameters"]["seed"] != experiment["parameters"]["seed"]


def test_the_other_model_runs_at_the_same_phase(site: Any, experiment: dict[str, Any], until: Any) -> None:
    answer = site.client.post(f"/experiments/{experiment['id']}/again", data={"method": "adsn"})
    both = answer.headers["location"]
    assert both.startswith(f"/compare/{experiment['id']}/")
    other = both.rsplit("/", 1)[-1]
    until(lambda: site.client.get(f"/api/v1/experiments/{other}").json()["status"] == "succeeded")
    record = site.client.get(f"/api/v1/experiments/{other}").json()
    assert record["method"] == "adsn"
    assert record["parameters"]["seed"] == experiment["parameters"]["seed"]
    text = site.client.get(both).text
    assert "Same crop, same seed, same phase" in text
    assert text.split('class="panes')[1].split("</section>")[0].count("<img ") == 3


def test_comparing_with_one_that_runs_shows_its_progress(site: Any, experiment: dict[str, Any]) -> None:
    with site.gate.closed():
        other = site.run(wait=False, method="adsn").json()
        text = site.client.get(f"/compare/{experiment['id']}/{other['id']}").text
    assert 'role="progressbar"' in text
    assert f'data-experiment="{other["id"]}"' in text


def test_other_parameters_open_the_form_with_those_of_the_experiment(site: Any, experiment: dict[str, Any]) -> None:
    found = re.search(r'href="(/samples/[^"]+)">Change crop', page_of(site, experiment))
    assert found is not None
    text = site.client.get(found[1].replace("&amp;", "&")).text
    for name, value in {"crop.width": 32, "crop.height": 24, "width": 40, "height": 36, "seed": 7}.items():
        assert re.search(rf'name="{name}"[^>]* value="{value}"', text), name


def test_the_snippets_name_every_parameter(site: Any, experiment: dict[str, Any]) -> None:
    """What is left out could change with a later default."""
    blocks = re.findall(r"<code id=[^>]+>(.*?)</code>", page_of(site, experiment), re.DOTALL)
    assert len(blocks) == 3
    for block in blocks:
        for name in experiment["parameters"]:
            if name not in {"width", "height"}:
                assert name in block or name.replace("_", "-") in block
        assert "rpn" in block


def test_a_failed_experiment_says_why_and_what_to_try(serve: Callable[..., Any], tmp_path: Path) -> None:
    with serve(tmp_path, time_limit=0.05) as site, site.gate.closed():
        record = site.run().json()
        assert record["status"] == "failed"
        text = page_of(site, record)
    assert "The run failed" in text
    assert html.escape(record["error"]) in text
    assert "Edit and try again" in text
    assert "refresh" not in text
