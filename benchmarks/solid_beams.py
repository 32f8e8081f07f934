"""The constants of beams with the sections of solid_cases.py."""

from typing import NamedTuple

from solid_cases import mirrored
from solid_section import Section


class Beam(NamedTuple):
    """Stiffnesses, and inertia per length."""
    EI: float
    GA: float      # with the shear area
    GJ: float
    ECw: float     # of warping; 0: Saint-Venant's torsion
    mass: float
    rotary: float  # about the horizontal axis
    polar: float   # about x


def beam_of(kind, material=None, parts=8):
    """The constants of a body's section."""
    section = Section(kind.y, mirrored(kind.z), kind.solid, parts)
    elastic, poisson, density = material or kind.material
    shear = elastic / (2 + 2 * poisson)
    return Beam(elastic * section.I, shear * section.shear_area, shear * section.J, elastic * section.Cw,
                density * section.area, density * section.I, density * section.polar)


def without_warping(beam):
    return beam._replace(ECw=0.0)
