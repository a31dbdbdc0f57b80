"""What the native build checks of kernels, objects and libraries."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

pytest.importorskip("lief", reason="needs the extra: pip install -e .[native]")

import lief
from pldf.build.fmus import RUNTIME
from pldf.build.native import linking
from pldf.build.native.language import check_language
from pldf.build.native.linking import HEADERS, link, zig
from pldf.build.native.symbols import check_library, fmi_functions, needed_by_object
from pldf.cosim.platforms import TARGETS

# What kernels must not use


@dataclass
class Record:
    """The state of the kernels below."""

    speed: float = 0.0


def kernel(folder: Path, *lines: str) -> ModuleType:
    """Return a kernel module with these lines in its only function, the first on line 5."""
    text = "\n".join(("from math import sin", "", "", "def advance(st, step_s):", *lines, ""))
    path = folder / "some_kernel.py"
    path.write_text(text)
    spec = spec_from_file_location("some_kernel", path)
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("statement", "reason"),
    [
        ("gains = {0: 1.0}", "no dict"),
        ("gains = [1.0]", "no list"),
        ("st.speed = st.speed**2", r"no \*\*"),
        ("st.speed **= 2", r"no \*\*"),
        ("k = st.speed // 2.0", "no //"),
        ("st.speed %= 2.0", "no %"),
        ("raise ValueError", "no exception"),
        ("st.speed = sin(st.speed)", r"sin\(\) is no function of the kernel"),
        ("st.speed.hex()", r"st.speed.hex\(\) is no function of the kernel"),
        ("st.sped = 1.0", "has a field 'sped'"),
        ("a = f'{st.speed}'", "JoinedStr is not in the part of Python that kernels use"),
        ("a = lambda: 0", "Lambda is not in"),
    ],
)
def test_a_kernel_is_refused_with_file_and_line(
    tmp_path: Path, statement: str, reason: str
) -> None:
    module = kernel(tmp_path, "    st.speed = 1.0", f"    {statement}")
    with pytest.raises(ValueError, match=rf"some_kernel\.py:6: .*{reason}"):
        check_language([module], Record)


def test_a_kernel_in_the_language_passes(tmp_path: Path) -> None:
    body = ("    for k in range(int(step_s)):", "        st.speed += max(0.5 * k, -1.0)")
    check_language([kernel(tmp_path, *body)], Record)


# What libraries must not need or offer


def compiled(path: Path, target: str, source: str, *options: str) -> Path:
    """Compile C for a target into ``path``."""
    file = path.with_suffix(".c")
    file.write_text(source)
    how = ["-O2", "-s"]  # as for FMUs: zig has then compiled its C library
    subprocess.run(zig(target, *how, *options, file, "-o", path), check=True)
    return path


def exports(names: Sequence[str], body: str = "") -> str:
    """Return the source of a library with these functions."""
    mark = "\n#ifdef _WIN32\n#define OUT __declspec(dllexport)\n#else\n#define OUT\n#endif\n"
    return mark + "\n".join(f"OUT void {name}(void) {{ {body} }}" for name in names)


LIBRARIES = ("x86_64-linux", "x86_64-windows", "aarch64-darwin")


def library_on(folder: Path) -> Callable[..., Path]:
    """Return what compiles a library: target, source, options."""
    return lambda target, *rest: compiled(
        folder / f"library{TARGETS[target].suffix}", target, *rest, "-shared"
    )


@pytest.mark.parametrize("target", LIBRARIES)
def test_exports_must_be_the_functions_of_fmi(tmp_path: Path, target: str) -> None:
    library = library_on(tmp_path)
    names = sorted(fmi_functions())
    check_library(library(target, exports(names)))
    with pytest.raises(ValueError, match=r"exports what FMI does not know: model_step$"):
        check_library(library(target, exports([*names, "model_step"])))
    with pytest.raises(ValueError, match=f"lacks functions of FMI: {names[0]}$"):
        check_library(library(target, exports(names[1:])))


@pytest.mark.parametrize(
    ("target", "name", "option"),
    [
        ("x86_64-linux", "PyErr_Clear", "-g0"),  # from nowhere
        ("x86_64-linux", "pthread_create", "-lpthread"),
        ("x86_64-windows", "MessageBeep", "-luser32"),
    ],
)
def test_imports_must_come_from_the_c_library(
    tmp_path: Path, target: str, name: str, option: str
) -> None:
    source = f"int {name}();\n" + exports(sorted(fmi_functions()), f"{name}();")
    library = library_on(tmp_path)(target, source, option, "-Wno-deprecated-non-prototype")
    with pytest.raises(ValueError, match=f"needs what is not in the C library: {name}$"):
        check_library(library)


def test_libraries_for_macos_on_arm_must_be_signed(tmp_path: Path) -> None:
    library = library_on(tmp_path)("aarch64-darwin", exports(sorted(fmi_functions())))
    whole = lief.MachO.parse(str(library))  # owns its part
    (part,) = whole
    part.remove_signature()
    part.write(str(library))
    with pytest.raises(ValueError, match="not signed"):
        check_library(library)


@pytest.mark.parametrize("target", TARGETS)
def test_what_an_object_needs_is_found_on_every_platform(tmp_path: Path, target: str) -> None:
    source = "double pow(double, double);\ndouble model_step(double x) { return pow(x, 1.1); }"
    data = compiled(tmp_path / "kernel.o", target, source, "-c", "-g0").read_bytes()
    assert needed_by_object(data) == {"pow"}


def test_a_runtime_that_does_not_compile_ends_the_build_with_the_compilers_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a compiler that takes long is explained."""
    monkeypatch.setattr(linking, "_PATIENCE_S", 0.0)
    runtime = tmp_path / "runtime"
    runtime.mkdir()
    (runtime / "broken.c").write_text("int broken(void) { return nothing; }\n")
    (tmp_path / "table.c").write_text("")
    compiled(tmp_path / "x86_64-linux.o", "x86_64-linux", "int model;", "-c")
    told: list[str] = []
    with pytest.raises(ValueError, match=r"(?s)linking for x86_64-linux failed:.*broken\.c:1"):
        link(tmp_path, runtime, "x86_64-linux", "Model", told.append)
    assert told == ["zig compiles the C library of x86_64-linux once"]


def test_the_functions_of_both_versions_are_known() -> None:
    names = fmi_functions()
    assert {"fmi2DoStep", "fmi3DoStep", "fmi2GetStringStatus", "fmi3GetClock"} <= names
    for version, name in ((2, "fmi2Instantiate"), (3, "fmi3InstantiateCoSimulation")):
        text = (HEADERS / f"fmi{version}Functions.h").read_text()
        assert f" {name};" in text
        declared = [line for line in text.splitlines() if f"FMI{version}_Export fmi" in line]
        assert len(declared) == len([n for n in names if n.startswith(f"fmi{version}")])


# The C runtime

FLOORS = (
    ("os", "page", "disk", "model", "text"),
    ("importer", "profile", "profile_history", "profile_undo", "prepared"),
    ("store", "older"),
    ("run", "learning", "outcome", "recording", "words"),
    ("session", "cluster", "values", "state"),
    ("calls", "fmi2", "fmi3"),
)


def test_the_runtime_has_floors() -> None:
    """A file includes headers of its own floor or of those below; the table is generated."""
    floor_of = {stem: floor for floor, stems in enumerate(FLOORS) for stem in stems}
    paths = sorted(RUNTIME.glob("*.[ch]"))
    stems = {path: re.sub("_(posix|windows|memory)$", "", path.stem) for path in paths}
    assert set(stems.values()) == set(floor_of)
    for path in paths:
        here = floor_of[stems[path]]
        for header in re.findall(r'#include "(\w+)\.h"', path.read_text(encoding="utf-8")):
            known = header == "table" or header.endswith(("Functions", "FunctionTypes"))
            assert known or floor_of[header] <= here, f"{path.name} includes {header}.h"
