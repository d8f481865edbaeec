"""Preset materials and joints, each with the source of its numbers.

`representative` marks a typical engineering value without a published source.
"""

from __future__ import annotations

from math import inf
from types import MappingProxyType
from typing import Any

from ..core.checks import NamedItems, check_text, shown
from ..core.kinds import MEGAPASCALS
from ..core.unit_systems import Amount, Sentence
from .hardening import Hardening
from .joint import Joint
from .material import Material

_PAPER = "Heß & Forsbach 2021, Table 2, doi 10.3390/app112311170"
_REVIEW = "Di Puccio & Mattei 2015, Table 2, doi 10.5312/wjo.v6.i1.77"
_PLANK = "thickness: Plank et al. 2007, J. Biomed. Mater. Res. B 80B, 1-10; clearance: representative"
_TABLE_1 = "representative, within Heß & Forsbach 2021, Table 1"
_BALL_JOINT = "representative (construction: Wozniak et al. 2021, doi 10.3390/en14113238); run in, its preload lost"
_BRIDGE_BEARING = "representative (construction: CEN 2004, EN 1337-7)"
_PIVOT = "representative (pivot type: Kirk & Reedy 1988, J. Vib. Acoust. 110, 165)"
_GLENOSPHERE = "representative; insert thickness 3-9 mm in Giles et al. 2015, doi 10.1007/s11999-015-4526-0"

UHMWPE = Material(
    young=1000.0,
    poisson=0.4,
    name="UHMWPE",
    source=f"{_PAPER} (which also uses nu 0.45); yield: least of ASTM F648 type 1 (unverified); "
    "proportional limit: three-network model of Bergström & Bischoff 2010, Int. J. Struct. Changes Solids 2, 31, in "
    "compression at 300 K and 0.007/s",
    proportional_limit=7.5,
    yield_stress=21.0,
    hardening=Hardening(
        stress=(7.44, 11.12, 13.75, 15.77, 18.65, 20.67, 23.23, 24.46, 25.32, 26.07),
        plastic_strain=(0.0, 0.0026, 0.0058, 0.0094, 0.0175, 0.0262, 0.0445, 0.0636, 0.0831, 0.1025),
        young=1494.0,
        source="three-network model of Bergström & Bischoff 2010, Int. J. Struct. Changes Solids 2, 31, at 300 K and "
        "0.007/s: true stress",
    ),
)
CROSSLINKED_PE = Material(
    young=750.0,
    poisson=0.4,
    name="cross-linked PE",
    source="representative: middle of 0.5-1 GPa, Heß & Forsbach 2021 after Kurtz et al. 2002, Biomaterials 23, 3681; "
    "yield: that of UHMWPE, which irradiation hardly changes (Oral et al. 2006, Biomaterials 27, 917); "
    "proportional limit: that of UHMWPE (unverified)",
    proportional_limit=7.5,
    yield_stress=21.0,
)
POM = Material(
    young=2850.0,
    poisson=0.35,
    name="POM",
    source="E: Ticona 2008, Hostaform C 9021 data sheet (ISO 527; 1300 MPa after 1000 h); nu: representative; "
    "yield: data sheet of Hostaform C 9021 XAP (ISO 527, 50 mm/min)",
    yield_stress=64.0,
)
PTFE = Material(
    young=500.0,
    poisson=0.46,
    name="PTFE",
    source="E: within 0.40-0.55 GPa, Callister 2007, Table B.2; nu: representative. Creeps at all stresses",
)
PEEK = Material(
    young=3500.0,
    poisson=0.37,
    name="PEEK",
    source="representative; yield: design guide of KetaSpire KT-820, ASTM D638 (unverified)",
    yield_stress=95.0,
)

_LONG_TERM_MODULI = {
    "POM": (1300.0, 1000.0, "Ticona 2008, Hostaform C 9021 data sheet, tensile creep modulus (ISO 899-1)"),
}
"""Creep modulus in MPa, hours under load and source, by the name of the preset; its `young` is for a short load."""


def long_term_note(material: Material) -> str:
    """Describe the long-term modulus of a preset material in a sentence; empty without data, or for another modulus."""
    preset = next((preset for preset in materials.values() if preset.name == material.name), None)
    if material.name not in _LONG_TERM_MODULI or preset is None or float(material.young) != preset.young:
        return ""
    young, hours, source = _LONG_TERM_MODULI[material.name]
    return Sentence(
        f"{{}}: E {{}} is the modulus of a short load; after {hours:g} hours under load it is {{}} ({{}})",
        material.name,
        Amount(float(preset.young), MEGAPASCALS),
        Amount(young, MEGAPASCALS),
        source,
    )


STEEL = Material(young=230000.0, poisson=0.3, name="steel head", source=f"{_PAPER}; high for a stainless steel")
STRUCTURAL_STEEL = Material(
    young=210000.0,
    poisson=0.3,
    name="structural steel",
    source="CEN 2005, EN 1993-1-1, 3.2.6; yield: S235, the least grade, to 16 mm thick, EN 10025-2:2004, Table 7",
    yield_stress=235.0,
)
COCR = Material(
    young=230000.0,
    poisson=0.3,
    name="CoCr",
    source=f"{_REVIEW}; yield: least of annealed bar, ASTM F1537 (unverified)",
    yield_stress=517.0,
)
ALUMINA = Material(
    young=380000.0,
    poisson=0.23,
    name="alumina",
    source="E: Kutz 2009, Biomed. Eng. and Design Handbook 1, Table 15.1; nu: NIST SRD 150, doi 10.18434/T42G62",
)
ALUMINA_COMPOSITE = Material(
    young=350000.0, poisson=0.26, name="zirconia-toughened alumina", source=f"BIOLOX delta: {_REVIEW}"
)
TITANIUM = Material(
    young=110000.0,
    poisson=0.3,
    name="titanium",
    source="representative of Ti-6Al-4V; yield: least of annealed ELI bar below 44 mm, ASTM F136",
    yield_stress=795.0,
)
BONE_CEMENT = Material(young=2300.0, poisson=0.33, name="bone cement", source="representative of PMMA, 2-2.5 GPa")
CORTICAL_BONE = Material(
    young=17000.0, poisson=0.3, name="cortical bone", source="representative; anisotropic, and varies from site to site"
)
CANCELLOUS_BONE = Material(
    young=500.0, poisson=0.2, name="cancellous bone", source="representative; varies widely with its density"
)

_MATERIALS: dict[str, Material] = {
    "uhmwpe": UHMWPE,
    "crosslinked-pe": CROSSLINKED_PE,
    "pom": POM,
    "ptfe": PTFE,
    "peek": PEEK,
    "steel": STEEL,
    "structural-steel": STRUCTURAL_STEEL,
    "cocr": COCR,
    "alumina": ALUMINA,
    "alumina-composite": ALUMINA_COMPOSITE,
    "titanium": TITANIUM,
    "bone-cement": BONE_CEMENT,
    "cortical-bone": CORTICAL_BONE,
    "cancellous-bone": CANCELLOUS_BONE,
}

_LABELS = {
    UHMWPE: "UHMWPE, conventional",
    CROSSLINKED_PE: "cross-linked UHMWPE",
    POM: "POM, acetal copolymer",
    PEEK: "PEEK, unfilled",
    STRUCTURAL_STEEL: "structural steel, S235",
    COCR: "CoCrMo",
    ALUMINA: "alumina ceramic",
    TITANIUM: "titanium alloy, Ti-6Al-4V",
    BONE_CEMENT: "bone cement, PMMA",
}
"""Names on pages for readers; drawings have the part before a comma."""


def material_label(material: Material | None, unnamed: str) -> str:
    """Return the plain name of a material for pages: "rigid" for None, and a word for one without a name.

    A material with other elastic constants than the preset of its name has that name alone.
    """
    if material is None:
        return "rigid"
    for preset, label in _LABELS.items():
        if preset.name == material.name and preset == preset.with_numbers(material.young, material.poisson):
            return label
    return material.name or unnamed


_ALIASES = {
    "uhmwpe": ("pe-uhmw", "conventional-pe", "conventional-uhmwpe", "conventional-polyethylene"),
    "crosslinked-pe": (
        *("xlpe", "hxlpe", "xpe", "hxpe", "hxl", "x-uhmwpe", "xl-uhmwpe", "crosslinked-uhmwpe"),
        *("crosslinked-polyethylene", "highly-crosslinked-pe", "highly-crosslinked-uhmwpe"),
        "highly-crosslinked-polyethylene",
    ),
    "ptfe": ("teflon", "polytetrafluoroethylene"),
    "peek": ("polyetheretherketone", "peek-optima"),
    "pom": ("acetal", "polyacetal", "polyoxymethylene", "pom-c", "acetal-copolymer"),
    "steel": ("steel-head",),
    "structural-steel": ("mild-steel", "s235"),
    "cocr": (
        *("cocrmo", "cobalt-chromium", "cobalt-chrome", "cobalt-chromium-molybdenum", "co28cr6mo", "vitallium"),
        "cobalt-chrome-molybdenum",
    ),
    "alumina": ("al2o3", "aluminium-oxide", "aluminum-oxide"),
    "alumina-composite": ("zta", "zirconia-toughened-alumina", "alumina-matrix-composite", "biolox-delta"),
    "titanium": ("ti6al4v", "ti-6al-4v-eli", "tial6v4", "ti64", "titanium-alloy"),
    "bone-cement": ("pmma", "cement"),
    "cortical-bone": ("compact-bone",),
    "cancellous-bone": ("trabecular-bone", "spongy-bone"),
}
"""Further names of each preset, by its key."""

_AMBIGUOUS = {
    ("pe", "polyethylene"): ("uhmwpe", "crosslinked-pe"),
    ("ceramic", "biolox"): ("alumina", "alumina-composite"),
    ("bone",): ("cortical-bone", "cancellous-bone"),
}
"""Names that leave several presets open, and these presets."""

_WITHOUT_DATA = {
    "carbon-fibre PEEK": ("cfr-peek", "cf-peek"),
    "zirconia": ("zirconia", "zro2", "y-tzp", "zirconium-oxide"),
    "alumina-toughened zirconia": ("atz", "alumina-toughened-zirconia"),
    "oxidised zirconium": ("oxinium", "oxidised-zirconium", "oxidized-zirconium"),
    "silicon nitride": ("silicon-nitride", "si3n4"),
    "stainless steel": ("stainless-steel", "316l", "orthinox"),
    "vitamin E polyethylene": ("vepe", "vexlpe", "vitamin-e-pe", "vitamin-e-polyethylene"),
    "POM homopolymer": ("delrin", "pom-h", "acetal-homopolymer"),
    "polycarbonate urethane": ("pcu", "polycarbonate-urethane"),
    "tantalum": ("tantalum",),
}
"""Names of materials without a preset, by their plain name."""

_FAR, _SHORT = 2, 6
"""Largest number of typing errors of a suggestion; shorter names allow only one."""


def _compact(name: str) -> str:
    """Return a name in lower case without hyphens, blanks and other signs."""
    return "".join(character for character in name.lower() if character.isalnum())


MATERIAL_ALIASES = MappingProxyType({alias: key for key, aliases in _ALIASES.items() for alias in aliases})
"""Preset of each further name of a material."""

_PRESET_OF = {_compact(name): key for name, key in {**{key: key for key in _MATERIALS}, **MATERIAL_ALIASES}.items()}
_REFUSED = {
    **{
        _compact(name): f"may be {' or '.join(map(repr, keys))}: use one of these names"
        for names, keys in _AMBIGUOUS.items()
        for name in names
    },
    **{
        _compact(name): f"({title}) has no preset, because no numbers with a source are known here: "
        "give young and poisson from its data sheet"
        for title, names in _WITHOUT_DATA.items()
        for name in names
    },
}
_FAMILY = {
    **_PRESET_OF,
    **{_compact(name): names[0] for names in (*_AMBIGUOUS, *_WITHOUT_DATA.values()) for name in names},
}
"""Family of each compact name: a preset, or the first name of a material without a preset."""


def find_material(name: str) -> str | None:
    """Return the key of a preset by its name or a further one, such as "xlpe"; None for any other name."""
    return _PRESET_OF.get(_compact(name))


def material_hint(name: str) -> str:
    """Return the end of a sentence on a name that is no preset: the reason, or a suggestion of the same family.

    A suggestion is made only if all similar names are of one family, because another material is a wrong answer.
    """
    compact = _compact(name)
    if compact in _REFUSED:
        return f" {_REFUSED[compact]}"
    errors = {known_name: _typing_errors(compact, known_name) for known_name in _FAMILY}
    for limit, clear in ((1, 1), (_FAR, _FAR + 1)):
        similar = {_FAMILY[known_name] for known_name, count in errors.items() if count <= limit}
        possible = {_FAMILY[known_name] for known_name, count in errors.items() if count <= clear}
        if similar and (limit == 1 or len(compact) >= _SHORT):
            return f" is not known; did you mean {similar.pop()!r}?" if len(possible) == 1 else _unknown_material()
    return _unknown_material()


def _unknown_material() -> str:
    return f" is not known; known: {', '.join(_MATERIALS)}"


def _typing_errors(text: str, target: str) -> int:
    """Count the fewest insertions, deletions, replacements and exchanges of neighbours between two texts."""
    if abs(len(text) - len(target)) > _FAR + 1:
        return _FAR + 2
    before: list[int] = []
    row = list(range(len(target) + 1))
    for i, letter in enumerate(text):
        last, before, row = before, row, [i + 1]
        for j, character in enumerate(target):
            row.append(min(before[j + 1] + 1, row[j] + 1, before[j] + (letter != character)))
            if i and j and letter == target[j - 1] and text[i - 1] == character:
                row[-1] = min(row[-1], last[j - 1] + 1)
    return row[-1]


class _Materials(NamedItems[Material]):
    """Preset materials by name; further names such as "xlpe" find them too."""

    def __missing__(self, name: Any) -> Material:
        """Return the material of a further name; raise KeyError with a suggestion of the same family."""
        key = find_material(name) if isinstance(name, str) else None
        if key is None:
            raise KeyError(f"material {shown(name)}{material_hint(name if isinstance(name, str) else '')}")
        return self[key]


materials: dict[str, Material] = _Materials("material", _MATERIALS)
"""Materials by the name in files and on the command line: the name of the constant in lower case with hyphens."""


_JOINTS = (
    ("hess-forsbach", 17.9, 0.1, 6.75, STEEL, UHMWPE, "Heß & Forsbach 2021, Figs. 3 and 4"),
    ("hip-22", 11.0, 0.1, 5.0, COCR, UHMWPE, _PLANK),
    ("hip-28", 14.0, 0.1, 5.0, COCR, UHMWPE, _PLANK),
    ("hip-32", 16.0, 0.1, 6.0, ALUMINA, CROSSLINKED_PE, _TABLE_1),
    ("hip-36", 18.0, 0.1, 5.0, ALUMINA, CROSSLINKED_PE, _TABLE_1),
    ("reverse-shoulder-36", 18.0, 0.1, 6.0, COCR, UHMWPE, _GLENOSPHERE),
    ("reverse-shoulder-42", 21.0, 0.1, 6.0, COCR, UHMWPE, _GLENOSPHERE),
    ("suspension-ball-joint", 13.5, 0.02, 2.5, STRUCTURAL_STEEL, POM, _BALL_JOINT),
    ("spherical-bearing", 500.0, 0.05, 5.0, STRUCTURAL_STEEL, PTFE, _BRIDGE_BEARING),
    ("tilting-pad-pivot", 12.5, 0.05, inf, STRUCTURAL_STEEL, STRUCTURAL_STEEL, _PIVOT),
)
"""Name, ball radius, clearance and liner thickness in mm, materials of ball and liner, and source of each joint."""

joints: dict[str, Joint] = NamedItems(
    "joint",
    {
        name: Joint(
            ball_radius=radius,
            clearance=clearance,
            liner_thickness=thickness,
            liner=liner,
            ball=ball,
            name=name,
            source=source,
        )
        for name, radius, clearance, thickness, ball, liner, source in _JOINTS
    },
)
"""Joints by name: common hips, reverse shoulders, a suspension ball joint, a bridge bearing and a tilting-pad pivot."""


def named_material(name: str, chosen: Any) -> Material:
    """Return a preset material by its name or a further one; `name` is that of the body in messages.

    Raises ValueError: a name that is not known, or several names.
    """
    if isinstance(chosen, str) and "," in chosen:
        raise ValueError(f"{name} material {shown(chosen)} are several, and one is needed: optimise and studies choose")
    key = find_material(check_text(f"{name}.material", chosen))
    if key is None:
        raise ValueError(f"{name} material {shown(chosen)}{material_hint(chosen)}")
    return materials[key]
