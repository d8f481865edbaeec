"""C compiler, and target platforms of the libraries that it builds."""

from __future__ import annotations

import os
import platform
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

_COMPILER_NAMES = ("cc", "gcc", "clang")
_CROSS_COMPILERS = ("x86_64-w64-mingw32-gcc",)
_SHARED_LIBRARY_FLAGS = ("-shared",) if sys.platform == "win32" else ("-fPIC", "-shared")
_SYSTEMS = {"linux": "linux", "darwin": "darwin", "win32": "windows"}
_LIBRARY_ENDINGS = {"windows": ".dll", "darwin": ".dylib"}
_PROCESSORS = {"amd64": "x86_64", "arm64": "aarch64", "i386": "x86", "i686": "x86"}
_BITS = {"x86_64": 64, "aarch64": 64, "x86": 32}


@dataclass(frozen=True, kw_only=True)
class Platform:
    """Operating system and processor of a library, with the names of FMI 3."""

    system: str  # "linux", "windows", "darwin", ...
    processor: str  # "x86_64", "aarch64", "x86", ...

    def __str__(self) -> str:
        return f"{self.processor}-{self.system}"

    @property
    def bits(self) -> int:
        """Word size of the processor in bits, 32 or 64."""
        return _BITS.get(self.processor, 64 if sys.maxsize > 2**32 else 32)

    @property
    def library_ending(self) -> str:
        """File name ending of a shared library, such as ".so"."""
        return _LIBRARY_ENDINGS.get(self.system, ".so")


def _this_platform() -> Platform:
    processor = platform.machine().lower()
    processor = _PROCESSORS.get(processor, processor)
    if sys.maxsize < 2**32 and processor == "x86_64":
        processor = "x86"  # a 32-bit Python on a 64-bit system
    return Platform(system=_SYSTEMS.get(sys.platform, sys.platform), processor=processor)


THIS_PLATFORM = _this_platform()
LIBRARY_ENDING = THIS_PLATFORM.library_ending

_ELF_MACHINES: Mapping[int, str] = {0x3E: "x86_64", 0xB7: "aarch64", 0x03: "x86"}
_PE_MACHINES: Mapping[int, str] = {0x8664: "x86_64", 0xAA64: "aarch64", 0x014C: "x86"}
_MACH_O_PROCESSORS: Mapping[int, str] = {0x01000007: "x86_64", 0x0100000C: "aarch64"}


class NoCompiler(RuntimeError):  # noqa: N818 - a sentence for people
    """Error for a missing or failing C compiler."""


def compiler() -> list[str]:
    """Return the command of the C compiler: the environment variable CC, else the first of cc, gcc and clang.

    CC is the path of a program, which may contain blanks, or a program with arguments.

    Raises NoCompiler: no compiler is installed.
    """
    if (stated_program := shutil.which(os.environ.get("CC", ""))) is not None:
        return [stated_program]
    stated_command = _split_environment_variable("CC")
    if stated_command and shutil.which(stated_command[0]):
        return stated_command
    installed = next(filter(None, map(shutil.which, _COMPILER_NAMES)), None)
    if stated_command or installed is None:
        reason = (
            f"CC is {stated_command[0]!r}, which is not installed"
            if stated_command
            else f"none of {', '.join(_COMPILER_NAMES)} is installed"
        )
        raise NoCompiler(f"no C compiler: {reason}")
    return [installed]


def cross_compilers() -> list[list[str]]:
    """Return the commands of the installed compilers for other platforms; none beside a compiler that CC names."""
    return [] if os.environ.get("CC") else [[path] for path in filter(None, map(shutil.which, _CROSS_COMPILERS))]


def compile_library(
    sources: Sequence[str],
    library: Path,
    folder: Path,
    options: Sequence[str] = (),
    program: Sequence[str] = (),
) -> Platform:
    """Compile C sources of a folder into a shared library, and return the platform in its header.

    `program` is the command of the compiler; empty is that of `compiler`. The environment variable CFLAGS applies. A
    cross-compiler builds for another platform than this machine.

    Raises NoCompiler: a missing compiler, a failed one (with its first error message), or an unknown output format.
    """
    flags = _split_environment_variable("CFLAGS")
    command = [
        *(program or compiler()),
        "-std=c99",
        "-O2",
        *flags,
        *_SHARED_LIBRARY_FLAGS,
        *options,
        *sources,
        "-o",
        str(library),
        "-lm",
    ]
    try:
        process = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace", timeout=300)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoCompiler(f"the compiler {command[0]} could not be run: {error}") from error
    if process.returncode:
        lines = process.stderr.splitlines() or ["it printed no message"]
        message = next((line for line in lines if "error" in line), lines[0])
        raise NoCompiler(f"the compiler {command[0]} ended with {process.returncode}: {message:.200}")
    try:
        return library_platform((folder / library).read_bytes())
    except (OSError, ValueError) as error:
        raise NoCompiler(f"the compiler {command[0]} wrote no usable library: {error}") from error


def shared_library(sources: Sequence[str], library: Path, folder: Path, options: Sequence[str] = ()) -> Path:
    """Compile C sources of a folder into a shared library for this machine, and return its path.

    Raises NoCompiler: as `compile_library`, and for a library of another platform, which is removed.
    """
    built_for = compile_library(sources, library, folder, options)
    if built_for != THIS_PLATFORM:
        (folder / library).unlink()
        raise NoCompiler(f"the compiler {compiler()[0]} builds for {built_for}, not for this machine, {THIS_PLATFORM}")
    return library


def library_platform(header: bytes) -> Platform:
    """Determine the operating system and processor of a library from its first bytes (ELF, PE or Mach-O).

    Raises ValueError: another format, or an unknown processor.
    """
    if header[:4] == b"\x7fELF":
        system, machine, machines = "linux", int.from_bytes(header[18:20], "little"), _ELF_MACHINES
    elif header[:2] == b"MZ":
        start = int.from_bytes(header[0x3C:0x40], "little") + 4
        system, machine, machines = "windows", int.from_bytes(header[start : start + 2], "little"), _PE_MACHINES
    elif header[:4] == b"\xcf\xfa\xed\xfe":
        system, machine, machines = "darwin", int.from_bytes(header[4:8], "little"), _MACH_O_PROCESSORS
    else:
        raise ValueError(f"its first bytes are {header[:4].hex()}, not those of ELF, PE or Mach-O")
    if machine not in machines:
        raise ValueError(f"it is for an unknown processor of {system}, number {machine:#x}")
    return Platform(system=system, processor=machines[machine])


def _split_environment_variable(name: str) -> list[str]:
    """Split the value of an environment variable into the arguments of a command."""
    value = os.environ.get(name, "")
    try:
        return shlex.split(value)
    except ValueError as error:
        raise NoCompiler(f"no C compiler: {name} is {value!r:.60}, which is not a valid command") from error
