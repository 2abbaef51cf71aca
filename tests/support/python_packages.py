# SPDX-License-Identifier: Apache-2.0
"""Python packages of a test: those of this Python, or of a virtual environment under build/ for the test alone."""
import importlib.util
import pathlib
import subprocess
import sys
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]


def need(*packages):
    """Runs the script again in a virtual environment with packages that are missing here.

    packages: names of modules, which pip knows by the same names.
    Ends the script: with that run's exit code, or with 77, skipped, if they cannot be installed.
    """
    missing = [name for name in packages if importlib.util.find_spec(name) is None]
    if not missing:
        return
    place = ROOT / "build" / "test-environments" / pathlib.Path(sys.argv[0]).stem
    if pathlib.Path(sys.prefix) == place:
        print(f"Skipped: {', '.join(missing)} cannot be imported.")
        sys.exit(77)
    python = place / "bin/python"
    try:
        if not python.exists():
            venv.create(place, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *packages], check=True)
    except (subprocess.CalledProcessError, OSError) as fault:
        print(f"Skipped: {', '.join(missing)} cannot be installed: {fault}.")
        sys.exit(77)
    sys.exit(subprocess.run([python, *sys.argv]).returncode)
