"""A unit: description, sources, and a binary for the machine that it is made on, in one archive."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import UUID

from ...core.checks import require
from ...core.storage.atomic_files import write_atomically
from ...dynamics import ForceElement
from ...version import __version__
from ..c_element import CElement, filled
from ..c_text import c_number
from ..compiler import LIBRARY_ENDING, THIS_PLATFORM, NoCompiler, Platform, compile_library
from ..trusted import trusted_depth
from ..tunable import TUNABLES
from .description import About, build_description, fmi2_description, fmi3_description
from .variables import Variable, variables

_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # an archive of the same element is the same archive


@dataclass(frozen=True, kw_only=True)
class Standard:
    """A version of FMI; `folder` names the folder of a platform's binaries."""

    version: str
    wrapper: str
    folder: Callable[[Platform], str]
    describe: Callable[[About, Sequence[Variable]], bytes]


def _fmi2_folder(platform: Platform) -> str:
    return f"{ {'windows': 'win'}.get(platform.system, platform.system) }{platform.bits}"


STANDARDS: Mapping[int, Standard] = {
    2: Standard(version="2.0", wrapper="fmi2.c", folder=_fmi2_folder, describe=fmi2_description),
    3: Standard(version="3.0", wrapper="fmi3.c", folder=str, describe=fmi3_description),
}


@dataclass(frozen=True, kw_only=True)
class Written:
    """What was written: the archive, and a sentence on what is missing in it, empty where nothing is."""

    path: Path
    missing: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class Fmu:
    """A force element as a functional mock-up unit, for model exchange and co-simulation, in SI units.

    Position, velocity and spin are its inputs, force, moment, energy, half angle and largest pressure its outputs; it
    has no states. What the element loses are parameters that can be tuned while it runs.

    Parameters
    ----------
    element : ForceElement
    name : str
        The identifier of the model: letters, digits and _.
    version : int
        Of FMI, 2 or 3.

    Raises
    ------
    ValueError
        A name or a version that is not allowed.
    """

    element: ForceElement
    name: str = "ballsocket"
    version: int = 3

    def __post_init__(self) -> None:
        require("FMI version", self.version, self.version in STANDARDS, "2 and 3 are written")
        CElement(element=self.element, name=self.name)

    @property
    def standard(self) -> Standard:
        return STANDARDS[self.version]

    @cached_property
    def sources(self) -> Mapping[str, str]:
        """The texts of the folder `sources`, by name."""
        words = {
            "name": self.name,
            "NAME": self.name.upper(),
            "version": __version__,
            "guid": self.guid,
            **self._numbers,
        }
        return self._program | {name: filled(name, **words) for name in ("fmu_core.h", self.standard.wrapper)}

    @cached_property
    def guid(self) -> str:
        """By what the description and the binary know that they belong together: it changes with every number."""
        parts = (*self._program.values(), *self._numbers.values(), self.standard.version, self.name)
        return f"{{{UUID(bytes=sha256(''.join(parts).encode()).digest()[:16])}}}"

    @cached_property
    def _program(self) -> dict[str, str]:
        made = CElement(element=self.element, name=self.name)
        return {f"{self.name}.h": made.header, f"{self.name}.c": made.source}

    @cached_property
    def _numbers(self) -> dict[str, str]:
        element, joint = self.element, self.element.joint.with_floats()
        deepest = trusted_depth(element)
        beyond = f"{element.model.name} does not trust itself beyond an indentation of {deepest:.4g} mm"
        return {
            "parameters": str(len(TUNABLES)),
            "units": ", ".join(c_number(each.si) for each in TUNABLES),
            "starts": ", ".join(c_number(getattr(element.constants, each.constant) * each.si) for each in TUNABLES),
            "valid": c_number(joint.clearance + deepest),
            "beyond": beyond,
        }

    @property
    def about(self) -> About:
        """What the description says of the unit."""
        texts = [name for name in self.sources if name.endswith(".c")]
        text = f"ball in a socket, {self.element.model.title}"
        return About(name=self.name, guid=self.guid, text=text, tool=f"ballsocket {__version__}", sources=texts)

    def write(self, path: Path) -> Written:
        """Write the archive; `missing` states the binary that it lacks.

        Raises
        ------
        OSError
            A folder that cannot be written to.
        """
        files: dict[str, bytes] = {"modelDescription.xml": self.standard.describe(self.about, variables(self.element))}
        files |= {f"sources/{name}": text.encode() for name, text in self.sources.items()}
        if self.version == 3:
            files["sources/buildDescription.xml"] = build_description(self.about)
        missing = ""
        try:
            platform, binary = self._binary()
            files[f"binaries/{self.standard.folder(platform)}/{self.name}{platform.library_ending}"] = binary
            if platform != THIS_PLATFORM:
                missing = (
                    f"the binary is for {platform}, the platform of its compiler; "
                    f"the binary for {THIS_PLATFORM} is missing"
                )
        except NoCompiler as error:
            missing = f"{error}; the sources are there, the binary is not"
        with write_atomically(Path(path)) as draft, zipfile.ZipFile(draft, "w") as archive:
            for name in sorted(files):
                entry = zipfile.ZipInfo(name, _LONG_AGO)
                entry.external_attr, entry.create_system = 0o644 << 16, 3
                archive.writestr(entry, files[name], zipfile.ZIP_DEFLATED, 9)
        return Written(path=Path(path), missing=missing)

    def _binary(self) -> tuple[Platform, bytes]:
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            for name, text in self.sources.items():
                (folder / name).write_text(text, encoding="utf-8")
            library = folder / f"{self.name}{LIBRARY_ENDING}"
            platform = compile_library(self.about.sources, library, folder)
            return platform, library.read_bytes()
