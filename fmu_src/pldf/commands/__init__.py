"""One module per command of ``pldf``, with ``EXAMPLE``, ``configure`` and ``run``.

The summaries stand here, so that ``pldf --help`` imports none of the modules.
"""

from typing import Final

# The order is that of ``pldf --help``.
COMMANDS: Final = {
    "build": "Build the FMUs and the study's SSP packages, of Python source or native.",
    "route": "Show a route: limits, curves and base profile of an OpenDRIVE or CSV file.",
    "script": "Show a driver or traffic script: what is done where or when, and for how long.",
    "drive": "Drive once with the coupled FMUs; write the recording and a picture of it.",
    "check": "Check roads, recordings, tables or whole studies: every problem at once.",
    "learn": "Learn from the recording of a drive (SPAA) and write the next profile.",
    "plot": "Draw recordings: speed over distance, interventions, pedals.",
    "profiles": "Show, export and roll back what was learned for drivers and routes.",
    "study": "Drive a study: the participants of a study file, or one driver with figures.",
    "cockpit": "Drive yourself: a page in the browser on the same FMUs, alone or as a desk study.",
    "analyse": "Analyse a study, real or simulated: rates, scores, tests, effect sizes, report.",
    "export": "Write a recording as Parquet or ASAM MDF4, with units.",
    "doctor": "Show what is installed, what is missing, and where FMUs, profiles and caches lie.",
    "cite": "Print how to cite the paper and this software, as BibTeX.",
}
