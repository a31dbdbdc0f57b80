"""The fault campaign: every promise of docs/reliability.md, tried hard and counted.

    make faults                                   all of it, about 10 minutes on 2 cores
    python faults/campaign.py --list              what there is
    python faults/campaign.py --only NAME         one experiment (may be given several times)
    python faults/campaign.py --scale 10          ten times as many rounds, over night

Prints one JSON: per experiment its promise, rounds, seconds and what was counted. The exit status
is 1 if a promise was broken. Ctrl-C ends it with what is done.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from pkgutil import iter_modules
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "support")]  # as in the tests

from pldf import __version__  # noqa: E402 - it is found by now
from pldf.commands.shared.progress import progress_bar  # noqa: E402

from faults import built  # noqa: E402
from faults.experiment import Experiment  # noqa: E402

SEED: Final = 1
Watch = Callable[[str], None]


def experiments() -> list[Experiment]:
    """Return those of all modules of this folder, in the order of their files."""
    found = []
    for module in sorted(iter_modules([str(ROOT / "faults")])):
        if module.name != "campaign":
            found += getattr(import_module(f"faults.{module.name}"), "EXPERIMENTS", ())
    return found


def do(experiment: Experiment, rounds: int, seed: int) -> dict[str, Any]:
    """Run one experiment; one that cannot go on has broken its promise, too."""
    begin_s = time.monotonic()
    try:
        counts = experiment.run(rounds, seed, lambda _: None)
        failed = {}
    except Exception as error:
        counts, failed = {"violations": 1}, {"ended_by": f"{type(error).__name__}: {error}"}
    return {
        "promise": experiment.promise,
        "rounds": rounds,
        "seconds": round(time.monotonic() - begin_s, 1),
        **failed,
        "counts": counts,
    }


def campaign(
    chosen: Sequence[Experiment], scale: float, seed: int, processes: int, watch: Watch
) -> dict[str, dict[str, Any]]:
    """Run ``chosen`` in as many processes; return what came out by name, in their order.

    ``watch`` hears the name of each that has ended. After Ctrl-C the others are left out.
    """
    results: dict[str, dict[str, Any]] = {}
    pool = ProcessPoolExecutor(processes, get_context("spawn"), _begin, _folders())
    jobs = {
        pool.submit(_named, experiment.name, max(round(experiment.count * scale), 1), seed): (
            experiment
        )
        for experiment in chosen
    }
    try:
        for job in as_completed(jobs):
            results[jobs[job].name] = job.result()
            watch(jobs[job].name)
    except KeyboardInterrupt:
        print("campaign: ended before its end; what is done follows", file=sys.stderr)
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
    return {e.name: results[e.name] for e in chosen if e.name in results}


def _folders() -> tuple[Path, Path]:
    return built.folder("python"), built.folder("native")


def _begin(python: Path, native: Path) -> None:
    built.use(python, native)


def _named(name: str, rounds: int, seed: int) -> dict[str, Any]:
    """Run the experiment of that name: its functions need not travel between processes."""
    return do(next(e for e in experiments() if e.name == name), rounds, seed)


def report(results: dict[str, dict[str, Any]], seed: int) -> dict[str, Any]:
    """Return what ``make faults`` prints."""
    return {
        "version": __version__,
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
        "seed": seed,
        "violations": sum(result["counts"]["violations"] for result in results.values()),
        "experiments": results,
    }


def table(outcome: dict[str, Any]) -> str:
    """Return the rows of docs/reliability.md that say what was tried."""
    return "\n".join(
        f"| `{name}` | {result['promise']} | {_tried(result['counts'])} "
        f"| {result['counts']['violations']:g} |"
        for name, result in outcome["experiments"].items()
    )


def _tried(counts: dict[str, float]) -> str:
    shown = (
        f"{value:,.0f} {name.replace('_', ' ')}" if value == int(value) else f"{name} {value:.4g}"
        for name, value in counts.items()
        if name != "violations"
    )
    return ", ".join(shown)


def build_fmus(folder: Path) -> None:
    """Build what experiments drive and let them."""
    from pldf.cli import main as pldf  # noqa: PLC0415 - slow to import, --list needs none

    sink, sys.stdout = sys.stdout, sys.stderr  # the JSON stays alone
    try:
        for kind in ((), ("--native", "--target", "linux64")):
            if pldf(["build", *kind, "--out", str(folder)]):
                sys.exit(1)
    finally:
        sys.stdout = sink
    built.use(folder, folder / "native")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the campaign, print the JSON, return the exit status."""
    options = _options(arguments)
    if options.table:
        print(table(json.loads(options.table.read_bytes())))
        return 0
    known = experiments()
    if options.list:
        print("\n".join(f"{e.name:32} {e.count:7}  {e.promise}" for e in known))
        return 0
    chosen = [e for e in known if not options.only or e.name in options.only]
    if unknown := set(options.only or ()) - {e.name for e in chosen}:
        print(f"campaign: no experiment {', '.join(sorted(unknown))}; see --list", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="faults_") as folder:
        build_fmus(Path(folder))
        with progress_bar("fault campaign", len(chosen), "experiments") as bar:

            def watch(name: str) -> None:
                bar.update(bar.task_ids[0], advance=1, description=f"fault campaign: {name}")

            results = campaign(chosen, options.scale, options.seed, options.jobs, watch)
    text = json.dumps(report(results, options.seed), indent=2)
    print(text)
    if options.out:
        options.out.write_text(text + "\n", encoding="utf-8")
    broken = list(_broken(results))
    for line in broken:
        print(f"campaign: BROKEN: {line}", file=sys.stderr)
    return 1 if broken or len(results) < len(chosen) else 0


def _broken(results: dict[str, dict[str, Any]]) -> Iterator[str]:
    for name, result in results.items():
        if result["counts"]["violations"]:
            yield f"{name}: {result.get('ended_by', result['promise'])}"


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", metavar="NAME", action="append", help="this experiment alone")
    parser.add_argument("--scale", metavar="X", type=float, default=1.0, help="rounds times X (1)")
    parser.add_argument("--seed", metavar="N", type=int, default=SEED, help=f"chance ({SEED})")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count(), help="processes")
    parser.add_argument("--out", metavar="JSON", type=Path, help="write the JSON there, too")
    parser.add_argument(
        "--table", metavar="JSON", type=Path, help="print the rows of docs/reliability.md"
    )
    parser.add_argument("--list", action="store_true", help="list the experiments")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
