"""Hand calculations of ACI 318 for rectangular sections, in inches, pounds and psi. f_c: the compressive strength of concrete."""
from math import sqrt

DIRECT = 251  # psi, the direct tensile strength that the thesis takes for f_c = 4000 psi (ACI 224.2R, 0.33 sqrt(145 f_c))


def rupture(fc):
    """Modulus of rupture of concrete of normal weight (ACI 318-19, 19.2.3.1) [psi]."""
    return 7.5 * sqrt(fc)


def cracking_moment(strength, width, height):
    """Moment under which the outermost fibre of a plain section reaches a strength (24.2.3.5) [lb in]."""
    return strength * width * height**2 / 6


def block_depth(steel, fy, fc, width):
    """Depth of Whitney's stress block that balances the yield force of the bars (22.2.2.4) [in]."""
    return steel * fy / (0.85 * fc * width)


def nominal_moment(steel, fy, fc, width, depth):
    """Nominal moment of a section with bars of area `steel` at the effective depth, which yield (22.3) [lb in]."""
    return steel * fy * (depth - block_depth(steel, fy, fc, width) / 2)


def shear_strength(fc, width, depth):
    """V_c of a section without stirrups (318-14, 22.5.5.1, as the thesis takes it) [lb]."""
    return 2 * sqrt(fc) * width * depth


def deep_shear_limit(fc, width, depth):
    """The most that a deep beam may bear in shear (9.9.2.1, without its factor) [lb]."""
    return 10 * sqrt(fc) * width * depth
