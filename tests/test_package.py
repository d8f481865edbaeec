"""Package as users install it: light imports, running examples, README and citations."""

import re
import runpy

import pytest

import ballsocket as bs
from ballsocket.core.quantities import CONTACT
from ballsocket.core.sources import bibliography
from ballsocket.dynamics import Bristles, Motion, Viscoelastic, relations
from ballsocket.model_catalogue import JUDGE, OFF_AXIS, listed_models
from ballsocket.paper.claims import table

from .cli.command import run
from .joints import HIP
from .places import ROOT, fenced
from .printed import with_numbers_of


def test_names_that_the_package_or_its_studies_do_not_have_suggest_similar_ones():
    from ballsocket.reports import study_plots

    assert bs.studies.design_map is study_plots.design_map
    with pytest.raises(AttributeError, match="has no attribute 'optimize'; did you mean 'optimise'?"):
        bs.studies.optimize  # noqa: B018

    with pytest.raises(AttributeError, match=r"no attribute 'press'; .* bs\.Exact\(\)\.press.*; bs\.compare"):
        bs.press  # noqa: B018


def test_every_named_material_is_a_constant():
    for name, material in bs.materials.items():
        assert getattr(bs, name.replace("-", "_").upper()) is material


def test_an_example_runs_as_a_script(monkeypatch, tmp_path):
    """The gallery of the documentation runs all of them, and its build fails where one fails."""
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(ROOT / "examples" / "which_head_for_a_shell.py"), run_name="__main__")


def test_the_readme_shows_the_output_of_its_command():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = fenced(ROOT / "README.md", "text")[0]
    command = re.search(r"^pip install .* && ballsocket (press .*)$", text, flags=re.MULTILINE).group(1)
    printed = "\n".join(line.rstrip() for line in run(*command.split(), folder=ROOT).stdout.splitlines())
    assert with_numbers_of(shown, printed).splitlines() == shown.splitlines()


def test_the_page_on_choosing_and_the_catalogue_list_the_same_models():
    text = (ROOT / "docs" / "explanation" / "choosing.md").read_text(encoding="utf-8")
    _, models = re.split(r"^## All models$", text, flags=re.MULTILINE)
    listed = re.findall(r"^\| `([\w-]+)` \|", models, flags=re.MULTILINE)
    assert set(listed) == {*bs.catalogue, "PinInHole", JUDGE, OFF_AXIS}
    assert [model.name for model in listed_models.values()] == [*listed_models]


UNSOURCED = {"titanium", "peek", "bone-cement", "cortical-bone", "cancellous-bone"}  # representative, and say so
CITABLE = [*(bs.materials[name] for name in sorted(set(bs.materials) - UNSOURCED)), *bs.joints.values()]


def keys(*used):
    return re.findall(r"^@\w+\{(\w+),$", bs.cite(*used), flags=re.MULTILINE)


def test_citations_are_those_of_the_cited_objects():
    cited = keys(bs.Bartel().press(HIP, force=1.0), bs.hess_forsbach, bs.PinInHole())
    assert len(set(cited)) == len(cited)
    assert {"bartel1985", "hess2021", "persson1964", "ciavarella2001"} <= {*cited} <= {*bibliography()} - {"hertz1882"}
    answers = bs.compare(HIP, force=3000.0)
    assert {source.key for source in answers.sources} == {s.key for m in bs.catalogue.values() for s in m.sources}
    assert {"hertz1882", "steuermann1939", "ciavarella2018", "bartel1985"} <= set(keys(answers))
    assert "steuermann1939" not in keys(bs.compare(HIP, force=3000.0, models={"hertz": bs.Hertz()}))


def test_every_source_is_in_the_bibliography_and_every_publication_is_cited():
    for model in (*bs.catalogue.values(), bs.PinInHole()):
        for source in model.sources:
            assert source.key in bibliography()
            assert source.authors_and_year
            assert "\\" not in str(source)
    unused = set(bibliography()) - set(keys(*listed_models.values(), *CITABLE))
    unused -= {source.key for source in table.SOURCES}
    unused -= {source.key for used in (*relations.relations, Bristles, Motion, Viscoelastic) for source in used.sources}
    assert unused == set()


def test_presets_cite_the_publications_their_source_names():
    for preset in CITABLE:
        assert keys(preset)
    assert keys(bs.ALUMINA) == ["nistsrd150", "kutz2009"]
    assert set(keys(bs.joints["hip-28"])) == {"plank2007", "hess2021", "dipuccio2015", "bergstrom2010"}
    named = bs.Material(young=1.0, poisson=0.3, source="Smith & Johnson 1985; Hertz 18820; Kirk & Reedy 1988, p. 3")
    assert keys(named) == ["kirk1988"]


@pytest.mark.parametrize("thing", ["hertz", None, [], bs.Hertz, bs.Joint])
def test_objects_that_cannot_be_cited_are_refused(thing):
    with pytest.raises(TypeError, match="models, contacts, comparisons, materials and joints can be cited, not "):
        bs.cite(bs.Hertz(), thing)


def test_a_source_without_a_publication_is_refused_alone_and_skipped_in_a_contact():
    own = bs.Material(young=1000.0, poisson=0.4, source="our lab")
    hip = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=own)
    for thing in (own, hip):
        with pytest.raises(TypeError, match="no known publication is named in the source of"):
            bs.cite(thing)
    assert keys(bs.Hertz().press(hip, force=1.0)) == ["hertz1882", "hess2021"]


def test_all_summaries_have_one_list_of_columns():
    names = [*(quantity.key for quantity in CONTACT.values()), "utilisation", "pressure_ratio", "utilisation_note"]
    assert list(bs.Hertz().press(HIP, force=1.0).summary())[1:-2] == names
    nothing = bs.compare(bs.joints["tilting-pad-pivot"], force=1.0, models={"bonded-layer": bs.BondedLayer()})
    assert list(nothing.summary()["results"][0])[1:-3] == names


@pytest.mark.parametrize(
    ("shown", "printed", "equal"),
    [
        ("pmax 11.17 MPa", "pmax 11.18 MPa", True),
        ("pmax 11.17 MPa", "pmax 11.19 MPa", False),
        ("array([1.5e-03])", "array([1.6e-03])", True),
        ("3 cells, K 276.7", "4 cells, K 276.7", False),
        ("K 276.7 N", "K 276.7 kN", False),
    ],
)
def test_printed_numbers_are_compared_to_one_unit_of_their_last_digit(shown, printed, equal):
    assert (with_numbers_of(shown, printed) == shown) is equal
