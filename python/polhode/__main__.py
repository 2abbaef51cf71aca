# SPDX-License-Identifier: Apache-2.0
"""The command `polhode`: the program of the package."""

import os
import sys


def main() -> None:
    """Replaces this process by the program, with the same arguments; sweeps and fits run in Python."""
    if sys.argv[1:2] == ["sweep"]:
        from ._sweep_command import main as sweep

        sys.exit(sweep(sys.argv[2:]))
    if sys.argv[1:2] == ["fit"]:
        from ._fit_command import main as fit

        sys.exit(fit(sys.argv[2:]))
    os.environ.setdefault("POLHODE_PYTHON", sys.executable)  # for `convert` to .parquet
    program = os.path.join(os.path.dirname(__file__), "bin", "polhode")
    os.execv(program, ["polhode", *sys.argv[1:]])


if __name__ == "__main__":
    main()
