"""Build the FMUs: ``python build_fmu.py ...`` is ``pldf build ...``."""

import sys

from pldf.cli import main

if __name__ == "__main__":
    sys.exit(main(["build", *sys.argv[1:]]))
