"""References: the articles that methods come from."""

from app.methods.explanations.model import Reference

IPOL_RPN = Reference(
    "B. Galerne, Y. Gousseau, J.-M. Morel",
    "Micro-Texture Synthesis by Phase Randomization",
    "Image Processing On Line 1",
    2011,
    "https://doi.org/10.5201/ipol.2011.ggm_rpn",
    pages="213--237",
)
RANDOM_PHASE_TEXTURES = Reference(
    "B. Galerne, Y. Gousseau, J.-M. Morel",
    "Random Phase Textures: Theory and Synthesis",
    "IEEE Transactions on Image Processing 20(1)",
    2011,
    "https://doi.org/10.1109/TIP.2010.2052822",
    pages="257--267",
)
PERIODIC_PLUS_SMOOTH = Reference(
    "L. Moisan",
    "Periodic plus Smooth Image Decomposition",
    "Journal of Mathematical Imaging and Vision 39(2)",
    2011,
    "https://doi.org/10.1007/s10851-010-0227-1",
    pages="161--179",
)
TEXTON = Reference(
    "A. Desolneux, L. Moisan, S. Ronsin",
    "A Compact Representation of Random Phase and Gaussian Textures",
    "IEEE International Conference on Acoustics, Speech and Signal Processing (ICASSP)",
    2012,
    "https://doi.org/10.1109/ICASSP.2012.6288148",
    kind="inproceedings",
    pages="1381--1384",
)
GAUSSIAN_MIXING = Reference(
    "G.-S. Xia, S. Ferradans, G. Peyré, J.-F. Aujol",
    "Synthesizing and Mixing Stationary Gaussian Texture Models",
    "SIAM Journal on Imaging Sciences 7(1)",
    2014,
    "https://doi.org/10.1137/130918010",
    pages="476--508",
)
SHARPNESS = Reference(
    "G. Blanchet, L. Moisan",
    "An Explicit Sharpness Index Related to Global Phase Coherence",
    "IEEE International Conference on Acoustics, Speech and Signal Processing (ICASSP)",
    2012,
    "https://doi.org/10.1109/ICASSP.2012.6288070",
    kind="inproceedings",
    pages="1065--1068",
)
SPOT_NOISE = Reference(
    "J. J. van Wijk",
    "Spot Noise: Texture Synthesis for Data Visualization",
    "Proceedings of SIGGRAPH '91",
    1991,
    "https://doi.org/10.1145/127719.122751",
    kind="inproceedings",
    pages="309--318",
)
HEEGER_BERGEN = Reference(
    "D. J. Heeger, J. R. Bergen",
    "Pyramid-Based Texture Analysis/Synthesis",
    "Proceedings of the 22nd Annual Conference on Computer Graphics and Interactive Techniques (SIGGRAPH)",
    1995,
    "https://doi.org/10.1145/218380.218446",
    kind="inproceedings",
    pages="229--238",
)
IPOL_HEEGER_BERGEN = Reference(
    "T. Briand, J. Vacher, B. Galerne, J. Rabin",
    "The Heeger-Bergen Pyramid-Based Texture Synthesis Algorithm",
    "Image Processing On Line 4",
    2014,
    "https://doi.org/10.5201/ipol.2014.79",
    pages="276--299",
)
STEERABLE_PYRAMID = Reference(
    "E. P. Simoncelli, W. T. Freeman",
    "The Steerable Pyramid: A Flexible Architecture for Multi-Scale Derivative Computation",
    "IEEE International Conference on Image Processing (ICIP)",
    1995,
    "https://doi.org/10.1109/ICIP.1995.537667",
    kind="inproceedings",
    pages="444--447",
)
EFROS_LEUNG = Reference(
    "A. A. Efros, T. K. Leung",
    "Texture Synthesis by Non-parametric Sampling",
    "Proceedings of the Seventh IEEE International Conference on Computer Vision (ICCV)",
    1999,
    "https://doi.org/10.1109/ICCV.1999.790383",
    kind="inproceedings",
    pages="1033--1038",
)
IPOL_EFROS_LEUNG = Reference(
    "C. Aguerrebere, Y. Gousseau, G. Tartavel",
    "Exemplar-based Texture Synthesis: the Efros-Leung Algorithm",
    "Image Processing On Line 3",
    2013,
    "https://doi.org/10.5201/ipol.2013.59",
    pages="223--241",
)
OPPENHEIM_LIM = Reference(
    "A. V. Oppenheim, J. S. Lim",
    "The Importance of Phase in Signals",
    "Proceedings of the IEEE 69(5)",
    1981,
    "https://doi.org/10.1109/PROC.1981.12022",
    pages="529--541",
)
PATCHWORK = Reference(
    "P. Harrison",
    "Patchwork Texture Synthesis",
    "Technical report, School of Computer Science and Software Engineering, Monash University",
    2002,
    "https://www.logarithmic.net/pfh/",
    kind="incollection",
)
