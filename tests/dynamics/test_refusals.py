"""Elements, states, motions and measurements that cannot be are refused."""

from dataclasses import replace
from math import inf, nan, radians

import numpy as np

import ballsocket as bs
from ballsocket import dynamics
from ballsocket.dynamics.restitution import restitution_of

from ..joints import HIP
from ..refusals import refused_calls

PLAIN = bs.ForceElement(bs.HessForsbach(), HIP)
HELD = replace(PLAIN, friction=dynamics.Bristles(coefficient=0.1))
OIL = bs.Lubricant(viscosity=0.1, ball_roughness=0.0, cup_roughness=5e-4)
TIGHT = bs.Joint(ball_radius=13.5, interference=0.03, liner_thickness=2.5, liner=bs.POM, ball=bs.STEEL)
PRONY = dynamics.Prony(terms=((0.3, 0.1), (0.2, 10.0)))
RELAXING = replace(PLAIN, relaxation=PRONY)
LINER = dynamics.Viscoelastic(bs.HessForsbach(), HIP, PRONY)
TIME = np.linspace(0.0, 2.0, 801)
STICKY = bs.AdhesiveSocket(work_of_adhesion=2e-3)


def element(model=None, joint=None, **words):
    return lambda: bs.ForceElement(model or bs.HessForsbach(), replace(HIP, **joint or {}), **words)


def wet(joint=None, **words):
    lubricant = {"viscosity": 0.1, "cup_roughness": 5e-4} | words
    return lambda: element(joint=joint, lubricant=bs.Lubricant(**lubricant))()


def preloaded(**words):
    model = bs.Sphere(cup=bs.Cup(arc_of_cover=radians(220.0)), ring_width=radians(5.0))
    return lambda: dynamics.PreloadedElement(**{"model": model, "joint": TIGHT} | words)


def motion(moving=PLAIN, **words):
    throw = {"mass": 1.0, "position": (0.01, 0.02, 0.0), "velocity": (10.0, 50.0, 200.0), "step": 2e-5}
    return lambda: dynamics.simulate(moving, **throw | {"duration": 1e-3} | words)


def rebound(speed, restitution, **words):
    return lambda: dynamics.from_restitution(speed=speed, restitution=restitution, **words)


VALUES = [
    (lambda: dynamics.Damping(hysteresis=-0.1), "hysteresis = -0.1 is not allowed: damping must be at least 0"),
    (lambda: dynamics.Damping(time=nan), "time = nan is not allowed"),
    (lambda: dynamics.Flores(restitution=1.1, impact_speed=1.0), "restitution = 1.1 is not allowed"),
    (lambda: dynamics.Flores(restitution=0.5, impact_speed=0.0), "impact_speed = 0 is not allowed"),
    (lambda: dynamics.Friction(coefficient=-0.1), "coefficient = -0.1 is not allowed: friction must be at least 0"),
    (lambda: dynamics.Friction(coefficient=0.1, static_coefficient=0.05), "static friction must be at least"),
    (lambda: dynamics.Bristles(coefficient=0.1, damping=-1.0), "damping = -1 is not allowed"),
    (element(smoothing=1.001 * HIP.clearance), "smoothing = .* between 0 and the clearance"),
    (element(bs.AdhesiveSocket(work_of_adhesion=10.0)), "the adhesion number = .* is not allowed: it must be below 1"),
    (lambda: PLAIN((0.0, 1.0)), "a state must have three components"),
    (lambda: HELD((0.0, 0.0, 0.12), deflection=(0.0, 0.0)), "four deflections"),
    (lambda: RELAXING((0.0, 0.0, 0.12), relaxed_force=1.0), "must have 2 relaxed forces, got 1.0"),
    (lambda: RELAXING((0.0, 0.0, 0.12), relaxed_force="ab"), "must have 2 relaxed forces, got 'ab'"),
    (lambda: RELAXING((0.0, 0.0, 0.12), relaxed_force=(0.0,)), "a relaxing liner must have 2 relaxed forces, got"),
    (lambda: RELAXING(np.zeros((5, 3)), relaxed_force=np.zeros((5, 3))), "must have 2 relaxed forces"),
    (lambda: PLAIN(np.zeros((5, 2))), r"position .*x, y, z \(mm\)"),
    (lambda: PLAIN(np.zeros((5, 3)), np.zeros((5, 2))), r"velocity .*x, y, z \(mm/s\)"),
    (lambda: PLAIN(np.zeros((5, 3)), np.zeros((5, 3)), np.zeros(4)), r"spin .*x, y, z \(rad/s\)"),
    (wet(joint={"clearance": 0.0}), "clearance = 0 is not allowed: a lubricant needs a film"),
    (wet(joint={"clearance": 1e-3}, ball_roughness=1e-3), "at most half of the clearance: 0.0005"),
    (wet(ball_roughness=0.0, cup_roughness=0.0), "roughness = 0 is not allowed"),
    (element(film_tension=0.1), r"film_tension = 0\.1 needs a lubricant"),
    *((element(lubricant=OIL, film_tension=p), "is not allowed: a tension") for p in (0.0, -0.1, nan)),
    *((wet(viscosity=eta), "viscosity = .* is not allowed") for eta in (0.0, inf, nan)),
    (wet(viscosity=1e308), "the damping of its film must be a finite number"),
    (lambda: bs.ForceElement(bs.HessForsbach(), TIGHT), "a preloaded joint needs a PreloadedElement"),
    (preloaded(joint=HIP), "interference = .* is not allowed"),
    (preloaded(model=bs.Sphere()), "arc_of_cover = 3.14159 is not allowed: a preloaded socket"),
    (motion(mass=-1.0), "mass = -1 is not allowed"),
    (motion(mass=1e-200), "mass = 1e-200 is not allowed: mass must be between 1e-100 and 1e.100"),
    (motion(inertia=nan), "inertia = nan is not allowed: inertia must be between"),
    (motion(duration=1e300), "the number of steps = 5e.304 is not allowed"),
    (motion(pull=(0.0, 1.0)), "a pull must have three components"),
    (motion(position=(0.0, 1.0)), "a state must have three components"),
    *((lambda h=h: restitution_of(h), "damping = .* is not allowed") for h in (-1e-9, inf)),
    *((rebound([100.0], [e]), rf"restitution\[0\] = {e:g} is not allowed") for e in (1.2, 0.0)),
    *((rebound(*rows), "rows of equal length") for rows in (([], []), ([1.0, 2.0], [0.5]), ([[1.0]], [[0.5]]))),
    *((rebound([speed], [0.5]), r"speed\[0\] = ") for speed in (0.0, inf)),
    *((rebound([100.0], [0.5], uncertainty=error), "uncertainty = ") for error in (0.0, inf, -0.1)),
    (lambda: dynamics.from_bounces(times=[0.0, 1.0]), "the number of times = 2 is not allowed"),
    (lambda: dynamics.from_bounces(times=[0.0, 1.0, 1.0]), "times must increase"),
    (lambda: dynamics.Prony(terms=()), "the number of terms = 0 is not allowed"),
    (lambda: dynamics.Prony(terms=((-0.1, 1.0),)), "a share = -0.1 is not allowed"),
    (lambda: dynamics.Prony(terms=((0.1, 0.0),)), "a relaxation time = 0 is not allowed"),
    (lambda: dynamics.Prony(terms=((0.5, 1.0), (0.6, 2.0))), "the sum of the shares = 1.1 is not allowed"),
    (lambda: LINER.cycle_force([0.0, 1.0, 1.0], [0.0, 0.1, 0.0]), "times must increase"),
    (lambda: LINER.cycle_force([0.0, 1.0], [0.0]), "rows of equal length"),
    (lambda: LINER.cycle_force([0.0, 1.0], [0.1, 0.0]), "must begin without contact"),
    (lambda: LINER.cycle_force(TIME, 0.05 * np.abs(np.sin(np.pi * TIME))), "must rise once .*; use `spring_force`"),
]
TYPES = [
    (element(damping=0.3), "damping must be a Damping, got 0.3"),
    (element(lubricant=0.0025), r"lubricant must be a Lubricant, got 0\.0025"),
    (element(STICKY, friction=dynamics.Friction(coefficient=0.1)), "not supported with AdhesiveSocket"),
    (element(STICKY, lubricant=OIL), "lubricant and relaxation are not supported with AdhesiveSocket"),
    (element(STICKY, relaxation=PRONY), "relaxation are not supported with AdhesiveSocket"),
    (element(relaxation=((0.3, 0.1),)), "relaxation must be a Prony"),
    (lambda: dynamics.Prony(terms=(0.3, 0.1)), "terms must be pairs of a share and a relaxation time"),
    (lambda: dynamics.Prony(terms=(("0.3", 0.1),)), "a share must be a number"),
    (element(relaxation=PRONY, smoothing=0.01), "cup and smoothing are not supported with relaxation"),
    (element(relaxation=PRONY, cup=bs.Cup()), "cup and smoothing are not supported with relaxation"),
    (preloaded(model=bs.Exact()), "model must be Sphere"),
    (preloaded(friction=dynamics.Bristles(coefficient=0.1, stiffness=1e3)), "bristles are not supported"),
    (preloaded(damping=0.1), "damping must be Damping"),
    (motion(3), "element must be a ForceElement, got 3"),
    (lambda: dynamics.Viscoelastic(bs.Hertz(), HIP, PRONY).spring_force(TIME, TIME), "must be radial springs"),
]


test_values_that_cannot_be_are_refused = refused_calls(*VALUES)


test_arguments_of_another_kind_are_refused = refused_calls(*TYPES, error=TypeError)
