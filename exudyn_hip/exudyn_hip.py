"""The ball joint exudyn_hip: force and moment in SI units, without ballsocket. Written by ballsocket 1.0.0.

model: tabulated
joint: hip, Hess & Forsbach 2021, Fig. 3: R1 17.9 mm, clearance 0.1 mm, liner 6.75 mm of UHMWPE (E 1000 MPa, nu 0.4); ball steel head (E 230000 MPa, nu 0.3)
"""

import ctypes
import os
import shutil
import subprocess
from pathlib import Path

_FOLDER = Path(__file__).resolve().parent
_LIBRARY = _FOLDER / "_exudyn_hip.so"
_Three, _Seven = ctypes.c_double * 3, ctypes.c_double * 7
UNITS = (1000.0, 1.0, 1.0, 1.0, 0.001, 0.001, 1000.0)
"""One of the C program's units of each parameter, in SI."""


def _compiled():
    if not _LIBRARY.exists():
        compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
        if not compiler:
            raise ImportError("no compiler of C is there to make _exudyn_hip.so from exudyn_hip.c")
        words = [compiler, "-O2", "-fPIC", "-shared", "exudyn_hip.c", "-o", _LIBRARY.name, "-lm"]
        subprocess.run(words, cwd=_FOLDER, check=True)
    return ctypes.CDLL(str(_LIBRARY))


_c = _compiled()
_c.exudyn_hip_complaint.restype = _c.exudyn_hip_sentence.restype = ctypes.c_char_p
parameters = _Seven(*_Seven.in_dll(_c, "exudyn_hip_defaults"))
"""What may be tuned: hysteresis, retardation_time, friction_coefficient, static_coefficient, transition_speed, stribeck_speed, viscous_friction; in s, mm and N."""


class NoForce(ArithmeticError):
    """A state at which there is no force."""


def load(position, velocity=(0.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0)):
    """Force (N) and moment (N m) on the ball, and energy (J).

    Of the position (m) of the ball's centre from the socket's, its velocity (m/s) and the spin (rad/s) of the ball less
    that of the socket, all in axes fixed to the socket.
    """
    r = _Three(*(1e3 * part for part in position))
    v = _Three(*(1e3 * part for part in velocity))
    w, force, moment, energy = _Three(*spin), _Three(), _Three(), ctypes.c_double()
    complaint = _c.exudyn_hip_complaint(ctypes.byref(parameters))
    if complaint:
        raise ValueError(complaint.decode())
    status = _c.exudyn_hip_load(ctypes.byref(parameters), r, v, w, force, moment, ctypes.byref(energy))
    if status >= 5:
        raise NoForce(f"{_c.exudyn_hip_sentence(status).decode()}: position {list(position)} m")
    return tuple(force), tuple(1e-3 * part for part in moment), 1e-3 * energy.value


def status(position):
    """Status of the contact, and a sentence on it; 4: the indentation exceeds the wall thickness or the range of the model; the force has its last stiffness."""
    code = _c.exudyn_hip_contact(_Three(*(1e3 * part for part in position)), ctypes.byref(ctypes.c_double()), ctypes.byref(ctypes.c_double()))
    return code, _c.exudyn_hip_sentence(code).decode()


def contact(position):
    """Half angle (rad) of the contact and its largest pressure (Pa)."""
    angle, pressure = ctypes.c_double(), ctypes.c_double()
    _c.exudyn_hip_contact(_Three(*(1e3 * part for part in position)), ctypes.byref(angle), ctypes.byref(pressure))
    return angle.value, 1e6 * pressure.value
