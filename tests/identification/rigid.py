"""Joint with a rigid ball, whose unknowns are identified from presses of a closed form."""

import ballsocket as bs

JOINT = bs.Joint(ball_radius=16.0, clearance=0.1, liner_thickness=6.0, liner=bs.Material(young=1000.0, poisson=0.4))
MODEL = bs.HessForsbach()
