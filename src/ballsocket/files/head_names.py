"""Names of columns in tables: the names that laboratories and their machines use, in English and German."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from types import MappingProxyType

_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue"})

_COUNTS = {
    1.0: " 1",
    1e3: "10^3 1e3 kc thousand tausend tsd",
    1e6: "10^6 1e6 mc million millions millionen mio",
}
"""Units of counts by their factors; further signs are removed."""

_OTHER_NAMES = {
    "time": "zeit pruefzeit test_time elapsed_time",
    "phase": "cycle gait_cycle gangzyklus",
    "force": "f load compressive_load axial_force axial_load standard_force kraft last standardkraft pruefkraft "
    "axialkraft druckkraft normalkraft",
    "force_x": "kraft_x",
    "force_y": "kraft_y",
    "force_z": "kraft_z",
    "indentation": "displacement axial_displacement compressive_displacement crosshead_displacement extension "
    "compressive_extension standard_travel stroke eindrueckung weg standardweg traversenweg verschiebung",
    "flexion": "beugung flexion_extension",
    "adduction": "adduktion",
    "rotation": "drehung internal_rotation innenrotation",
    "angle": "winkel",
    "half_angle": "contact_half_angle",
    "area": "contact_area flaeche kontaktflaeche",
    "pressure": "contact_pressure druck kontaktdruck",
    "max_pressure": "maximum_pressure peak_pressure maximaldruck spitzendruck",
    "stiffness": "steifigkeit",
    "clearance": "radial_clearance",
    "diametral_clearance": "diameter_clearance durchmesserspiel",
    "cycles": "zyklen zyklenzahl lastwechsel number_of_cycles cycle_count",
    "million_cycles": "mc mcycles millions_of_cycles 10_6_cycles 10⁶_cycles mio_zyklen mio_lastwechsel "
    "millionen_zyklen millionen_lastwechsel 10_6_zyklen 10⁶_zyklen 10_6_lastwechsel 10⁶_lastwechsel",
    "volume": "volumen wear_volume verschleissvolumen",
    "mass": "masse mass_loss masseverlust weight_loss gewichtsverlust",
    "station": "specimen probe pruefling",
}

HEAD_NAMES: Mapping[str, str] = MappingProxyType(
    {other: name for name, others in _OTHER_NAMES.items() for other in others.split()}
)
"""Names of quantities by other plain names; a displacement is positive into the socket, and 0 at first touch."""

UNCERTAINTY = "_uncertainty"  # end of the name of a column with the standard uncertainties of another column


def known_head(plain: str, names: Collection[str]) -> str:
    """Return the one of the known names that a plain name means; "" for another one."""
    base = plain.removesuffix(UNCERTAINTY)
    name = plain if plain in names else HEAD_NAMES.get(base, "") + plain[len(base) :]
    return name if name in names else ""


def count_factor(unit: str) -> float | None:
    """Return the factor of a unit of counts, such as 1e6 for "Mio.", "million cycles", "x 10^6"; None if unknown."""
    text = unit.lower().replace("**", "^").replace("⁶", "^6").replace("³", "^3")
    plain = re.sub(r"[\s.]|^[x×]|(cycles|zyklen|lastwechsel)$", "", text)
    return next((factor for factor, units in _COUNTS.items() if plain in units.split(" ")), None)


def plain_name(text: str) -> str:
    """Return a name in small letters without accents, with "_" between its words.

    Examples
    --------
    >>> plain_name("Max. Eindrückung ")
    'max_eindrueckung'
    """
    letters = text.lower().translate(_LETTERS).replace("ß", "ss")
    return "_".join("".join(char if char.isalnum() else " " for char in letters).split())
