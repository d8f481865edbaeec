"""Wrong input at the terminal: one line that names the mistake and the remedy, and exit status 2."""

import shlex

import pytest

from ..places import EXAMPLES
from .command import refusal

ABBREVIATIONS = {
    "{wear_test}": shlex.quote(str(EXAMPLES / "wear_test.toml")),
    "{hip}": shlex.quote(str(EXAMPLES / "hip.toml")),
    "{hip-36}": "hip-36 --force 3kN",
    "{sizes}": "--ball-radius 16 --clearance 0.1 --liner-thickness 6",
    "{export}": "--out a hip-28",
    "{fmu}": "fmu hip-28 --out a.fmu",
    "{rod}": "--ball-radius 13.5 --interference 0.03 --liner-thickness 2.5 --liner pom",
    "{numbers}": "{sizes} --young 1GPa --poisson 0.4 --force 3kN",
    "{spread}": "{hip-36} --spread clearance=0.1+-0.05 --spread liner_young=700..1100",
}

REFUSED = """
press => a joint is needed: a file, a preset's name, or --ball-radius
press file => file is empty: a joint file has tables, such as [joint]
study file => file is empty: a study file has tables, such as [joint]
press nothing.toml => 'nothing.toml' is neither a file nor a preset
press hip-29 --force 1 => did you mean 'hip-
press hip-28 => a load is needed: --force, --indentation or --half-angle
press {hip} --force '3 kg' => force = '3 kg' is not a force, such as '3 kN'; a mass of 3 kg weighs 29.42 N
press {hip} --force '3,000 N' => not a force, such as '3 kN'; write a decimal point, and nothing between thousands
press {hip} --force '200 %BW' => not a force, such as '3 kN'; 2 times the weight of 75 kg is 1471 N
press /proc/self/mem => /proc/self/mem
curve {hip} --points x => --points
fmu {hip} --out a.fmu --fmi 2.5 => --fmi
fmu {hip} --out a.fmu --restitution 0.5 --impact-speed x => impact_speed = 'x' is not a speed, such as '0.1 m/s'
map {hip} --limit 'max_pressure<=12 N' => max_pressure = '12 N' is not a pressure, stress or modulus, such as '12 MPa'
press {hip} --force -3 => force = '-3' is not allowed: a force (N) is 0 or more and finite
press {hip} --force 1 --indentation 1 => one load is needed, got force, indentation
press {numbers} --clearance=-100um => clearance = '-100um' is not allowed: a radial clearance (mm) is
press {numbers} --ball-young=-1GPa --ball-poisson=0 => ball.young = '-1GPa' is not allowed
press '' --force 1 => the joint's name is empty
press {hip} --model herz => model 'herz' is not known; did you mean 'hertz'?
press {hip} --figure a.jpg => figure 'a.jpg' must end in .png, .svg, .pdf
press no/joint.toml => 'no/joint.toml' does not exist: there is no folder 'no'
map {hip} --figure no/a.png => cannot write a.png: 'no' is not a folder
study {hip} --out no/a.csv => cannot write a.csv: 'no' is not a folder
press {hip} --model fem --vtk no/a.vtu => cannot write a.vtu: 'no' is not a folder
map {hip} --points 1 => points = 1 is not allowed: an axis has 2 values or more
map {hip} --limit area=3 => 'area=3' is not a limit: it needs <= or >=, such as 'outer_radius<=26
press {hip} --liner uhmpe => liner material 'uhmpe' is not known; did you mean 'uhmwpe'?
press {hip} --ball-radius 9 --head-diameter 18 => ball_radius and head_diameter are one too
press hip-36 --head-diameter 36 --outer-diameter 30 => outer_diameter = '30' is not allowed: it must leave a liner
press hip-36 --outer-diameter 48 => add the one that stays, ball_radius = 18 mm or liner_thickness = 5 mm
press . --force 1 => is a folder; a joint file is needed
press --ball-radius 16 --clearance 0.1 --young 1GPa --poisson 0.4 --force 3kN => liner_thickness is missing
press {sizes} --force 1 => the liner needs a material, or young and poisson
press {sizes} --young 1GPa --poisson 0.5 --force 1 --model bonded-layer => bonded-layer has no answer for ν = 0.5
evidence => a question file is needed, or --check with the folder of a pack
evidence --check . => holds no pack of evidence: checksums.txt is missing
press {hip} --units inch => 'si', 'imperial'
press 'C:\\Users\\me\\hip.toml' => ballsocket: 'C:\\Users\\me\\hip.toml'
pres => No such command 'pres'.
study => file is missing: Study file
optimise {hip} => --vary is missing: --vary 'clearance=50..200 um', for example
study {hip} => this is a joint file: ballsocket press
press {wear_test} --force 1 => this is a wear test file: ballsocket identify wear_test.toml
press {hip} --model fem --meshes 0 => --meshes
--foo => No such option: --foo; ballsocket -h lists them
press --qqq => No such option: --qqq; ballsocket press -h lists them
press {hip-36} --clearence 0.1 => No such option: --clearence (Possible options: --clearance
press {hip-36} --friction much => --friction
press {hip-36} --liner uhmwpe,pom => 'uhmwpe,pom' are several, and one is needed: optimise and studies choose
optimise {hip-36} --vary clearance=0..1 --vary liner=uhmwpe,pom --figure a.png => two axes, and 1 numbers vary
build-tables --out no/a.npz => no/a.npz: No such file or directory
schema hipp => kind of file 'hipp' is not known; did you mean 'hip'?
models hess => model 'hess' is not known; did you mean 'hess-forsbach'?
cite herz => model, material or joint 'herz' is not known; did you mean 'hertz'?
cite titanium => no known publication is named in the source of titanium

map hip-36 => a load is needed
map {hip-36} --x 'ball_radius=23..11 mm' --figure map.gif => must end in
map {hip-36} --x 'force=1..4 kN' => force varies, and a load is given too
optimise {hip-36} --vary 'ball_radius=23..11 mm' => a range goes upwards
optimise {hip-36} --vary clearance=0.05..0.1 --vary clearance=0.1..0.2 => clearance is given twice
optimise {hip-36} --vary liner=pon,UHMWPE => liner material 'pon' is not known; did you mean 'pom'?
sensitivity {hip-36} --spread clearance=much => is not a tolerance or range, such as 'clearance=0.1+-0.02 mm'
sensitivity {hip-36} --spread liner.poisson=0.4+-0.05 => 'liner.poisson' among what can scatter is not known
press {hip-36} --report hip.html --tolerance force=3+-1 --tolerance force=2+-1 => force is given twice
sensitivity {spread} --correlation clearance=0.5 => 'clearance=0.5' is not a correlation
sensitivity {spread} --correlation 'clearance, force = 0.5' => 'force' among the correlated parameters is not
sensitivity {spread} --of pressure => 'pressure' among the quantities is not known
sensitivity {spread} --csv all.txt => 'all.txt' must end in .csv
sensitivity {spread} --seed -1 => seed = -1 is not allowed
calibrate hip-28 --form polynomal => did you mean 'polynomial'?
deck {hip-36} --tilt 45 --out a => give an indentation

press {hip-36} --tolerance 'clearance=0.1+-0.03 mm' => is for the report: add --report
press {hip-36} --report hip.doc => must end in .html or .pdf
press {hip-36} --report hip.html --tolerance clearance=0.2+-0.05 => outside its tolerance of 0.15 to 0.25 mm: change
press {hip-36} --report hip.html --tolerance 'clearence=0.1+-0.03 mm' => did you mean 'clearance'?
press {hip-36} --report hip.html --tolerance 'inclination=40+-5 deg' => inclination cannot vary for
press hip-36 {hip-36} --figure hip.png => --figure shows one joint, got 2
press {hip-36} --report nowhere/hip.html => nowhere

press {hip} --model exact --gap round => gap 'round' is not known; known: linear, circular
orient {hip} --points 2 --gap round => gap 'round' is not known; known: linear, circular
curve {hip} --model hertz --gap linear => hertz has no choice of the gap; models with one: exact, fem, sphere

press {hip} --element-size '1 mm' => --element-size is for the finite elements: add --model fem
press {hip} --plastic --half-angle '40 deg' => a yielding liner is pressed by force or indentation
map {hip} --force 1kN --limit collapse_load>=1kN => collapse_load needs finite elements whose liner yields
curve {hip} --force 1kN --both-signs --model hertz => hertz presses towards the dome only: for --both-signs use sphere
curve {hip} --force 1kN --plastic --model exact => exact has no liner that yields: use fem
press {hip} --plastic --hardening 20 => hardening = '20' must be points 'stress:plastic strain'
press {hip} --model fem --interface glued => interface = 'glued' is not allowed: 'bonded' or 'sliding'
press {hip} --model fem --element triangle => element = 'triangle' is not known
press {hip} --model fem --element-size '9 mm' => liner_thickness = 6.75 is not allowed: a layer must have
press {hip} --model fem --element-size '0.0005 mm' => GiB of memory
press {hip} --model fem --vtk a.txt => 'a.txt' must end in .vtu, .vtk

deck {hip} --out a --steps 0 => --steps
deck {hip} --out a --steps 1000000 => --steps
deck {hip} --out a --scale 7 => scale = 7 is not allowed
deck {hip} --out a --force 0 => need a contact under load

film {hip} --viscosity '-1 mPa s' => a viscosity (Pa s) is positive and finite
film {hip} --spin inf => a rotation rate (rad/s) is finite
film {hip} --spin '3 mm' => is not a rotation rate
film {hip} --spin-axis 1,2 => spin_axis = '1,2' must be three numbers 'x,y,z'
film {hip} --spin-axis 0,0,0 => length of spin_axis = 0 is not allowed: a direction points somewhere
film {hip} --method magic => method = 'magic' is not known; known: inlet, wave, reynolds
film {hip} --interference '0.02 mm' --model sphere --ring-width 6 => interference = 0.02 mm is not allowed
film {hip} --model refined --method reynolds => is not possible for refined: it needs a contact on springs

press {hip-36} --tilt '200 deg' => tilt = 200 is not allowed: a tilt is 0 to 180 degrees
press {hip-36} --direction 1,0 => direction = '1,0' must be three numbers 'x,y,z'
press {hip-36} --direction 0,0,0 => points somewhere
press {hip-36} --tilt 10 --direction 0,0,1 => either a tilt or a direction is needed, got both
press {hip-36} --tilt 10 --model fem => from the cup's axis: use sphere
press {hip-36} --tilt 10 --ring-width '20 deg' => 0.5 to 6 degrees
press {hip-36} --ring-width '2 deg' => --ring-width is for contact on the sphere: add --model sphere

press {hip-36} --vtk a.vtu => --vtk is for the finite elements: add --model fem, or sphere
press {hip-36} --section a.png => --section is for the finite elements
press {hip-36} --view a.png => --view is for contacts off the axis: add --model sphere
press {hip-36} --view a.svg --tilt 20 => must end in .png

orient {hip-36} --points 2 --inclination '30 to 60' => inclination = '30 to 60' is not an angle, such as '40 deg'
orient {hip-36} --points 2 --step 5 => --step and --points are one too many: either fixes the other
orient {hip-36} --points 2 --limit 'area<=3' => --limit of area is not possible here; possible:
orient {hip-36} --points 2 --inclination 30..100 => inclination is 0 to 90 degrees

press suspension-ball-joint --interference 0.03 --force 9 --pull-out => needs the arc of cover: set arc_of_cover
press hip-28 --force 9 --pull-out --model exact => a pull-out force is solved by the model sphere
press hip-28 --force 9 --pull-out --ring-width 6 => a socket of 180 deg does not hold its ball
press hip-28 --force 9 --static-friction 0.1 => --static-friction needs the coefficient of sliding
press hip-28 --force 9 --friction 0.2 --static-friction 0.1 => static_coefficient = 0.1
press hip-28 --force 9 --friction -1 => coefficient = -1 is not allowed

export ansys {export} => target 'ansys' is not known; known: c, opensim, mujoco, drake, exudyn, adams, simpack, modelica
export table hip-28 --out file => 'file' is a file; a folder is needed
export table hip-28 --out file/new/hip => 'file' is a file; a folder is needed
export table {export} --model fem => finite elements are too noisy for a law
export c {rod} --arc-of-cover 180 --out a => above 180 deg
fmu hip-28 --out hip.zip => out 'hip.zip' must end in .fmu
fmu hip-28 --out no/hip.fmu => cannot write hip.fmu: 'no' is not a folder
fmu {rod} --model exact --out a.fmu => the model exact does not solve a preloaded joint: use sphere
{fmu} --fmi 4 => FMI version = 4 is not allowed: 2 or 3
{fmu} --hysteresis -1 => hysteresis = -1 is not allowed: damping must be at least 0
{fmu} --restitution 0.5 => a restitution and the speed of its impact belong together
{fmu} --viscosity '2.5 mm' => viscosity = '2.5 mm' is not a viscosity, such as '2.5 mPa s'
{fmu} --roughness '1 um' => add --viscosity
{fmu} --bristle-stiffness 100 => add --friction
{fmu} --ball-mass 0 => ball_mass = 0 is not allowed: a mass (kg) must be above 0
fmu {rod} --friction 0.1 --bristle-stiffness 100 --out a.fmu => a preloaded joint has no bristles
export drake hip-28 --friction 0.1 --bristle-stiffness 100 --out a => bristles have a state, which drake cannot
"""
"""Commands, and words of the message after the arrow."""


@pytest.mark.parametrize("case", [line for line in REFUSED.splitlines() if line])
def test_wrong_input_is_refused_in_one_line_with_the_remedy(case, tmp_path):
    (tmp_path / "file").touch()
    command, _, message = case.partition(" => ")
    for short, long in reversed(ABBREVIATIONS.items()):
        command = command.replace(short, long)
    assert message in refusal(*shlex.split(command), folder=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
