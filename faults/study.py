"""Studies whose processes are killed, whose disk is full, and whose parts are damaged."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any, Final

import psutil
from laboratory import files
from pldf import cli
from pldf.files.disk import replace_file
from pldf.study import results
from pldf.study.runner import in_processes
from pldf.study.study_file import read_study
from pldf.study.unit import Job
from small_study import opened, write_study

from faults.experiment import Counts, Experiment, Progress

_PEOPLE: Final = 30
# Far more than any of this takes: who needs longer hangs.
_HANGS_S: Final = 120.0
# Within this time a process ends with the study that it drove for.
_OUTLIVES_S: Final = 30.0


def _undisturbed(folder: Path, people: int) -> tuple[Path, dict[str, bytes]]:
    """Return a study file, and the files of its study when nothing goes wrong."""
    study = write_study(folder, people)
    assert _quietly(["study", str(study), "--out", str(folder / "good"), "--jobs", "1"])[0] == 0
    return study, files(folder / "good")


def _quietly(arguments: list[str]) -> tuple[int, str]:
    """Run ``pldf`` in this process; return exit status and what it told."""
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()) as told:
        status = cli.main(arguments)
    return status, told.getvalue()


def kills(count: int, seed: int, progress: Progress) -> Counts:
    """Kill the study, or one of its processes, at random moments; let it go on; compare."""
    chance = random.Random(seed)
    counts: Counts = dict.fromkeys(
        ("kills_of_all", "kills_of_one", "resumed", "left_over", "hung", "violations"), 0
    )
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        study, good = _undisturbed(folder, _PEOPLE)
        for round_ in range(count):
            out = folder / f"out{round_}"
            command = ["study", str(study), "--out", str(out), "--jobs", "2"]
            _disturb(command, chance, counts)
            try:
                again = subprocess.run(
                    [sys.executable, "-m", "pldf", *command],
                    capture_output=True, timeout=_HANGS_S, check=False,
                )  # fmt: skip
                counts["resumed"] += 1
                counts["violations"] += again.returncode != 0 or files(out) != good
            except subprocess.TimeoutExpired:
                counts["hung"] += 1
            progress(round_ + 1)
    counts["violations"] += counts["left_over"] + counts["hung"]
    return counts


def _disturb(command: list[str], chance: random.Random, counts: Counts) -> None:
    """Begin a study, kill what chance says, wait for its end."""
    main = subprocess.Popen(
        [sys.executable, "-m", "pldf", *command],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    watched = psutil.Process(main.pid)
    # From before the first of its processes to where all of them drive, and a little later.
    stage, deadline_s = chance.randint(0, 4), time.monotonic() + _HANGS_S
    while len(_below(watched)) < stage and main.poll() is None and time.monotonic() < deadline_s:
        time.sleep(0.002)
    time.sleep(chance.uniform(0.0, 0.1))
    seen = _below(watched)
    if seen and chance.random() < 0.7:
        counts["kills_of_one"] += 1
        with suppress(psutil.NoSuchProcess):
            chance.choice(seen).kill()
        try:
            main.wait(_HANGS_S)
        except subprocess.TimeoutExpired:
            counts["hung"] += 1
    else:
        counts["kills_of_all"] += 1
    seen = list({*seen, *_below(watched)})
    main.kill()
    main.wait()
    _, alive = psutil.wait_procs(seen, timeout=_OUTLIVES_S)
    counts["left_over"] += len(alive)
    for process in alive:
        process.kill()


def _below(main: psutil.Process) -> list[psutil.Process]:
    """Return what drives for a study: the process that forks, and those that it has forked."""
    try:
        return main.children(recursive=True)
    except psutil.NoSuchProcess:
        return []


def full_disk(count: int, seed: int, progress: Progress) -> Counts:
    """Let the disk be full, or the process end, at a random file; go on, or restart; compare."""
    chance = random.Random(seed)
    violations = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        people = 4
        study, good = _undisturbed(folder, people)
        writes = len(good) - 1 + people
        try:
            for round_ in range(count):
                out = folder / f"out{round_}"
                command = ["study", str(study), "--out", str(out), "--jobs", "1"]
                for _ in range(chance.randint(1, 3)):
                    results.replace_file = _failing_at(chance.randint(1, writes), chance)  # type: ignore[attr-defined]
                    with suppress(_Killed):
                        status, told = _quietly(command)
                        # Exit 0: it went so far before that fewer files were left to write.
                        violations += status not in (0, 1) or (
                            status == 1 and "No space" not in told
                        )
                results.replace_file = replace_file  # type: ignore[attr-defined]
                more = chance.choice(([], ["--restart"]))
                violations += _quietly([*command, *more])[0] != 0 or files(out) != good
                progress(round_ + 1)
        finally:
            results.replace_file = replace_file  # type: ignore[attr-defined]
    return {"studies": count, "violations": violations}


class _Killed(BaseException):
    """The process is no more."""


def _failing_at(number: int, chance: random.Random) -> Callable[[Path, bytes], None]:
    failure = chance.choice((OSError(28, "No space left on device"), _Killed()))
    calls = iter(range(1, 1_000_000))

    def replace(path: Path, data: bytes) -> None:
        if next(calls) == number:
            # What a kill leaves in the middle of a file.
            if isinstance(failure, _Killed):
                path.with_name(f"{path.name}.tmp").write_bytes(data[: len(data) // 2])
            raise failure
        replace_file(path, data)

    return replace


def damaged_parts(count: int, seed: int, progress: Progress) -> Counts:
    """Damage the parts of a study; none may get into its tables, and each is kept aside."""
    chance = random.Random(seed)
    told_parts = violations = 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        file, good = _undisturbed(folder, 2)
        study = read_study(file)
        driven = list(in_processes(1)(Job(study.settings), list(study.participants)))
        for round_ in range(count):
            out = folder / f"out{round_}"
            opened_folder = opened(study, out)
            for result in driven:
                opened_folder.keep(result)
            part = out / "parts" / "P001.json"
            part.write_bytes(damage := _mutated(part.read_bytes(), chance))
            status, told = _quietly(["study", str(file), "--out", str(out), "--jobs", "1"])
            after = files(out)
            aside = after.pop("damaged/P001-1.json", None)
            told_parts += aside is not None
            violations += status != 0 or (after != good) or (aside is not None and aside != damage)
            violations += (aside is not None) != ("P001 is driven anew" in told)
            progress(round_ + 1)
    return {"damaged_parts": count, "told": told_parts, "violations": violations}


def _mutated(data: bytes, chance: random.Random) -> bytes:
    """Return ``data`` with a damage that can be seen: a number that is another one cannot."""
    rows: list[list[Any]] = json.loads(data)
    row = chance.choice(rows)
    at = chance.randrange(len(row))
    damages: tuple[Callable[[], bytes], ...] = (
        lambda: data[: chance.randrange(len(data))],
        lambda: chance.randbytes(chance.randint(0, 300)),
        lambda: data + b"]",
        lambda: json.dumps(rows[1:]).encode(),
        lambda: json.dumps(rows[::-1]).encode(),
        lambda: json.dumps([*rows, row]).encode(),
        lambda: json.dumps([[*r[:at], None, *r[at + 1 :]] for r in rows]).encode(),
        lambda: json.dumps([[*r[:at], *r[at + 1 :]] for r in rows]).encode(),
        lambda: data.replace(b"P001", b"P002"),
        lambda: data[: len(data) // 2] + os.fsencode("\xff") + data[len(data) // 2 :],
        lambda: data.replace(b"[[", b"[" * chance.randint(3, 50_000), 1),
    )
    return chance.choice(damages)()


EXPERIMENTS = (
    Experiment(
        "study_kills",
        "A study whose processes are killed at any moment neither hangs nor leaves a process "
        "behind, and goes on to the same bytes.",
        kills,
        count=40,
        short=2,
    ),
    Experiment(
        "study_full_disk",
        "A study that a full disk or a kill stopped at any file goes on, or restarts, to the same "
        "bytes.",
        full_disk,
        count=60,
        short=3,
    ),
    Experiment(
        "study_damaged_parts",
        "A damaged part of a study is told, kept aside, driven anew, and never in a table.",
        damaged_parts,
        count=120,
        short=4,
    ),
)
