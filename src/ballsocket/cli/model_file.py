"""Models of Python files: `--model my_file.py:name` on the command line.

Files, links, the explorer and tool calls accept names of models only, because a model file runs as a program.
"""

from __future__ import annotations

import re
import sys
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import Any

from ..contact import Model
from ..core.checks import shown
from ..core.input_files import is_restricted
from ..core.validity import OutsideDomainError
from ..model_catalogue import named_models
from ..models.foundation import RadialFoundation
from ..models.modulus import Modulus
from ..problem.presets import joints

_FORM = re.compile(r"(?P<path>.+\.py):(?P<name>[^:]*)")

_TRIAL_JOINT, _TRIAL_FORCE = joints["hip-28"], 1000.0
"""Joint and force (N) that a custom model presses when it is loaded."""

_TRIAL_STEP, _TRIAL_TOLERANCE = 1e-3, 0.01
"""Relative step of the derivatives of the trial press, and their allowed relative error."""


_LOADED: dict[str, Path] = {}  # model files that this process has imported, by module name

_FOLDERS: set[Path] = set()
"""Their folders, which are part of `sys.path` for worker processes and for other modules of the user."""


def load_model(text: str) -> Model:
    """Import a Python file, and return the model with a name in it, after one trial press.

    The name belongs to a model, to a class or function that makes one without arguments, to a foundation modulus, or
    to a function that computes the modulus K in MPa/mm of a joint.

    Raises ValueError: a model file that does not exist, fails, or has no such model; a process that serves others.
    """
    if is_restricted():
        raise ValueError(f"model {shown(text)} is not allowed: only the command line of a user runs a model file")
    form = _FORM.fullmatch(text)
    if form is None or not form["name"].isidentifier():
        raise ValueError(f"model {shown(text)} must be FILE.py:NAME, such as 'my_model.py:Winkler'")
    path, name = Path(form["path"]), form["name"]
    module = _import_file(path)
    if not hasattr(module, name):
        public = [key for key, value in vars(module).items() if callable(value) or isinstance(value, Model | Modulus)]
        own = [key for key in public if getattr(vars(module)[key], "__module__", None) == module.__name__]
        raise ValueError(f"{path} has no {name!r}; it defines: {', '.join(own) or 'nothing'}")
    model = _make_model(getattr(module, name), text, path)
    if model.name in named_models:
        raise ValueError(f"the model of {text} is named {model.name!r}, as a model of ballsocket; give it another name")
    return model


def _import_file(path: Path) -> ModuleType:
    """Import a Python file as a module that worker processes can import, too."""
    if not path.is_file():
        raise ValueError(f"model file {shown(str(path))} does not exist")
    path = path.resolve()
    if _LOADED.get(path.stem) == path:
        return sys.modules[path.stem]
    if not path.stem.isidentifier() or (path.stem not in _LOADED and _origin(path.stem) not in (None, str(path))):
        raise ValueError(f"rename {path.name}: its name must be new and a Python identifier, such as my_model.py")
    spec = spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[path.stem] = module_from_spec(spec)
    if path.parent not in _FOLDERS:
        _FOLDERS.add(path.parent)
        sys.path.append(str(path.parent))
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        del sys.modules[path.stem]
        raise ValueError(f"model file {path.name} failed{_failure(error, path)}") from error
    _LOADED[path.stem] = path
    return module


def _origin(name: str) -> str | None:
    """Return the file of an installed or imported module; None for an unknown name."""
    if name in sys.modules:
        return getattr(sys.modules[name], "__file__", None) or "built in"
    spec = find_spec(name)
    if spec is None or (spec.origin and Path(spec.origin).parent in _FOLDERS):
        return None
    return spec.origin or "built in"


def _make_model(value: Any, text: str, path: Path) -> Model:
    """Return a model from an object of a model file, checked by a trial press."""
    kinds = "a model, a class or function that makes one, a modulus, or a function of a joint that returns K in MPa/mm"
    try:
        if isinstance(value, type) and issubclass(value, Model):
            value = value()
        if callable(value) and not isinstance(value, Model | Modulus | type):
            code = getattr(value, "__code__", None)
            if code is not None and code.co_argcount <= len(getattr(value, "__defaults__", None) or ()):
                value = value()
        if not isinstance(value, Model | type) and (isinstance(value, Modulus) or callable(value)):
            value = RadialFoundation(modulus=value)
        if not isinstance(value, Model):
            raise ValueError(f"{text} is not a model: {shown(value)}; it must be {kinds}")
        for attribute in ("name", "title"):
            words = getattr(value, attribute)
            if not isinstance(words, str) or not words.strip():
                raise ValueError(f"{attribute} of {text} must be text, got {shown(words)}")
        for attribute in ("sources", "validity", "domain"):
            listed = getattr(value, attribute)
            if not isinstance(listed, tuple):
                raise ValueError(f"{attribute} of {text} must be a tuple, which may be empty, got {shown(listed)}")
        _check_laws(value, text)
    except OutsideDomainError:
        pass  # the model may be for other joints
    except ValueError as error:
        if extract_tb(error.__traceback__)[-1].filename == str(path.resolve()):
            raise ValueError(f"model {text} failed{_failure(error, path)}") from error
        raise
    except Exception as error:
        raise ValueError(f"model {text} failed{_failure(error, path)}") from error
    return value


def _check_laws(model: Model, text: str) -> None:
    """Press the trial joint; check that the stiffness and the force are derivatives of the force and the energy."""
    contact = model.press(_TRIAL_JOINT, force=_TRIAL_FORCE)
    d, step = float(contact.indentation), _TRIAL_STEP * float(contact.indentation)
    low, high = (model.press(_TRIAL_JOINT, indentation=d + change) for change in (-step, step))
    for law, derivative in (("force", "stiffness"), ("energy", "force")):
        slope = float(getattr(high, law) - getattr(low, law)) / (2 * step)
        value = float(getattr(contact, derivative))
        if abs(slope - value) > _TRIAL_TOLERANCE * abs(value):
            raise ValueError(
                f"{derivative} of {text} is {value:.4g} at an indentation of {d:.4g} mm, "
                f"but the derivative of its {law} is {slope:.4g}: correct one of them"
            )


def _failure(error: BaseException, path: Path) -> str:
    """Describe an error: the last line of the model file that caused it, its type and its message."""
    lines = [frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path.resolve())]
    if isinstance(error, SyntaxError):
        lines = [error.lineno]
    place = f" in line {lines[-1]}" if lines else ""
    return f"{place}: {type(error).__name__}: {error}"
