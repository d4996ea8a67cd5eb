"""Mutation test: break the code in one place at a time, in a copy, and see whether a test notices.

`make mutants EACH=60 SEED=1`. pytest-testmon knows which tests run a function; only those are run against its mutants.
"""

import argparse
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue

from scripts.mutants.breaks import Mutant, mutants_of

ROOT = Path(__file__).resolve().parents[2]
# The part of the code → what its tests notice when nothing but mutants that change no behaviour is left, in percent.
GROUPS = {
    "synthesis": ("app/synthesis/", 97),
    "experiments, executor and store": ("app/experiments/|app/executor/|app/store/", 92),
    "web and images": ("app/web/|app/images/", 92),
    "scripts of the pages": ("static/js/", 85),
}
SCRIPT_TESTS = [str(Path(sys.executable).parent / "node"), "--test", "tests/js/*.test.js"]
SCRIPTS = "scripts of the pages"
LEFT_OUT = "acceptance or chaos or load"
HANGS = 30  # seconds without a test that ends


@dataclass(frozen=True)
class Options:
    each: int
    seed: int
    seconds: float
    jobs: int
    tests: str
    left_out: str


def copy(to: Path) -> None:
    """What git tracks, as it lies in the checkout: mutants never touch the checkout itself."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True)
    for name in filter(None, listed.stdout.split("\0")):
        if (ROOT / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, to / name)
    (to / "node_modules").symlink_to(ROOT / "node_modules")


def pytest(options: Options, *arguments: str) -> list[str]:
    chosen = ["-m", f"not ({options.left_out})", "-p", "no:cacheprovider", "--testmon-forceselect"]
    return [sys.executable, "-m", "pytest", "-q", *arguments, *chosen, *options.tests.split()]


def begin(command: list[str], root: Path, output: Path) -> subprocess.Popen[bytes]:
    # Bytecode is known by its second and size, and a mutant may have both of the one before it.
    variables = os.environ | {"PYTHONPATH": str(root), "PYTHONDONTWRITEBYTECODE": "1"}
    with output.open("wb") as stream:
        return subprocess.Popen(
            command, cwd=root, env=variables, stdout=stream, stderr=subprocess.STDOUT, start_new_session=True
        )


def learn_scripts(root: Path) -> None:
    """Run the tests of the pages' scripts once."""
    output = root / "learned.txt"
    if begin(SCRIPT_TESTS, root, output).wait():
        sys.exit(f"The scripts' tests fail without a mutant:\n{output.read_text(errors='replace')[-3000:]}")


def learn(root: Path, options: Options) -> None:
    """Run every test once, so that testmon knows what each of them runs."""
    if (ROOT / ".testmondata").exists():
        shutil.copy2(ROOT / ".testmondata", root)
    output = root / "learned.txt"
    command = pytest(options, "-n", str(options.jobs), "--dist", "loadfile", "--testmon")
    if begin(command, root, output).wait() not in {0, 5}:  # 5: all is known already
        sys.exit(f"The tests fail without a mutant:\n{output.read_text(errors='replace')[-3000:]}")


def verdict(root: Path, mutant: Mutant, options: Options) -> str:
    """``killed``, ``hangs`` or ``survived``, and what ran."""
    file, output = root / mutant.path, root / "mutant.txt"
    original = file.read_text(encoding="utf-8")
    command = SCRIPT_TESTS if mutant.path.endswith(".js") else pytest(options, "-x", "--testmon", "--testmon-nocollect")
    file.write_text(mutant.text, encoding="utf-8")
    process = begin(command, root, output)
    try:
        code = process.wait(options.seconds)
    except subprocess.TimeoutExpired:
        idle = time.time() - output.stat().st_mtime
        return "hangs" if idle > HANGS else f"survived {options.seconds:.0f} s of its tests"
    finally:
        _end(process)
        file.write_text(original, encoding="utf-8")
    ran = re.findall(r"(\d+) passed", output.read_text(errors="replace"))
    if code == 0:
        return f"survived {ran[-1] if ran else 'no'} tests"
    return "survived, for no test runs it" if code == 5 else "killed"


def _end(process: subprocess.Popen[bytes]) -> None:
    """The tests, and what they started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def sample(pattern: str, options: Options) -> list[Mutant]:
    """The mutants of a group that are tried: by the seed, from all files alike."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    paths = [path for path in listed if re.match(pattern, path) and path.endswith((".py", ".js"))]
    if pattern == GROUPS[SCRIPTS][0]:  # those that run without a browser
        tests = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "tests" / "js").glob("*.test.js"))
        paths = [path for path in paths if path in tests]
    found = [mutant for path in paths for mutant in mutants_of(ROOT, path)]
    return random.Random(options.seed).sample(found, min(options.each, len(found)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--each", type=int, default=60, help="mutants of each group")
    parser.add_argument("--seed", type=int, default=int(time.time()) // 86400, help="which; default: by the day")
    parser.add_argument("--seconds", type=float, default=90, help="that the tests of one mutant may take")
    parser.add_argument("--jobs", type=int, default=2, help="mutants at a time")
    parser.add_argument("--group", choices=GROUPS, action="append", help="only this one")
    parser.add_argument("--tests", default="", help="only these tests, e.g. tests/store")
    parser.add_argument("--left-out", default=LEFT_OUT, help="markers of tests that are not run")
    given = vars(parser.parse_args())
    groups = given.pop("group") or list(GROUPS)
    options = Options(**given)
    with tempfile.TemporaryDirectory(prefix="mutants-") as directory:
        roots = [Path(directory) / str(number) for number in range(options.jobs)]
        copy(roots[0])
        if SCRIPTS in groups:
            learn_scripts(roots[0])
        if groups != [SCRIPTS]:
            learn(roots[0], options)
        free: SimpleQueue[Path] = SimpleQueue()
        for root in roots:
            if root != roots[0]:
                shutil.copytree(roots[0], root, symlinks=True)
            free.put(root)

        def tried(mutant: Mutant) -> tuple[Mutant, str]:
            root = free.get()
            try:
                return mutant, verdict(root, mutant, options)
            finally:
                free.put(root)

        print(f"Seed {options.seed}")
        for group in groups:
            pattern, aim = GROUPS[group]
            with ThreadPoolExecutor(options.jobs) as pool:
                results = list(pool.map(tried, sample(pattern, options)))
            survivors = [(mutant, said) for mutant, said in results if said.startswith("survived")]
            score = 100 * (1 - len(survivors) / max(1, len(results)))
            print(f"\n{group}: {score:.0f} % of {len(results)} mutants noticed; the aim is {aim} %", flush=True)
            for mutant, said in survivors:
                print(f"  {mutant}  ({said})", flush=True)


if __name__ == "__main__":
    main()
