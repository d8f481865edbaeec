"""Wear of hips as it was measured: simulators and patients, each number with its source and what of that was read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, kw_only=True)
class Published:
    """A number that was published.

    Attributes
    ----------
    what : str
    value : float
    unit : str
    source : str
    off : float
        To both sides: half the interval or the deviation of `spread`; 0 where none is told.
    spread : str
        What `off` is.
    read : str
        What of the source was read.
    """

    what: str
    value: float
    unit: str
    source: str
    off: float = 0.0
    spread: str = ""
    read: str = "abstract"

    def __str__(self) -> str:
        return f"{self.value:g} ± {self.off:g}" if self.off else f"{self.value:g}"


_CLARKE = "Clarke et al., ceramic heads of different sizes on polyethylene"
_ALI = "Ali et al., Bone Joint J Orthop Proc"
_COOPER = "Cooper et al. 2023, Orthop Proc 105-B SUPP 9"
_JOGGING = "Bioengineering 2025, 12, 663"
_RSA = "10-year radiostereometry, 10.1080/17453674.2021.1932140"
_MCCALDEN = "McCalden et al. 2009, 10.2106/JBJS.H.00244"
_RATE = "mm3/Mc"

PUBLISHED: Mapping[str, Published] = MappingProxyType(
    {
        "clarke-22": Published(what="22 mm, serum, 2 kN", value=23, unit=_RATE, source=_CLARKE),
        "clarke-28": Published(what="28 mm, serum, 2 kN", value=32, unit=_RATE, source=_CLARKE),
        "ali-45": Published(what="36 mm, cup at 45°", value=12.8, off=3.8, spread="95 %", unit=_RATE, source=_ALI),
        "ali-65": Published(what="36 mm, cup at 65°", value=15.4, off=5.0, spread="95 %", unit=_RATE, source=_ALI),
        "ali-45-off": Published(
            what="36 mm, 45°, centres 4 mm off", value=21.5, off=5.5, spread="95 %", unit=_RATE, source=_ALI
        ),
        "ali-65-off": Published(
            what="36 mm, 65°, centres 4 mm off", value=23.0, off=5.7, spread="95 %", unit=_RATE, source=_ALI
        ),
        "cooper": Published(what="ISO 14242-1", value=12.5, unit=_RATE, source=_COOPER),
        "cooper-off": Published(what="then ISO 14242-4", value=22.3, unit=_RATE, source=_COOPER),
        "walking": Published(
            what="ISO walking", value=15.24, off=0.55, spread="deviation", unit=_RATE, source=_JOGGING
        ),
        "jogging": Published(
            what="a patient's jogging", value=28.68, off=0.88, spread="deviation", unit=_RATE, source=_JOGGING
        ),
        "saikko": Published(
            what="32 mm zirconia, distilled water", value=4.1, unit="mg/Mc", source="Saikko 1994, Wear 176, 207"
        ),
        "rsa-bedding": Published(what="conventional, first 3 months", value=0.39, unit="mm", source=_RSA),
        "rsa-rate": Published(what="conventional, 3 months to 10 years", value=0.12, unit="mm/year", source=_RSA),
        "rsa-bedding-linked": Published(what="cross-linked, first 3 months", value=0.21, unit="mm", source=_RSA),
        "rsa-rate-linked": Published(
            what="cross-linked, 3 months to 10 years", value=0.02, unit="mm/year", source=_RSA
        ),
        "mccalden-linked": Published(
            what="cross-linked, years 1 to 5",
            value=0.003,
            off=0.027,
            spread="95 %",
            unit="mm/year",
            source=_MCCALDEN,
        ),
        "teeter": Published(
            what="conventional 28 mm, after bedding-in",
            value=0.051,
            unit="mm/year",
            source="Teeter 2017",
            read="second hand",
        ),
        "callary": Published(
            what="cross-linked, 12 cohorts",
            value=0.03,
            off=0.03,
            spread="range",
            unit="mm/year",
            source="Callary et al. 2015, 10.3109/17453674.2014.972890",
        ),
        "lachiewicz": Published(
            what="cross-linked, median",
            value=0.028,
            unit="mm/year",
            source="Lachiewicz et al. 2009, 10.1007/s11999-009-1038-9",
        ),
        "lachiewicz-volume": Published(
            what="cross-linked, median",
            value=25.6,
            unit="mm3/year",
            source="Lachiewicz et al. 2009, 10.1007/s11999-009-1038-9",
        ),
    }
)
"""By a name of its own. Numbers of the first cycles and of serum are the sources' own."""
