"""Names of materials: further names of presets, materials without data, and suggestions within a family."""

import string

import pytest

import ballsocket as bs
from ballsocket.problem import presets
from ballsocket.problem.presets import MATERIAL_ALIASES, find_material, material_hint, named_material


@pytest.mark.parametrize(
    ("name", "material"),
    [
        ("HXLPE", bs.CROSSLINKED_PE),
        ("xlpe", bs.CROSSLINKED_PE),
        ("Highly cross-linked polyethylene", bs.CROSSLINKED_PE),
        ("CoCrMo", bs.COCR),
        ("Ti-6Al-4V", bs.TITANIUM),
        ("Ti6Al4V", bs.TITANIUM),
        ("ZTA", bs.ALUMINA_COMPOSITE),
        ("cross-linked PE", bs.CROSSLINKED_PE),
        ("Bone_Cement", bs.BONE_CEMENT),
    ],
)
def test_further_names_find_the_preset(name, material):
    assert named_material("liner", name) is bs.materials[name] is material


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("PEEK", r"liner material 'PEEK' \(PEEK\) has no preset, .* give young and poisson from its data sheet$"),
        ("zirconia", "has no preset, because no numbers with a source are known here"),
        ("polyethylene", "may be 'uhmwpe' or 'crosslinked-pe': use one of these names"),
        ("wood", "is not known; known: uhmwpe, crosslinked-pe"),
        ("hxlp", "is not known; did you mean 'crosslinked-pe'"),
    ],
)
def test_other_names_are_refused_with_a_reason(name, message):
    with pytest.raises(ValueError, match=message):
        named_material("liner", name)
    with pytest.raises(KeyError):
        bs.materials[name]


def with_one_error(name):
    """Return all texts with one letter left out, added, replaced or exchanged with its neighbour."""
    cuts = [(name[:i], name[i:]) for i in range(len(name) + 1)]
    letters = string.ascii_lowercase + string.digits
    texts = {a + letter + b[skip:] for a, b in cuts for letter in letters for skip in (0, 1)}
    texts |= {a + b[1:] for a, b in cuts} | {a + b[1] + b[0] + b[2:] for a, b in cuts if len(b) > 1}
    return texts - set(presets._FAMILY)


def test_a_suggestion_never_names_another_family():
    suggested = 0
    names = sorted(presets._FAMILY)
    for name in names[:: len(names) // 2]:  # `test_a_suggestion_of_any_name` takes all
        suggested += check_suggestions(name)
    assert suggested > 300


def check_suggestions(name):
    """Check the suggestions for a name with one typing error; return their number."""
    hints = [hint for hint in map(material_hint, with_one_error(name)) if "did you mean" in hint]
    wrong = [hint for hint in hints if repr(presets._FAMILY[name]) not in hint]
    assert wrong == []
    return len(hints)


@pytest.mark.long
def test_a_suggestion_of_any_name_is_of_its_family():
    for name in sorted(presets._FAMILY)[::16]:  # all of them take minutes
        check_suggestions(name)


def test_each_name_has_one_family():
    compact = [presets._compact(name) for name in (*bs.materials, *MATERIAL_ALIASES)]
    assert len(set(compact)) == len(compact)
    assert {find_material(name) for name in MATERIAL_ALIASES} == set(bs.materials)
    assert not set(presets._REFUSED) & set(presets._PRESET_OF)
