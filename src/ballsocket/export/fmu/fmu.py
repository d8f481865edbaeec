"""FMU archive with description, sources, and a binary for the machine that writes it."""

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
from ..c_element import CElement, fill_template
from ..c_text import c_number
from ..compiler import LIBRARY_ENDING, THIS_PLATFORM, NoCompiler, Platform, compile_library
from ..tunable import TUNABLES
from ..validity_depth import valid_depth
from .description import UnitInformation, build_description, fmi2_description, fmi3_description
from .variables import Variable, variables

_ARCHIVE_DATE = (1980, 1, 1, 0, 0, 0)
"""Fixed date of all files, so that equal elements give equal archives."""


@dataclass(frozen=True, kw_only=True)
class Standard:
    """Version of the FMI standard; `folder` returns the folder name for the binaries of a platform."""

    version: str
    wrapper: str
    folder: Callable[[Platform], str]
    describe: Callable[[UnitInformation, Sequence[Variable]], bytes]


def _fmi2_folder(platform: Platform) -> str:
    return f"{ {'windows': 'win'}.get(platform.system, platform.system) }{platform.bits}"


STANDARDS: Mapping[int, Standard] = {
    2: Standard(version="2.0", wrapper="fmi2.c", folder=_fmi2_folder, describe=fmi2_description),
    3: Standard(version="3.0", wrapper="fmi3.c", folder=str, describe=fmi3_description),
}


@dataclass(frozen=True, kw_only=True)
class FmuFile:
    """Written FMU archive: its path, and a note on a missing binary; empty if the archive is complete."""

    path: Path
    missing: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class Fmu:
    """Force element as an FMU (functional mock-up unit) for model exchange and co-simulation, in SI units.

    Inputs are position, velocity and spin; outputs are force, moment, energy, half angle and largest pressure. The unit
    has no states. Damping and friction are tunable parameters.

    Parameters
    ----------
    element : ForceElement
    name : str
        Identifier of the model: letters, digits and _.
    version : int
        Version of FMI, 2 or 3.

    Raises
    ------
    ValueError
        An invalid name or version.
    """

    element: ForceElement
    name: str = "ballsocket"
    version: int = 3

    def __post_init__(self) -> None:
        require("FMI version", self.version, self.version in STANDARDS, "2 or 3")
        CElement(element=self.element, name=self.name)

    @property
    def standard(self) -> Standard:
        """FMI standard of the unit."""
        return STANDARDS[self.version]

    @cached_property
    def sources(self) -> Mapping[str, str]:
        """Source files of the unit: contents by name."""
        values = {
            "name": self.name,
            "NAME": self.name.upper(),
            "version": __version__,
            "guid": self.guid,
            **self._numbers,
        }
        return self._program | {name: fill_template(name, **values) for name in ("fmu_core.h", self.standard.wrapper)}

    @cached_property
    def guid(self) -> str:
        """Identifier that links description and binary; it depends on all numbers of the unit."""
        parts = (*self._program.values(), *self._numbers.values(), self.standard.version, self.name)
        return f"{{{UUID(bytes=sha256(''.join(parts).encode()).digest()[:16])}}}"

    @cached_property
    def _program(self) -> dict[str, str]:
        program = CElement(element=self.element, name=self.name)
        return {f"{self.name}.h": program.header, f"{self.name}.c": program.source}

    @cached_property
    def _numbers(self) -> dict[str, str]:
        """Numbers and texts of the C wrapper, by the names in its template."""
        element, constants = self.element, self.element.constants
        deepest = valid_depth(element)
        beyond = f"{element.model.name} is not valid beyond an indentation of {deepest:.4g} mm"
        return {
            "parameters": str(len(TUNABLES)),
            "units": ", ".join(c_number(parameter.si) for parameter in TUNABLES),
            "starts": ", ".join(
                c_number(getattr(constants, parameter.constant) * parameter.si) for parameter in TUNABLES
            ),
            "valid": c_number(element.joint.with_floats().clearance + deepest),
            "beyond": beyond,
        }

    @property
    def information(self) -> UnitInformation:
        """Name, identifier and texts of the unit for its description."""
        texts = [name for name in self.sources if name.endswith(".c")]
        text = f"ball in a socket, {self.element.model.title}"
        return UnitInformation(
            name=self.name, guid=self.guid, text=text, tool=f"ballsocket {__version__}", sources=texts
        )

    def write(self, path: Path) -> FmuFile:
        """Write the FMU archive; the result names a binary that is missing.

        Raises
        ------
        OSError
            A folder that cannot be written to.
        """
        files: dict[str, bytes] = {
            "modelDescription.xml": self.standard.describe(self.information, variables(self.element))
        }
        files |= {f"sources/{name}": text.encode() for name, text in self.sources.items()}
        if self.version == 3:
            files["sources/buildDescription.xml"] = build_description(self.information)
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
            missing = f"{error}; the archive contains the sources without a binary"
        with write_atomically(Path(path)) as draft, zipfile.ZipFile(draft, "w") as archive:
            for name in sorted(files):
                entry = zipfile.ZipInfo(name, _ARCHIVE_DATE)
                entry.external_attr, entry.create_system = 0o644 << 16, 3
                archive.writestr(entry, files[name], zipfile.ZIP_DEFLATED, 9)
        return FmuFile(path=Path(path), missing=missing)

    def _binary(self) -> tuple[Platform, bytes]:
        with TemporaryDirectory() as temporary:
            folder = Path(temporary)
            for name, text in self.sources.items():
                (folder / name).write_text(text, encoding="utf-8")
            library = folder / f"{self.name}{LIBRARY_ENDING}"
            platform = compile_library(self.information.sources, library, folder)
            return platform, library.read_bytes()
