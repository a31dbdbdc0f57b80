"""FMUs as WebAssembly: what ``pldf build --wasm`` makes, and what it refuses to make."""

from __future__ import annotations

from pathlib import Path

import pytest
from fmpy import read_model_description
from native_hosts import MODELS
from pldf import cli
from pldf.build.native import web_assembly
from pldf.build.native.objects import compile_objects
from pldf.build.native.symbols import fmi_functions, needed_by_object
from pldf.build.native.wasm import LICENCES, PAGE, check_module
from pldf.build_version import build_version, native_making
from pldf.cosim.platforms import WASM


@pytest.mark.parametrize("model", MODELS)
def test_module_needs_nothing_and_offers_fmi_2_and_what_a_page_needs(
    model: str, wasm_folder: Path
) -> None:
    data = (wasm_folder / f"{model}.wasm").read_bytes()
    assert web_assembly.imports(data) == set()
    offered = web_assembly.exports(data)
    assert {"fmi2DoStep", "fmi2Instantiate"} <= fmi_functions([2])
    assert offered - {"__stack_pointer"} == fmi_functions([2]) | PAGE
    assert len(data) < 200_000


@pytest.mark.parametrize("model", MODELS)
def test_description_is_of_the_sources_installed(model: str, wasm_folder: Path) -> None:
    described = read_model_description(str(wasm_folder / f"{model}.xml"))
    assert described.fmiVersion == "2.0"
    assert described.modelName == model
    assert described.version == build_version()
    assert described.generationTool.endswith(native_making())
    assert described.guid.encode() in (wasm_folder / f"{model}.wasm").read_bytes()


def test_variables_are_those_of_the_native_fmus(wasm_folder: Path, native_folder: Path) -> None:
    for model in MODELS:
        described = [
            read_model_description(str(path))
            for path in (wasm_folder / f"{model}.xml", native_folder / f"{model}.fmu")
        ]
        ours, theirs = (
            [(v.name, v.valueReference, v.type, v.causality, v.start) for v in d.modelVariables]
            for d in described
        )
        assert ours == theirs


def test_same_sources_give_the_same_bytes(wasm_folder: Path, tmp_path: Path) -> None:
    arguments = ["--wasm", "--only", "LongitudinalVehicle", "--out", str(tmp_path)]
    assert cli.main(["build", *arguments]) == 0
    for suffix in (".wasm", ".xml"):
        name = f"LongitudinalVehicle{suffix}"
        assert (tmp_path / "wasm" / name).read_bytes() == (wasm_folder / name).read_bytes()


def test_licences_of_what_is_linked_are_beside_the_modules(wasm_folder: Path) -> None:
    text = (wasm_folder / LICENCES).read_text(encoding="utf-8")
    names = [line for line in text.splitlines() if line.startswith("# ")]
    assert names == [
        "# adaptive-pldf",
        "# zig, compiler-rt",
        "# wasi-libc",
        "# cloudlibc, in wasi-libc",
        "# musl, in wasi-libc",
    ]
    assert text.count("Permission is hereby granted") >= 4


def test_object_needs_only_what_c_has() -> None:
    data = compile_objects("vehicle_models.native:VEHICLE", [WASM])[WASM]
    assert web_assembly.is_module(data)
    assert "__linear_memory" in web_assembly.imports(data)
    assert needed_by_object(data) <= {"memcpy", "memmove", "memset"}


def module(imports: list[str], exports: list[str], size: int = 0) -> bytes:
    """Return the bytes of a module with functions of these names, as long as is asked for."""

    def part(data: bytes) -> bytes:
        length = len(data)
        lengths = [length & 0x7F]
        while length := length >> 7:
            lengths[-1] |= 0x80
            lengths.append(length & 0x7F)
        return bytes(lengths) + data

    def vector(rows: list[bytes]) -> bytes:
        return bytes([len(rows)]) + b"".join(rows)

    needed = vector([part(b"env") + part(name.encode()) + b"\0\0" for name in imports])
    given = vector([part(name.encode()) + b"\0\0" for name in exports])
    return b"".join(
        (b"\0asm\1\0\0\0", b"\2", part(needed), b"\7", part(given), b"\0", part(bytes(size)))
    )


def test_module_of_a_test_is_read_as_it_is_made() -> None:
    made = module(["a", "b"], ["c"], 300)
    assert web_assembly.imports(made) == {"a", "b"}
    assert web_assembly.exports(made) == {"c"}


COMPLETE = sorted(fmi_functions([2]) | PAGE)


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (module(["fd_write"], COMPLETE), "it needs what no page gives it: fd_write"),
        (module([], [*COMPLETE, "main"]), "it exports what a page does not know: main"),
        (module([], COMPLETE[:-1]), f"it lacks functions that a page calls: {COMPLETE[-1]}"),
        (module([], COMPLETE, 200_000), "are too many for a page"),
    ],
)
def test_module_that_would_not_run_in_a_page_is_refused(data: bytes, problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        check_module("Model", data)


def test_complete_module_is_not_refused() -> None:
    check_module("Model", module([], COMPLETE))


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--wasm", "--native"], "run pldf build twice"),
        (["--wasm", "--target", "linux64"], "--target goes with --native"),
        (["--wasm", "--ssp-sources", "ssp"], "no package has modules for a page"),
    ],
)
def test_options_that_do_not_fit_are_refused(
    arguments: list[str], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        cli.main(["build", *arguments])
    assert problem in capsys.readouterr().err
