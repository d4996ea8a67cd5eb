"""Screenshot of an experiment's page for the README, docs/gallery.png: ``make readme-picture``."""

import os
import shutil
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from app.samples import read_catalogue
from app.settings import ROOT, Settings
from benchmarks.served import served

SAMPLE = "grass_jungle002"  # public domain: nobody's name has to stand below the picture
WIDTH, HEIGHT = 1440, 900
PICTURE = ROOT / "docs" / "gallery.png"


def main() -> None:
    """Run an experiment of a service of its own and photograph its page."""
    photograph = next(entry for entry in read_catalogue(Settings().samples_dir) if entry.id == SAMPLE)
    with tempfile.TemporaryDirectory() as directory, served(Path(directory)) as service:
        service.wait_for_sample(SAMPLE)
        experiment = service.finish(
            {
                "method": "rpn",
                "inputs": [{"sample": SAMPLE, "crop": vars(photograph.crop)}],
                "parameters": {"width": 1024, "height": 1024, "seed": 7},
            }
        )
        with sync_playwright() as playwright:
            chromium = os.environ.get("CHROMIUM") or shutil.which("chromium")
            browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
            page.goto(experiment["page"], wait_until="networkidle")
            page.screenshot(path=PICTURE)
            browser.close()
    print(f"{PICTURE.relative_to(ROOT)}: {PICTURE.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main()
