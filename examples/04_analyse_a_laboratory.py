"""Analyse the recordings of a laboratory: a folder with one file per participant and drive.

A laboratory delivers ``recordings/PARTICIPANT_PHASE.csv`` and perhaps a questionnaire. Here four
simulated people stand in for real ones: a small study of our own records all their drives, ten
times per second. You see shares of the time and scores with the base function (A) and with what was
learned (B), and Wilcoxon's test; with so few people it says little.

    python 04_analyse_a_laboratory.py                    # or name a folder of yours:
    python 04_analyse_a_laboratory.py FOLDER

Then, for tables and a report, with the path of the road that was driven:

    pldf analyse laboratory --route my_road.csv --report report.html
"""

import shutil
import sys
from pathlib import Path

import pldf

LABORATORY = Path("laboratory")
PEOPLE = ("P001", "P002", "P003", "P004")
STUDY = f"""
output = "simulated"
[participants]
count = {len(PEOPLE)}
seed = 1
[drives]
phases = ["A1", "A2", "B1", "B2"]
step_s = 0.1
[road]
route = "{Path(__file__).with_name("my_road.csv").as_posix()}"
[recordings]
participants = {list(PEOPLE)}
"""
# Boxes 1 (left) to 5 (right), as printed on the sheet; here everybody ticks the same.
ITEMS = ",".join(f"laan_{number}" for number in range(1, 10))
ANSWERS = {"A": "3,3,3,2,3,3,2,3,4", "B": "2,1,4,2,2,4,2,4,3"}


def make_a_laboratory() -> None:
    """Let the people drive; keep what instruments would have recorded, and their answers."""
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    results = pldf.run_study("study.toml", jobs=1)
    shutil.copytree(results / "recordings", LABORATORY / "recordings", dirs_exist_ok=True)
    rows = [f"{name},{system},{ANSWERS[system]}" for name in PEOPLE for system in ANSWERS]
    text = "\n".join((f"participant,system,{ITEMS}", *rows, ""))
    (LABORATORY / "questionnaire.csv").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if not sys.argv[1:]:
        make_a_laboratory()
    analysis = pldf.analyse(sys.argv[1] if sys.argv[1:] else LABORATORY)
    print(f"{len(analysis.participants)} participants: {', '.join(analysis.participants)}")
    print("measure                A       B   Wilcoxon")
    for name, compared in analysis.comparisons.items():
        means = f"{compared.mean_first:7.3f} {compared.mean_second:7.3f}"
        print(f"{name:16} {means}   p = {compared.signed_rank.p:.3f}")
