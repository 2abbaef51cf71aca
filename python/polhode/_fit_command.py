# SPDX-License-Identifier: Apache-2.0
"""The command `polhode fit`: parameters of a model file from tables of measurements."""

from __future__ import annotations

import argparse
import csv
import json
import os
import re
import shlex
import sys
import warnings
from typing import Any, Optional

import numpy as np

from . import _native
from ._errors import ModelError, NotConverged
from ._text import Written

_EXAMPLES = """\
A parameter is a variable of the model or a path, with its first guess:
  --with k=36,c=1.2             two variables
  --with bodies.rod.mass=1.2    a number by its path
  --bound k=10..100  --prior c=1+-0.2  --deviation bodies.rod.position.z=0.005

A table of measurements is CSV with a header: a column 't [s]' or 'time', and columns named after channels, such as
'bodies.rod.position.z [m]', as `polhode convert RESULTS table.csv` writes them. Several tables are several runs.
"""
_HEADER = re.compile(r"\s*(.+?)\s*(?:\[(.*)\])?\s*")


class _Usage(Exception):
    """A fault of the command line or of a table."""


def _pairs(texts: "list[str]", option: str, form: str) -> "dict[str, str]":
    """NAME=VALUE of an option that may be repeated or list several."""
    found = {}
    for text in ",".join(texts).split(",") if texts else ():
        name, equals, value = text.partition("=")
        if not equals or not name or not value:
            raise _Usage(f"{option} {text}: write {option} {form}")
        found[name.strip()] = value
    return found


def _number(text: str, where: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise _Usage(f"{where}: '{text.strip()}' is not a number") from None


def _two(text: str, between: str, where: str) -> "tuple[float, float]":
    ends = text.split(between)
    if len(ends) != 2:
        raise _Usage(f"{where}: write two numbers with '{between}' between them")
    return _number(ends[0], where), _number(ends[1], where)


def _table(path: str) -> "tuple[dict[str, Any], dict[str, str]]":
    """Columns of a table, time as "time", and their units."""
    with open(path, newline="", encoding="utf-8-sig") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].lstrip().startswith("#")]
    if len(rows) < 2:
        raise _Usage(f"{path}: has no rows below a header")
    names, units = [], {}
    for cell in rows[0]:
        match = _HEADER.fullmatch(cell)
        name = match.group(1) if match else cell
        name = "time" if name in ("t", "time") else name
        if name in names:
            raise _Usage(f"{path}:1: the column '{name}' is there twice")
        names.append(name)
        if match and match.group(2) is not None:
            units[name] = match.group(2)
    if "time" not in names:
        raise _Usage(f"{path}:1: no column is named 't [s]' or 'time'")
    for number, row in enumerate(rows[1:], 2):
        if len(row) != len(names):
            raise _Usage(f"{path}:{number}: has {len(row)} cells, the header {len(names)}")
    columns = {name: np.array([_number(row[k], f"{path}: column '{name}'") for row in rows[1:]])
               for k, name in enumerate(names)}
    return columns, units


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="polhode fit", epilog=_EXAMPLES,
                                     description="Estimates parameters of a model from measurements.",
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", help="the model file")
    parser.add_argument("tables", nargs="+", metavar="TABLE", help="measurements of a run as CSV")
    parser.add_argument("--with", dest="guesses", action="append", default=[], metavar="NAME=GUESS",
                        help="a parameter; several with commas, or repeated")
    parser.add_argument("--bound", action="append", default=[], metavar="NAME=FROM..TO", help="range of a parameter")
    parser.add_argument("--prior", action="append", default=[], metavar="NAME=MEAN+-DEVIATION",
                        help="what is known of a parameter before; requires --deviation")
    parser.add_argument("--deviation", action="append", default=[], metavar="CHANNEL=SIZE",
                        help="standard deviation of a measured channel; all channels or none")
    parser.add_argument("--channel", action="append", default=[], metavar="CHANNEL",
                        help="a column that is used; default: all")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="changes a value of the model")
    parser.add_argument("--jacobian", choices=["auto", "exact", "differences", "adjoint"], default="auto",
                        help="derivatives; auto: exact, or differences of runs for a model that has no gradient")
    parser.add_argument("--plot", metavar="FILE", help="draws measured and computed channels (.svg, .png, .pdf)")
    parser.add_argument("--json", action="store_true", help="prints one JSON object")
    return parser


def main(arguments: "Optional[list[str]]" = None) -> int:
    """Runs the command; returns its exit status: 0, 2 for a fault of model, tables or usage, 4 if runs fail."""
    given = _arguments().parse_args(arguments)
    try:
        return _fit(given)
    except _Usage as error:
        print(f"polhode fit: error: {error}", file=sys.stderr)
    except NotConverged as error:
        print(error, file=sys.stderr)
        return 4
    except BrokenPipeError:  # a reader such as `head` has enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (ModelError, OSError, KeyError, ValueError) as error:
        print(f"polhode fit: error: {error.args[0] if isinstance(error, KeyError) else error}", file=sys.stderr)
    except ModuleNotFoundError as error:
        print(f"polhode fit: error: {error.name} is missing; install it with 'pip install {error.name}'",
              file=sys.stderr)
    return 2


def _experiments(given: argparse.Namespace, overrides: "dict[str, Any]", model: Any) -> "list[Any]":
    """Measured channels of each table, checked against the model's results."""
    from ._fit import Experiment
    from ._measure import series, unit_of
    from ._run import run

    short = run(model, overrides={**overrides, "analysis.duration": "1e-9 s"}, progress=False)
    motion = re.compile(r"bodies\..*\.(position|velocity|angular_velocity)\.[xyz]|joints\..*\.coordinates(\.\d+)?"
                        r"|probes\..*\.[^.]+")
    experiments = []
    for path in given.tables:
        columns, units = _table(path)
        if units.get("time", "s") != "s":
            raise _Usage(f"{path}:1: time is in {units['time']}; convert it to s")
        others = [name for name in columns if name != "time"]
        names = given.channel or [name for name in others if motion.fullmatch(name)] or others
        if not names:
            raise _Usage(f"{path}:1: has no column beside the time")
        if left := [name for name in others if name not in names and not given.channel]:
            print(f"{path}: {len(left)} columns are no positions or velocities and are left out, such as {left[0]}; "
                  "name them with --channel to use them", file=sys.stderr)
        for name in names:
            if name not in columns:
                near = _native.closest(name, list(columns))
                raise _Usage(f"{path}:1: has no column '{name}'" + (f". Did you mean '{near}'?" if near else ""))
            found = series(short, name)[1]
            unit = unit_of(short, name)
            if found.ndim > 1 and found.shape[1] != 1:
                raise _Usage(f"{path}:1: '{name}' is a vector; name a component")
            if name in units and units[name] not in (unit, *unit.split(" or ")):
                raise _Usage(f"{path}:1: '{name}' is in {units[name]}; convert it to {unit}")
        experiments.append(Experiment({"time": columns["time"], **{name: columns[name] for name in names}}, overrides))
    return experiments


def _fit(given: argparse.Namespace) -> int:
    from ._fit import fit
    from ._model import load

    if not given.guesses:
        raise _Usage("nothing is fitted; write --with NAME=GUESS, as in --with k=36,c=1.2")
    model = load(given.model)
    known = model.variables or {}

    def path_of(name: str) -> str:
        return f"variables.{name}" if name in known else name

    guesses = {path_of(k): _number(v, f"--with {k}") for k, v in _pairs(given.guesses, "--with", "NAME=GUESS").items()}
    bounds = {path_of(k): _two(v, "..", f"--bound {k}")
              for k, v in _pairs(given.bound, "--bound", "NAME=FROM..TO").items()}
    priors = {path_of(k): _two(v, "+-", f"--prior {k}")
              for k, v in _pairs(given.prior, "--prior", "NAME=MEAN+-DEVIATION").items()}
    deviations = {k: _number(v, f"--deviation {k}")
                  for k, v in _pairs(given.deviation, "--deviation", "CHANNEL=SIZE").items()}
    overrides: "dict[str, Any]" = {}
    for text in given.set:
        name, equals, value = text.partition("=")
        if not equals:
            raise _Usage(f"--set {text}: write --set PATH=VALUE")
        overrides[name] = Written(value)
    for name in bounds:
        if name not in guesses:
            raise _Usage(f"--bound {name}: is not among the parameters of --with")
    if model.analysis.get("type", "dynamics") != "dynamics":
        raise _Usage(f"{given.model} has no motion in time to compare: its analysis is of type "
                     f"'{model.analysis.get('type')}'")
    model.check({**overrides, **guesses})
    experiments = _experiments(given, overrides, model)

    way, why = ("exact", "") if given.jacobian == "auto" else (given.jacobian, "")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = fit(model, experiments, guesses, bounds=bounds, jacobian=way, deviations=deviations, priors=priors)
        except ModelError as error:
            if given.jacobian != "auto":
                raise
            way, why = "differences", str(error).strip().splitlines()[0]
            found = fit(model, experiments, guesses, bounds=bounds, jacobian=way, deviations=deviations, priors=priors)
    said = list(dict.fromkeys(str(w.message) for w in caught if issubclass(w.category, UserWarning)))
    if given.plot:
        import matplotlib

        matplotlib.use("Agg")
        found.plot().savefig(given.plot)
    _print(found, way, why, said, given)
    return 0


def _misfits(found: Any, deviations: "dict[str, float]") -> "dict[str, float]":
    """Root mean square of the residuals of each channel, in its unit."""
    squares: "dict[str, list[Any]]" = {}
    first = 0
    for e in found.experiments:
        for name in e.data:
            if name == "time":
                continue
            count = np.asarray(e.data[name]).size
            own = found.residuals[first:first + count] * deviations.get(name, 1.0)
            squares.setdefault(name, []).append(own * own)
            first += count
    return {name: float(np.sqrt(np.mean(np.concatenate(parts)))) for name, parts in squares.items()}


def _print(found: Any, way: str, why: str, said: "list[str]", given: argparse.Namespace) -> None:
    from ._measure import unit_of

    deviations = {k: float(v) for k, v in _pairs(given.deviation, "--deviation", "").items()}
    misfits, errors = _misfits(found, deviations), found.errors

    def finite(value: Any) -> Any:
        """A number, or null in JSON."""
        if isinstance(value, list):
            return [finite(v) for v in value]
        return value if np.isfinite(value) else None

    names = list(found.parameters)
    if given.json:
        print(json.dumps({"parameters": found.parameters, "errors": {k: finite(v) for k, v in errors.items()},
                          "covariance": finite(found.covariance.tolist()),
                          "singular_values": found.singular_values.tolist(), "residuals": misfits, "runs": found.runs,
                          "converged": found.converged, "jacobian": way, "warnings": said}, indent=2))
        return
    width = max(len(name) for name in [*names, *misfits])
    for name in names:
        print(f"{name:{width}}  {found.parameters[name]:.8g} +- {errors[name]:.2g}")
    table = np.abs(found.correlation - np.eye(len(names)))
    if len(names) > 1 and np.all(np.isfinite(table)):
        i, j = np.unravel_index(int(np.argmax(table)), table.shape)
        print(f"largest correlation {found.correlation[i, j]:.3f}: {names[min(i, j)]}, {names[max(i, j)]}")
    print("root mean square of what is left:")
    for name, size in misfits.items():
        print(f"{name:{width}}  {size:.3g} {unit_of(found.result, name)}")
    print(f"{found.runs} runs, derivatives: {way}" + (f", because {why}" if why else ""))
    for line in said:
        print(f"warning: {line}", file=sys.stderr)
    chosen = [*given.set, *(f"{k}={v:.10g}" for k, v in found.parameters.items())]
    print(shlex.join(["polhode", "run", given.model, *(word for text in chosen for word in ("--set", text))]))
