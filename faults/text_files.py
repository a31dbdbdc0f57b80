"""Mutated text files: roads, scripts, recordings, studies are understood, or refused in words."""

from __future__ import annotations

import re
import signal
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from opendrive_text import SHAPES, geometry, lane, lanes, link, road, straight
from pldf.errors import ModelError
from pldf.recordings.recording import read_recording, recording_csv
from pldf.roads import RoadOptions, read_route, route_arrays
from pldf.study.participants_file import read_participants
from pldf.study.study_file import PACKAGED, read_study
from sample_recording import sample_recording

from vehicle_models.driver_script import packed_script, read_script

from .experiment import Counts, Experiment, Progress

TIME_MAX_S: Final = 30  # far above what any of these small files takes
NODES_MAX: Final = 20_000
_WORDS: Final = tuple(
    word.encode()
    for word in (
        "0", "1", "-1", "1e9", "1e300", "-1e300", "1e999", "nan", "inf", "-0.0", "1e-300",
        "9" * 40, "4294967296", "7", "100000", "0x10", "1_0", "1,5", "", " ", '"', "'", "#",
        "=1+1", "x" * 300, "\u00e9", "\ufeff", "\0", "\r", "\t", ";", "&amp;", "&#0;", "<road>",
        "</road>", "<!--", "-->", "<![CDATA[", "]]>", "<!DOCTYPE a [<!ENTITY b 'bbbb'>]>", "&b;",
        "[a]", "= [", "true", "'''",
    )
)  # fmt: skip

Reader = Callable[[Path], Any]


def mutated(good: bytes, rng: np.random.Generator) -> bytes:
    """Return ``good`` after one to three changes."""
    data = good
    for _ in range(rng.choice((1, 1, 2, 3))):
        change: Callable[[bytes, np.random.Generator], bytes] = _CHANGES[rng.choice(len(_CHANGES))]
        data = change(data, rng)
    return data


def _word(data: bytes, rng: np.random.Generator) -> bytes:
    words = list(re.finditer(rb"[\w.+-]+", data))
    if not words:
        return data
    word = words[rng.choice(len(words))]
    other = words[rng.choice(len(words))].group()
    new = other if rng.random() < 0.3 else _WORDS[rng.choice(len(_WORDS))]
    return data[: word.start()] + new + data[word.end() :]


def _bytes(data: bytes, rng: np.random.Generator) -> bytes:
    at, size = int(rng.integers(0, len(data) + 1)), int(rng.integers(0, 9))
    new = rng.integers(0, 256, rng.integers(0, 5)).astype(np.uint8).tobytes()
    return data[:at] + new + data[at + size :]


def _piece(data: bytes, rng: np.random.Generator) -> bytes:
    """Repeat a piece elsewhere, up to a hundred times."""
    begin, at = (int(rng.integers(0, len(data) + 1)) for _ in range(2))
    piece = data[begin : begin + int(rng.integers(1, 200))]
    return data[:at] + piece * int(rng.choice((1, 1, 2, 100))) + data[at:]


def _line(data: bytes, rng: np.random.Generator) -> bytes:
    lines = data.split(b"\n")
    at, to = (int(rng.integers(0, len(lines))) for _ in range(2))
    taken = lines[at] if rng.random() < 0.4 else lines.pop(at)
    if rng.random() < 0.7:
        lines.insert(to, taken)
    return b"\n".join(lines)


def _end(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: rng.integers(0, len(data) + 1)]


def _encoding(data: bytes, rng: np.random.Generator) -> bytes:
    text = data.decode("utf-8", errors="replace")
    return text.encode(rng.choice(("utf-16", "utf-32", "utf-8-sig", "latin-1")), errors="replace")


_CHANGES: Final = (_word, _word, _word, _word, _bytes, _piece, _line, _end, _encoding)


def _town(shape: str) -> bytes:
    """Return connected roads, one with this kind of geometry, and limits by lane."""
    plan = geometry(0, 100) + "\n" + geometry(100, 80, shape, 'x="100" y="0" hdg="0"')
    speed = lane('<speed sOffset="0" max="30" unit="mph"/>')
    sections = lanes(f'<laneSection s="0">{speed}</laneSection>')
    roads = (
        straight("1", -100.0, link=link("successor", "2", "start"), inside=sections),
        road("2", plan, length=180.0, link=link("predecessor", "1", "end")),
    )
    return ('<?xml version="1.0"?>\n<OpenDRIVE>\n' + "\n".join(roads) + "\n</OpenDRIVE>\n").encode()


def _read_road(path: Path) -> None:
    route = read_route(path, RoadOptions(start_road="1", default_limit_mps=20.0))
    if route.nodes < NODES_MAX and not all(np.isfinite(a).all() for a in route_arrays(route)):
        raise AssertionError(f"{path}: not finite")


def _sound() -> Iterator[tuple[str, bytes, Reader]]:
    """Yield the name of each kind of file, a sound one, and its reader."""
    for name, shape in SHAPES.items():
        yield f"{name}.xodr", _town(shape), _read_road
    yield (
        "road.csv",
        b"s_m,curvature_per_m,speed_limit_mps,grade,x_m,y_m\n"
        b"# a comment\n0,0,20,0,0,0\n20,0.01,20,0.02,20,0\n20,0.01,15,0,20,0\n40,0,15,0,40,1\n",
        _read_road,
    )
    yield "script.csv", packed_script(1).read_bytes(), read_script
    yield (
        "recording.csv",
        b"\n".join(recording_csv(sample_recording()).split(b"\n")[:40]),
        read_recording,
    )
    yield "study.toml", (PACKAGED / "paper.toml").read_bytes(), read_study
    yield (
        "participants.csv",
        b"participant,seed,wish.offset_mps\nP001,1,2.0\nP002,2,-1.5\n",
        read_participants,
    )


@contextmanager
def _watched() -> Iterator[None]:
    """End what hangs with a TimeoutError, where the system can do that."""

    def late(*_: object) -> None:
        raise TimeoutError(f"not done within {TIME_MAX_S} s")

    if not hasattr(signal, "setitimer"):
        yield
        return
    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, TIME_MAX_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def text_files(count: int, seed: int, progress: Progress) -> Counts:
    """Read mutated files of every kind that people write; what is refused names its file."""
    rng = np.random.default_rng(seed)
    kinds = list(_sound())
    found: Counter[str] = Counter(understood=0, refused=0, violations=0)
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        for name, good, read in kinds:
            Path(folder, name).write_bytes(good)
            read(Path(folder, name))
        for round_ in range(count):
            name, good, read = kinds[round_ % len(kinds)]
            path = Path(folder, name)
            path.write_bytes(mutated(good, rng))
            found[_answer(read, path)] += 1
            progress(round_ + 1)
    return dict(found)


def _answer(read: Reader, path: Path) -> str:
    try:
        with _watched():
            read(path)
    except ModelError as refusal:
        text = str(refusal)
        return "refused" if path.name in text and text.count("\n") < 2 else "violations"
    except Exception:
        return "violations"
    return "understood"


EXPERIMENTS: Final = (
    Experiment(
        "mutated_text_files",
        "A mutated road, script, recording or study is understood or refused with its name.",
        text_files,
        count=36_000,
        short=240,
    ),
)
