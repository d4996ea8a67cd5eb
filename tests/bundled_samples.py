"""Records of the bundled samples, without a service that takes them in."""

from datetime import UTC, datetime

import av
from PIL import Image

from app.experiments.model import Sample
from app.images.media import Media
from app.samples import read_catalogue
from app.settings import ROOT


def sample_of(sample_id: str) -> Sample:
    """What the store would know of a bundled photograph or clip."""
    entry = next(entry for entry in read_catalogue(ROOT / "samples") if entry.id == sample_id)
    if entry.kind == "moving":
        with av.open(entry.path) as container:
            film = container.streams.video[0]
            rate = float(film.average_rate or 0)
            video = Media(film.width, film.height, 3, 8, False, film.frames, rate)
            return Sample(**video.properties(), id=sample_id, digest="", created_at=datetime.now(UTC))
    with Image.open(entry.path) as picture:
        channels = 1 if picture.mode in ("L", "I;16") else 3
        return Sample(*picture.size, channels, 8, False, id=sample_id, digest="", created_at=datetime.now(UTC))
