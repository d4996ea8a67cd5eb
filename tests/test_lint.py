"""The lint of the pages' scripts finds every promise that nobody waits for, and calls of what has no type."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
BEGIN = """
import { start } from "./start.js";
export async function ask() { await fetch("/"); }
export class Clock { async tick() { await fetch("/"); } }
/** @param {unknown} finished */
export function untyped(finished) { return finished; }
/** @param {() => Promise<void>} finished */
export function typed(finished) { start(finished); }
export const make = async () => { await fetch("/"); };
"""
PLANTED = [
    "export function planted() { ask(); }",
    "export function planted() { void ask(); }",
    "export function planted(clock = new Clock()) { clock.tick(); }",
    'export function planted() { fetch("/").then((answer) => answer.json()); }',
    "export function planted(numbers = [1, 2]) { numbers.forEach(async (each) => { await fetch(String(each)); }); }",
    "export function planted(numbers = [1, 2]) { numbers.map(() => ask()); }",
    'document.body.addEventListener("click", async () => { await ask(); });',
    'document.body.addEventListener("click", () => ask());',
    'document.body.addEventListener("click", ask);',
    'document.body.addEventListener("click", { handleEvent: ask });',
    'export function planted(any) { any.addEventListener("click", async () => { await ask(); }); }',
    'export function planted(any) { any.addEventListener("click", () => any.ready && ask()); }',
    "export function planted(any) { return any.ready ? any : ask(); }",
    "document.body.onclick = async () => { await ask(); };",
    "document.body.onclick = ask;",
    "export function planted(any) { any.ended = ask; }",
    "setTimeout(async () => { await ask(); }, 1);",
    "setTimeout(ask, 1);",
    "setTimeout(make, 1);",
    "setInterval(ask, 1);",
    "setInterval(() => ask(), 1);",
    "setTimeout(ask.bind(null), 1);",
    "requestAnimationFrame(ask);",
    "queueMicrotask(ask);",
    "new ResizeObserver(ask).observe(document.body);",
    "new Promise(async (done) => { done(await ask()); });",
    "untyped(ask);",
    "untyped(ask());",
    "untyped({ ask });",
    "untyped({ on: { ask: async () => { await ask(); } } });",
    "untyped([ask]);",
    "untyped(...[ask]);",
    "export function planted(clock) { clock.tick(); }",
    "export function planted(clock) { clock?.tick(); }",
    "export function planted(clock) { if (clock.ready) clock.ready && clock.tick(); }",
    "export function planted(clock) { setTimeout(() => clock.tick(), 1); }",
    "export function planted(any) { any.make(); }",
    "export function planted(video) { video.play(); }",
    'export function planted(page) { page.clipboard.writeText("words"); }',
]
RIGHT = [
    "export async function right() { await ask(); }",
    "export function right() { ask().catch(reportError); }",
    "export function right() { return ask(); }",
    "/** @param {HTMLVideoElement} video */ export function right(video) { video.play().catch(reportError); }",
    "typed(ask);",
    "typed(async () => { await ask(); });",
    "start(ask);",
    "start(() => new Clock().tick());",
    "setTimeout(() => start(ask), 1);",
    'document.body.addEventListener("click", () => start(ask));',
    "export async function right() { return await Promise.all([ask(), ask()]); }",
    "export async function right(numbers = [1]) { await Promise.all(numbers.map(async () => { await ask(); })); }",
    "export async function right() { await new Promise((over) => setTimeout(over, 1)); }",
    "export async function right() { untyped(await (await ask(), fetch('/'))); }",
    "/** @param {Element} each */ export function right(each) { each.append('x', untyped(1)); each.remove(); }",
]


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[str]]:
    """Script → the rules that it breaks, each script in a file of its own beside those of the pages."""
    root = tmp_path_factory.mktemp("lint")
    for name in ("eslint.config.js", "tsconfig.json", "package.json"):
        shutil.copy(ROOT / name, root)
    shutil.copytree(ROOT / "lint", root / "lint")
    (root / "node_modules").symlink_to(ROOT / "node_modules")
    scripts = root / "static" / "js" / "lib"
    scripts.mkdir(parents=True)
    shutil.copy(ROOT / "static" / "js" / "lib" / "start.js", scripts)
    for number, text in enumerate(PLANTED + RIGHT):
        (scripts / f"{number}.js").write_text(BEGIN + text + "\n")
    node = Path(sys.executable).parent / "node"
    command = [str(node), str(ROOT / "node_modules" / "eslint" / "bin" / "eslint.js"), "--format", "json", "static/js"]
    output = subprocess.run(command, cwd=root, capture_output=True, text=True, timeout=300, check=False)
    assert output.returncode == 1, output.stderr
    files = {Path(entry["filePath"]).stem: entry["messages"] for entry in json.loads(output.stdout)}
    assert files.pop("start") == []
    scripts_found = {}
    for number, text in enumerate(PLANTED + RIGHT):
        messages = files[str(number)]
        assert all(message["line"] > BEGIN.count("\n") for message in messages), messages
        scripts_found[text] = [message["ruleId"] for message in messages]
    return scripts_found


@pytest.mark.parametrize("script", PLANTED)
def test_a_promise_that_nobody_waits_for_is_found(found: dict[str, list[str]], script: str) -> None:
    assert any(rule and ("promise" in rule or "unsafe" in rule) for rule in found[script])


@pytest.mark.parametrize("script", RIGHT)
def test_what_is_waited_for_or_looked_after_is_right(found: dict[str, list[str]], script: str) -> None:
    assert found[script] == []
