"""Platform of compiled libraries: it is read from their header."""

import os
import re
import shutil
import zipfile

import pytest

import ballsocket as bs
from ballsocket.dynamics import ForceElement
from ballsocket.export import TARGETS, ExportJob
from ballsocket.export.compiler import THIS_PLATFORM, NoCompiler, Platform, compile_library, library_platform
from ballsocket.export.fmu import Fmu

from ..cli.command import printed
from ..joints import HIP
from ..refusals import refused_calls
from .library import needs_compiler, needs_scripts, python_header, set_compiler, writes

ELEMENT = ForceElement(bs.HessForsbach(), HIP)
MINGW = "x86_64-w64-mingw32-gcc"
WINDOWS_HEADER = b"MZ".ljust(0x3C, b"\0") + (0x80).to_bytes(4, "little")
WINDOWS_HEADER = WINDOWS_HEADER.ljust(0x80, b"\0") + b"PE\0\0" + (0x8664).to_bytes(2, "little")
FAR_HEADER = b"MZ".ljust(0x3C, b"\xff") + (0x1F0).to_bytes(4, "little")
FAR_HEADER = FAR_HEADER.ljust(0x1F0, b"\xff") + b"PE\0\0\x4c\x01\xff\xff"


def elf(machine):
    return b"\x7fELF".ljust(18, b"\x02") + machine.to_bytes(2, "little")


@pytest.mark.parametrize(
    ("header", "name", "ending", "bits"),
    [
        (elf(0x3E), "x86_64-linux", ".so", 64),
        (elf(0xB7), "aarch64-linux", ".so", 64),
        (elf(0x03), "x86-linux", ".so", 32),
        (b"\x7fELF" + bytes(14) + b"\xb7\x00" + b"\xff" * 9, "aarch64-linux", ".so", 64),
        (WINDOWS_HEADER, "x86_64-windows", ".dll", 64),
        (FAR_HEADER, "x86-windows", ".dll", 32),
        (b"\xcf\xfa\xed\xfe" + (0x0100000C).to_bytes(4, "little"), "aarch64-darwin", ".dylib", 64),
        (b"\xcf\xfa\xed\xfe\x07\x00\x00\x01" + b"\xff" * 9, "x86_64-darwin", ".dylib", 64),
    ],
)
def test_the_platform_of_a_library_is_read_from_its_header(header, name, ending, bits):
    """e_machine of ELF has byte 18, cputype of Mach-O byte 4, Machine of PE the fourth byte after its start."""
    platform = library_platform(header)
    assert (str(platform), platform.library_ending, platform.bits) == (name, ending, bits)
    assert Platform(system="linux", processor="riscv").bits == 64  # an unlisted one


test_files_of_another_format_are_refused = refused_calls(
    (lambda: library_platform(b"#!/b"), "not those of ELF"),
    (lambda: library_platform(elf(0x1234)), "number 0x1234"),
    (lambda: library_platform(b"\x7fELG" + bytes(99)), "its first bytes are 7f454c47, not those"),
)


def test_this_python_runs_on_the_platform_that_its_own_header_states():
    assert library_platform(python_header()) == THIS_PLATFORM


@pytest.fixture
def cross_compiler(tmp_path, monkeypatch):
    """A compiler that writes the header of a Windows library."""
    set_compiler(monkeypatch, tmp_path, [writes(WINDOWS_HEADER)])


@needs_scripts
@pytest.mark.parametrize(("version", "folder"), [(2, "win64"), (3, "x86_64-windows")])
def test_an_fmu_files_the_binary_of_a_cross_compiler_under_its_platform(version, folder, cross_compiler, tmp_path):
    written = Fmu(element=ELEMENT, name="hip", version=version).write(tmp_path / "hip.fmu")
    with zipfile.ZipFile(written.path) as archive:
        assert [name for name in archive.namelist() if name.startswith("bin")] == [f"binaries/{folder}/hip.dll"]
    assert written.missing.startswith("the binary is for x86_64-windows, the platform of its compiler")
    assert written.missing.endswith(f"; the binary for {THIS_PLATFORM} is missing")


@needs_compiler
@needs_scripts
def test_an_fmu_has_the_binary_of_an_installed_cross_compiler_beside_that_of_this_machine(tmp_path, monkeypatch):
    set_compiler(monkeypatch, tmp_path, [writes(WINDOWS_HEADER)])
    monkeypatch.delenv("CC")
    (tmp_path / "script gcc").rename(tmp_path / MINGW)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    written = Fmu(element=ELEMENT, name="hip", version=2).write(tmp_path / "hip.fmu")
    assert written.missing == ""
    with zipfile.ZipFile(written.path) as archive:
        names = {name for name in archive.namelist() if name.startswith("bin")}
    assert len(names) == 2
    assert "binaries/win64/hip.dll" in names
    set_compiler(monkeypatch, tmp_path, ["sys.exit(3)"])
    monkeypatch.delenv("CC")
    (tmp_path / "script gcc").rename(tmp_path / MINGW)
    assert f"{MINGW} ended with 3" in Fmu(element=ELEMENT, name="hip").write(tmp_path / "hip.fmu").missing


@needs_scripts
def test_a_library_for_another_platform_is_not_left_for_a_program_of_this_machine(cross_compiler, tmp_path):
    job = ExportJob(element=ELEMENT, name="hip", depth=0.05)
    _, missing = TARGETS["drake"].write(job, tmp_path / "hip")
    assert f"builds for x86_64-windows, not for this machine, {THIS_PLATFORM}; the sources are written" in missing
    assert not (tmp_path / "hip" / job.template_context["library"]).exists()


@needs_scripts
@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (None, "script gcc wrote no usable library"),
        ((), "script gcc ended with 3: it printed no message"),
        (("note: first", "note: second"), "script gcc ended with 3: note: first"),
        (("note: first", "one.c: error: second", "error: third"), "script gcc ended with 3: one.c: error: second"),
    ],
)
def test_the_first_error_of_a_failing_compiler_is_reported(lines, message, tmp_path, monkeypatch):
    lines = () if lines is None else (*(f"print({line!r}, file=sys.stderr)" for line in lines), "sys.exit(3)")
    set_compiler(monkeypatch, tmp_path, lines)
    with pytest.raises(NoCompiler, match=message):
        compile_library(["one.c"], tmp_path / "one.so", tmp_path)


@needs_scripts
def test_a_compiler_that_cannot_be_run_is_named(tmp_path, monkeypatch):
    file = tmp_path / "no program"
    file.write_bytes(b"\x7fELF, but nothing else")
    file.chmod(0o755)
    monkeypatch.setenv("CC", str(file))
    with pytest.raises(NoCompiler, match=re.escape(f"the compiler {file} could not be run")):
        compile_library(["one.c"], tmp_path / "one.so", tmp_path)


@pytest.mark.skipif(shutil.which(MINGW) is None, reason=f"{MINGW} is not installed")
def test_a_real_cross_compiler_builds_a_windows_library(tmp_path, monkeypatch):
    monkeypatch.setenv("CC", MINGW)
    printed("fmu", "hip-28", "--out", "hip.fmu", folder=tmp_path)
    with zipfile.ZipFile(tmp_path / "hip.fmu") as archive:
        binary = archive.read("binaries/x86_64-windows/hip.dll")
    assert library_platform(binary) == Platform(system="windows", processor="x86_64")


@needs_compiler
def test_a_compiler_of_this_machine_builds_for_it(tmp_path):
    (tmp_path / "one.c").write_text("int one(void) { return 1; }\n")
    assert compile_library(["one.c"], tmp_path / "one.so", tmp_path) == THIS_PLATFORM
