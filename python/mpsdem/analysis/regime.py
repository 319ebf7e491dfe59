"""How the solids travel: as a bed, in jumps, or suspended."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

# Shares of the solids' volume that are in the bed [-]: below the first the load is suspended, from
# the second on it is a bed.
_FEW, _MOST = 0.1, 0.5
_AT_REST = 0.05  # [-] velocity of the bed over the bulk velocity
_EVEN = 0.8  # [-] concentration of the upper half of the bore over that of the lower half

CRITERION = (
    f"at least {_MOST:.0%} of the solids' volume in the bed (touching the wall below, or a chain "
    f"of solids down to it): stationary bed if the bed moves slower than {_AT_REST:g} of the bulk "
    f"velocity, else sliding bed; {_FEW:.0%} to {_MOST:.0%}: saltation; less: homogeneous if the "
    f"upper half of the bore holds {_EVEN:g} to {1 / _EVEN:g} times the solids of the lower half, "
    "else heterogeneous"
)
"""The rule that `flow_regime` goes by, in words."""


class Regime(StrEnum):
    """Ways in which solids travel, from slow to fast, as in Durand's and Newitt's diagrams."""

    STATIONARY_BED = "stationary bed"
    SLIDING_BED = "sliding bed"
    SALTATION = "saltation"
    HETEROGENEOUS = "heterogeneous"
    HOMOGENEOUS = "homogeneous"


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowRegime:
    """The regime of a flow, and the numbers that it was told by.

    Parameters
    ----------
    regime : Regime
        Which one.
    bed_share : float
        Share of the solids' volume that is in the bed [-].
    bed_velocity_ratio : float
        Mean axial velocity of the bed over the bulk velocity [-]; NaN where there is no bed.
    upper_over_lower : float
        Concentration of the upper half of the bore over that of the lower half [-].
    """

    regime: Regime
    bed_share: float
    bed_velocity_ratio: float
    upper_over_lower: float


def flow_regime(
    *, bed_share: float, bed_velocity_ratio: float, upper_over_lower: float
) -> FlowRegime:
    """Tell the regime from the share of the bed, its velocity, and how even the suspension is.

    Parameters
    ----------
    bed_share : float
        Share of the solids' volume that is in the bed, as `in_bed` finds it [-].
    bed_velocity_ratio : float
        Mean axial velocity of the bed over the bulk velocity [-]; NaN where there is no bed.
    upper_over_lower : float
        Concentration of the upper half of the bore over that of the lower half [-].

    Returns
    -------
    FlowRegime
        The regime, with these numbers.

    Notes
    -----
    `CRITERION` states the rule. The regimes are those of Durand & Condolios (1952) and of Newitt et
    al. (1955), who told them by eye, and which Miedema (2016) keeps; their borders here are ours,
    as none is agreed on: half of the solids, a tenth, a twentieth of the bulk velocity. Wasp et al.
    (1977) call a suspension homogeneous from a ratio of 0.8 of the concentrations near the roof and
    on the axis; of coarse solids, which do not get that near to the roof, the halves are compared.

    References
    ----------
    Durand & Condolios (1952), Coll. Hydraulic Transport of Solid Materials, National Coal Board;
    Newitt, Richardson, Abbott & Turtle (1955), Trans. Inst. Chem. Eng. 33, 93-113; Wasp, Kenny &
    Gandhi (1977), Solid-liquid flow: slurry pipeline transportation; Miedema (2016), Slurry
    Transport, TU Delft.
    """
    if bed_share >= _MOST:
        at_rest = math.isnan(bed_velocity_ratio) or abs(bed_velocity_ratio) < _AT_REST
        regime = Regime.STATIONARY_BED if at_rest else Regime.SLIDING_BED
    elif bed_share >= _FEW:
        regime = Regime.SALTATION
    else:
        even = _EVEN <= upper_over_lower <= 1 / _EVEN
        regime = Regime.HOMOGENEOUS if even else Regime.HETEROGENEOUS
    return FlowRegime(
        regime=regime,
        bed_share=bed_share,
        bed_velocity_ratio=bed_velocity_ratio,
        upper_over_lower=upper_over_lower,
    )
