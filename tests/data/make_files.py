"""Write `files_of_1_0.json`: texts of input files with the numbers that version 1.0 reads from each, or its refusal.

The data were written by this file and `tests/files/read_files.py` with version 1.0 of the package on the path:

    PYTHONPATH=path/of/1.0/src:tests/files python tests/data/make_files.py

The files are drawn with a fixed seed: complete files of each kind, and the same files with one fault.
"""

import json
import random
from pathlib import Path

from read_files import outcome

draw = random.Random(20261123)
SIZES = {"mm": 1.0, "cm": 10.0, "m": 1e3, "um": 1e-3, "inch": 25.4}


def length(mm):
    """Write a length (mm) as a number or with a unit."""
    unit = draw.choice(("", "", *SIZES))
    return f'"{mm / SIZES[unit]:.9g} {unit}"' if unit else f"{mm:.6g}"


def modulus(mpa):
    return draw.choice((f"{mpa:g}", f'"{mpa:g} MPa"', f'"{mpa / 1e3:g} GPa"', f'"{mpa:g} N/mm^2"'))


def angle(degrees):
    return draw.choice((f"{degrees:g}", f'"{degrees:g} deg"', f'"{degrees:g}°"'))


def maybe(line, share=0.5):
    return [line] if draw.random() < share else []


def material(table, keep=1.0):
    lines = [f"[{table}]"]
    if draw.random() < 0.4:
        preset = draw.choice(("uhmwpe", "UHMWPE", "steel", "cocr", "titanium", "pom"))
        lines += [f'material = "{preset}"', *maybe(f"young = {modulus(draw.choice((700, 900, 1500)))}", 0.3)]
    else:
        lines += [f"young = {modulus(draw.choice((500, 1000, 2800)))}", f"poisson = {draw.choice((0.3, 0.4, 0.45))}"]
    lines += maybe(f"yield_stress = {modulus(draw.choice((15, 21, 60)))}", 0.3)
    lines += maybe(f"allowable_pressure = {modulus(draw.choice((10, 25)))}", 0.3)
    lines += maybe(f"fatigue_limit = {modulus(8)}", 0.15)
    return lines


def joint_tables(load=True):
    radius, clearance = draw.choice((11.0, 14.0, 16.0, 18.0, 25.0)), draw.choice((0.03, 0.1, 0.25))
    thickness = draw.choice((3.0, 6.0, 10.5))
    pairs = (
        [f"ball_radius = {length(radius)}", f"clearance = {length(clearance)}"],
        [f"head_diameter = {length(2 * radius)}", f"diametral_clearance = {length(2 * clearance)}"],
        [f"socket_radius = {length(radius + clearance)}", f"clearance = {length(clearance)}"],
        [f"ball_radius = {length(radius)}", f"socket_radius = {length(radius + clearance)}"],
    )
    lines = ["[joint]", *pairs[draw.randrange(4)]]
    layers = draw.randrange(3) if draw.random() < 0.3 else 0
    if layers or draw.random() < 0.6:
        lines += [f"liner_thickness = {length(thickness)}"]
    else:
        lines += [f"outer_radius = {length(radius + clearance + thickness)}"]
    if layers:
        lines += maybe('support = "free"', 0.4)
    lines += material("liner")
    lines += material("ball") if draw.random() < 0.5 else []
    for _layer in range(layers):
        lines += ["[[backing]]", f"thickness = {length(draw.choice((2.0, 4.0)))}"]
        lines += [draw.choice(('material = "titanium"', "young = 500\npoisson = 0.3"))]
    if draw.random() < 0.4:
        lines += ["[cup]", *maybe(f"arc_of_cover = {angle(draw.choice((150, 165, 180)))}")]
        inclination = f"inclination = {angle(draw.choice((40, 45, 50)))}"
        lines += maybe(f"{inclination}\nanteversion = {angle(draw.choice((10, 20)))}")
        lines += maybe(f'interface = "{draw.choice(("bonded", "sliding", "Bonded"))}"', 0.3)
        lines += maybe(f'side = "{draw.choice(("left", "right"))}"', 0.3) + maybe(f"chamfer = {length(0.5)}", 0.3)
    if load and draw.random() < 0.8:
        lines += ["[load]"]
        force = draw.choice(("2500", '"2500 N"', '"2.5 kN"'))
        lines += [draw.choice((f"force = {force}", f"indentation = {length(0.05)}", f"half_angle = {angle(30)}"))]
        lines += maybe(draw.choice((f"tilt = {angle(20)}", 'direction = "0, 0.2, 1"', "direction = [0, 0.2, 1]")), 0.2)
    return lines


def joint_file():
    names = [*maybe('name = "drawn joint"', 0.4), *maybe('source = "assumed"', 0.2)]
    return "\n".join([*names, *joint_tables()])


def named_joint():
    return [f'joint = "{draw.choice(("hip-28", "hip-32", "hip-36", "HIP 28", "joint.toml"))}"']


LAWS = (
    'law = "archard"\ncoefficient = "1.066e-6 mm^3/(N m)"',
    'law = "archard"\ncoefficient = 1e-6',
    'law = "energy"\ncoefficient = "1e-5 mm^3/J"\nfriction = 0.05',
    'law = "area"\ncoefficient = "2e-10"',
    'law = "cross-shear"\ncoefficient = 1e-6\ncircular = 2e-6',
    'coefficient = "8e-7 mm³/(N·m)"',
)
CYCLES = (
    'name = "iso-14242-1"',
    'name = "iso-14242-1"\ninstants = 40\nrotation_order = "flexion, adduction, rotation"',
    'name = "iso-14242-3"',
    'name = "walking"\nbody_weight = "800 N"',
    'name = "stairs-up"\nbody_weight = 750\ntimes_body_weight = 2.4',
    'file = "cycle.csv"\ninstants = 24',
    'file = "cycle.csv"\nside = "left"\nframe = "body"\nforce_on = "socket"\nclosing = 0.02',
    'file = "force.csv"\nmotion = "iso-14242-1"',
)


def hip_file():
    lines, tables = maybe('name = "hip"', 0.4), []
    if draw.random() < 0.25:
        lines += ['body_weight = "800 N"', "cycles_per_year = 1.2e6"]
        lines += maybe("years = 5\nreport_years = [1, 5]", 0.7)
        tables += ["[[activity]]", 'name = "walking"', "share = 0.9", "instants = 20"]
        tables += ["[[activity]]", 'name = "stairs-up"', draw.choice(("share = 0.1", "per_year = 1e5"))]
    else:
        lines += [*maybe("cycles = 2e6"), *maybe("report_at = [1e6, 1.5e6]", 0.3)]
        tables += ["[cycle]", draw.choice(CYCLES)]
    body = []
    if draw.random() < 0.5:
        lines += named_joint()
    else:
        body = joint_tables(load=False)
    if "[cup]" not in body:
        body += maybe(f"[cup]\ntilt = {angle(draw.choice((20, 30)))}", 0.4)
    tables += ["[wear]", draw.choice(LAWS), *maybe(f"ring_width = {angle(draw.choice((3, 5)))}", 0.4)]
    models = ('contact = "springs"', 'model = "bartel"', 'contact = "springs"\nmodel = "hess-forsbach"')
    tables += maybe(draw.choice(models), 0.3)
    if draw.random() < 0.25:
        tables += ["[creep]", *maybe("seconds_per_cycle = 1.0", 0.4)]
        tables += maybe('law = "kelvin-voigt"\ncompliances = [1e-4, 2e-4]\ntimes = [100, 1e4]', 0.4)
    if draw.random() < 0.4:
        tables += ["[film]", *maybe("viscosity = 0.002"), *maybe(f"ball_roughness = {length(0.00002)}")]
        tables += maybe("friction = 0.06")
    if draw.random() < 0.25:
        options = [*maybe("count = 256", 0.4), *maybe("seed = 3", 0.4)]
        tables += ["[uncertainty]", *options, "clearance = { low = 0.02, high = 0.3 }"]
    return "\n".join([*lines, *body, *tables])


AXES = (
    'clearance = { from = "0.05 mm", to = "0.2 mm", count = 4 }',
    "clearance = [0.05, 0.1]",
    'liner = ["uhmwpe", "pom"]',
    'force = ["1 kN", 2000, "3 kN"]',
    "force = 1500",
    "head_diameter = [28, 32]",
    'liner_young = { from = 500, to = "1 GPa", count = 3 }',
    'half_angle = { from = "5 deg", to = 40, count = 4.0 }',
)
SAMPLES = (
    "clearance = { low = 0.05, high = 0.15 }",
    'liner_young = { mean = "1 GPa", deviation = "100 MPa" }',
    'liner_young = { median = "1 GPa", factor = 1.2 }',
    "ball_radius = { nominal = 16, plus_minus = 0.02 }",
    "liner_poisson = { mean = 0.4, deviation = 0.02, low = 0.35, high = 0.45 }",
)


def study_file():
    model = draw.choice(("hess-forsbach", "exact", "tabulated", "bartel", "Hess Forsbach", "hertz"))
    lines = maybe(f'model = "{model}"', 0.7)
    lines += maybe('quantities = ["max_pressure", "area"]', 0.4) + maybe('store = "cases"', 0.3)
    named = draw.random() < 0.6
    lines += named_joint() if named else []
    body = [] if named else joint_tables(load=False)
    parts = draw.sample(AXES, 2) if draw.random() < 0.7 else []
    body += ["[axes]", *parts] if parts else []
    if draw.random() < 0.5 or not parts:
        body += ["[samples]", "count = 8", *maybe("seed = 5"), *maybe('method = "latin-hypercube"', 0.4)]
        body += draw.sample(SAMPLES, 2)
    body += maybe('[table]\npath = "rows.csv"', 0.15)
    body += maybe("[engine]\n" + draw.choice(('kind = "serial"', 'kind = "processes"\nworkers = 2')), 0.3)
    return "\n".join([*lines, *body])


DATA = (
    'quantity = "area"\nvalues = ["50 mm^2", "90 mm^2"]\nforce = ["500 N", "1 kN"]\nuncertainty = "5 mm^2"',
    'quantity = "indentation"\nvalues = [0.02, 0.03]\nforce = [500, 1000]\nuncertainty = "2 %"\nload_uncertainty = 5',
    'file = "points.csv"\nuncertainty = "2 %"',
    'file = "points.csv"\nquantities = "indentation"\nuncertainty = 0.001\ngaps = "leave-out"\nload = "force"',
    'quantity = "diametral_clearance"\nvalues = "0.21 mm"\nuncertainty = "10 um"\nname = "play"',
    'quantity = "frequency"\nvalues = "500 Hz"\nforce = 1000\nmass = "2 kg"\nuncertainty = "5 Hz"',
    'quantity = "max_pressure"\nvalues = [8, 12]\nforce = [500, 1500]\nuncertainty = "5 %"\nsaturation = "10 MPa"',
)
FREE = (
    'clearance = "0.02..0.3 mm"',
    'liner.young = "0.4..2 GPa"',
    'liner.young = { median = "1 GPa", factor = 1.5 }',
    "liner_poisson = { mean = 0.4, deviation = 0.02 }",
)


def identify_file():
    lines = maybe(f'model = "{draw.choice(("tabulated", "hess-forsbach"))}"')
    lines += maybe('scatter = "heavy-tailed"', 0.3)
    joint = named_joint() if draw.random() < 0.6 else []
    body = [] if joint else joint_tables(load=False)
    machine = draw.random() < 0.4
    tables = ["[machine.frame]", 'compliance = "0..20 um/kN"', "offset = 0.01"] if machine else []
    lines += [*joint, *body, "[free]", FREE[0], *draw.sample(FREE[1:], 1), *tables]
    for table in draw.sample(DATA, 2):
        lines += ["[[data]]", table, *(maybe('machine = "frame"') if machine else [])]
    return "\n".join(lines)


def question_file():
    lines = ['question = "May it be used?"', 'context_of_use = "Choice of clearance"', *named_joint()]
    lines += maybe(f"finite_elements = {draw.choice(('true', 'false'))}")
    lines += ["[risk]", f'influence = "{draw.choice(("low", "medium", "high"))}"', 'consequence = "medium"']
    lines += ["[required]", f"accuracy = {draw.choice((chr(34) + '10 %' + chr(34), 0.1, 0.05))}"]
    lines += maybe('limits = ["max_pressure <= 20 MPa", "edge_distance >= 1 mm"]')
    forces = draw.choice(("[1000, 2000]", '["1 kN", "2 kN"]', '"1.5 kN"'))
    lines += ["[matrix]", f"force = {forces}"]
    lines += maybe(draw.choice(("clearance = [0.05, 0.1]", "head_diameter = [28, 32]", 'tilt = ["0 deg", "20 deg"]')))
    if draw.random() < 0.6:
        lines += ["[tolerances]", 'clearance = "0.1 +- 0.03 mm"', *maybe('liner_poisson = "0.40 .. 0.45"')]
    lines += maybe('[sources]\njoint = "drawing"\nliner_young = "data sheet"', 0.4)
    lines += maybe("[friction]\ncoefficient = 0.06", 0.3) + maybe('[wear]\nfile = "hip.toml"', 0.2)
    return "\n".join(lines)


ODD = ('"3 foo"', '"3 kN"', '"20 mm"', "-5", "0", "true", "[]", "{}", '"text"', "1979-05-27", "nan", '"1e999"')
ODD += ("[1, 2]", '""', '["a"]', "{a = 1}", "1e12")
STRAY = ("young = 1000", "force = 100", 'law = "archard"', "count = 3", 'material = "steel"', "clearance = 0.1")
STRAY += ("tilt = 3", "name = 3", "values = 3", 'model = "hertzz"')


def damaged(text):
    """Return a file with one fault."""
    lines = text.split("\n")
    entries = [i for i, line in enumerate(lines) if " = " in line and "{" not in line]
    tables = [i for i, line in enumerate(lines) if line.startswith("[")]
    fault = draw.randrange(6)
    i = draw.choice(entries)
    key, _, value = lines[i].partition(" = ")
    if fault == 0:  # a misspelt key
        at = draw.randrange(len(key))
        lines[i] = f"{key[:at]}{key[at + 1 :]} = {value}"
    elif fault in (1, 2):
        lines[i] = f"{key} = {draw.choice(ODD)}"
    elif fault == 3:
        del lines[i]
    elif fault == 4 and tables:  # a misspelt table
        j = draw.choice(tables)
        lines[j] = lines[j].replace("]", "s]", 1)
    else:  # a key of another table
        lines.insert(i + 1, draw.choice(STRAY))
    return "\n".join(lines)


MAKERS = {"joint": joint_file, "hip": hip_file, "study": study_file, "identify": identify_file}
MAKERS["question"] = question_file


def main():
    """Draw files of each kind until there are enough that version 1.0 reads and refuses."""
    cases = []
    for kind, make in MAKERS.items():
        read, refused = [], []

        def sort(text, most, kind=kind, read=read, refused=refused):
            result = outcome(kind, text)
            if "refusal" not in result:
                read.append({"kind": kind, "text": text, **result})
            elif len(refused) < most and all(result["refusal"] != case["refusal"] for case in refused):
                refused.append({"kind": kind, "text": text, **result})

        while len(read) < 40:
            sort(make(), 20)
        while len(refused) < 80:
            sort(damaged(draw.choice(read[:40])["text"]), 80)
        print(kind, len(read), len(refused))
        cases += read[:40] + refused
    Path(__file__).with_name("files_of_1_0.json").write_text(json.dumps(cases, indent=0, ensure_ascii=False))


if __name__ == "__main__":
    main()
