"""Explanation of `video-rpn`: prose, formulas and figures of its page."""

from app.methods.explanations.model import Exhibit, Explanation, Figure, Formula

SMOKE = (("advected_noise", "0,0,320,320"),)
CLOUDS = (("sky_pan", "0,0,320,320"),)
WATER = (("sand_under_water", "0,0,320,320"),)

EXPLANATION = Explanation(
    what=(
        "Smoke, fire, foliage in the wind and the surface of water have no places and no moments: any part looks like "
        "any other, now and later. Such a video is a texture with one dimension more. Random phase noise is the same "
        "in three dimensions as in two: the Fourier modulus of the clip over time and space is kept, and its phase "
        "drawn at random, the same for all colours.",
        "The modulus knows how fast everything moves, and where to. An oscillation in space that travels is an "
        "oscillation in time too, and the pair of frequencies says with which velocity; what travels together lies on "
        "a plane through the origin. So the texture drifts, rises and boils as the clip does, though no shape in it "
        "was ever there. In the section through the spectrum a steady motion is a slanted line; motions of several "
        "speeds are a fan of lines, and waves of all lengths a slanted cloud.",
        "The result is periodic in all three directions: it plays in a loop without a jump, and tiles. The clip is "
        "not, so each of its frames is replaced by its periodic component, and the jump from the last frame to the "
        "first is taken out in the same way along time, where it would come back as a flicker. For a larger or a "
        "longer video the clip becomes a spot in a larger block, faded out towards its borders.",
        "What stands still in the clip has frequency zero in time, and stays there: it comes out as a still texture "
        "beneath the moving one. A clip of which all frames are equal becomes the random phase noise of that picture, "
        "the one that RPN makes of it at the same seed, for as many frames as are asked for.",
    ),
    formulas=(
        Formula(
            r"\hat{Z}(\omega, \xi) = \hat{h}(\omega, \xi)\, e^{i\theta(\omega, \xi)}, \qquad "
            r"\theta(-\omega, -\xi) = -\theta(\omega, \xi)",
            r"$h$ is the video, $\omega$ the frequency in time, $\xi$ that in space; $\theta$ is uniform on "
            r"$]-\pi, \pi]$, the same for every channel, and zero at the origin.",
        ),
        Formula(
            r"\hat{s}(\omega, \xi) = \frac{\left(1 - e^{2\pi i k/T}\right) \left(\hat{h}_0(\xi) - "
            r"\hat{h}_{T-1}(\xi)\right)}{4\sin^2\frac{\pi k}{T} + 4\sin^2\frac{\pi k_1}{H} + 4\sin^2\frac{\pi k_2}{W}}",
            r"What is taken out along time: the smooth video that jumps as the clip does between its last frame and "
            r"its first. $\omega = 2\pi k / T$ and $\xi = (2\pi k_1 / H, 2\pi k_2 / W)$, so a frame counts as a pixel. "
            r"At $k = 0$ it is zero: the average frame stays.",
        ),
        Formula(
            r"h(t, x) = g(x - vt) \;\Rightarrow\; \hat{h}(\omega, \xi) = 0 \text{ unless } "
            r"\omega = -\langle v, \xi \rangle",
            r"A picture that moves as a whole with velocity $v$ lives on a plane, and so does its noise: it moves "
            r"likewise.",
        ),
    ),
    fails=(
        "The clip's sharp structure is an alignment of phases, in time as in space: the bright net on the sand, "
        "sparks, drops, single leaves, and everything that happens once, dissolve into clouds of the right colours "
        "and speeds. Where they matter take the video patchwork, which copies pieces of the clip.",
        "All motions are mixed everywhere: a clip in which one half drifts left and the other right gives a texture in "
        "which both pass through each other. And a clip that is short for its motion shows few events, of which a long "
        "texture knows no more: slow changes come back as stains, some of them as a picture that stands still.",
        "A camera that moves, or a light that changes once from dark to bright, is no texture of the scene: hold the "
        "camera still, and crop a time in which nothing begins or ends.",
    ),
    figures=(
        Figure(
            "Smoke without an end",
            "The last frame lies on top; time runs upwards along the front and the side. The slant of the streaks is "
            "the speed at which they rise, which the noise has too.",
            (Exhibit("video-rpn", SMOKE, {"seed": 1}, ("crop-cube", "cube", "texture")),),
        ),
        Figure(
            "Clouds, and the camera's motion",
            "A camera that pans over clouds: the noise drifts at the same pace, and loops, though the clip does not. "
            "The section of the spectrum along time shows the motion as a slanted line; the zero frequencies are in "
            "the middle.",
            (Exhibit("video-rpn", CLOUDS, {"seed": 1}, ("crop-cube", "cube", "spectrum-in-time")),),
        ),
        Figure(
            "What it cannot do",
            "Sunlight under water gathers in a net of bright lines. The noise has its colours, its grain and its "
            "waves, which run as fast as the clip's, but no lines.",
            (Exhibit("video-rpn", WATER, {"seed": 1}, ("crop-cube", "cube", "crop", "texture")),),
        ),
    ),
)
