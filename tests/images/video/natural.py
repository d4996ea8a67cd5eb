"""Moving textures for the encoders, made from bundled photographs as a slow camera would."""

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.settings import ROOT


def natural_video(
    count: int = 12, height: int = 96, width: int = 128, channels: int = 3, photograph: str = "sand_desert009.png"
) -> NDArray[np.uint8]:
    """A crop of a photograph that drifts by parts of a pixel, (T, H, W, C)."""
    with Image.open(ROOT / "samples" / photograph) as opened:
        image = opened.convert("L" if channels == 1 else "RGB")
    return np.stack(
        [
            np.asarray(
                image.transform(
                    (width, height),
                    Image.Transform.AFFINE,
                    (1, 0, 8 + 1.37 * t, 0, 1, 8 + 0.61 * t),
                    Image.Resampling.BICUBIC,
                )
            ).reshape(height, width, channels)
            for t in range(count)
        ]
    )
