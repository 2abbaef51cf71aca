# SPDX-License-Identifier: Apache-2.0
"""The command `polhode sweep`: many runs of a model file, one table."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from typing import TYPE_CHECKING, Any, Optional

from ._errors import ModelError
from ._text import Written

if TYPE_CHECKING:
    from ._model import Model

_EXAMPLES = """\
A parameter is a variable of the model or a path, and its values:
  --vary L=0.8,1,1.2            these values (grid)
  --vary bodies.rod.mass=1..3   from 1 to 3: -n equal steps (grid), or a range (sobol, lhs)
  --vary k=40+-2                mean and standard deviation (normal)

The table is CSV, or Parquet if its name ends with .parquet. Rows are stored in TABLE.rows as they are
computed; the same command continues a sweep that was stopped.
"""


class _Usage(Exception):
    """A fault of the command line."""


def _number(text: str, of: str) -> Any:
    """A number, or a text with its unit for values of a grid."""
    try:
        value = float(text)
    except ValueError:
        raise _Usage(f"--vary {of}: '{text}' is not a number. Write --vary L=0.8,1,1.2 or --vary L=0.8..1.2") from None
    return int(value) if value.is_integer() and text.lstrip("+-").isdigit() else value


def _parameter(text: str, method: str) -> "tuple[str, Any]":
    name, equals, values = text.partition("=")
    if not equals or not name or not values:
        raise _Usage(f"--vary {text}: write --vary NAME=VALUES, as in --vary L=0.8,1,1.2")
    kind, between = ("normal", "+-") if "+-" in values else ("range", "..") if ".." in values else ("list", ",")
    if kind == "list":
        if method != "grid":
            raise _Usage(f"--vary {text}: the method {method} requires "
                         + ("MEAN+-DEVIATION" if method == "normal" else "FROM..TO"))
        return name, [_number(v, text) for v in values.split(",")]
    if (kind == "normal") != (method == "normal"):
        raise _Usage(f"--vary {text}: MEAN+-DEVIATION requires --method normal, FROM..TO with the others")
    ends = values.split(between)
    if len(ends) != 2:
        raise _Usage(f"--vary {text}: write two numbers with '{between}' between them")
    return name, (_number(ends[0], text), _number(ends[1], text))


def _changes(texts: "list[str]", known: "dict[str, Any]") -> "dict[str, str]":
    """Changes of the model by path, from those of --set."""
    changes: "dict[str, str]" = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name:
            raise _Usage(f"--set {text}: write --set PATH=VALUE")
        changes[f"variables.{name}" if name in known else name] = Written(value)
    return changes


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="polhode sweep", description="Runs a model at many values of its parameters.",
                                     epilog=_EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", help="the model file")
    parser.add_argument("--vary", action="append", default=[], metavar="NAME=VALUES",
                        help="a parameter; may be repeated")
    parser.add_argument("-n", type=int, help="number of points; of a grid: steps of each range (5)")
    parser.add_argument("--method", choices=["grid", "sobol", "lhs", "normal"], default="grid")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE",
                        help="changes a value of the model in all runs; may be repeated")
    parser.add_argument("--output", action="append", default=[], metavar="CHANNEL",
                        help="a channel whose last values become columns, such as bodies.rod.position, or a measure: "
                        "max(CHANNEL), min, mean, rms, range, final, at(CHANNEL, TIME), first(CHANNEL > VALUE); a "
                        "vector's CHANNEL.size; probes.NAME.COLUMN; may be repeated")
    parser.add_argument("--gradient", action="append", default=[], metavar="OUTCOME",
                        help="an outcome such as bodies.rod.position.x@end, whose exact derivatives by the parameters "
                        "become columns; may be repeated")
    parser.add_argument("--plot", metavar="FILE", help="draws the outputs over one parameter, or as a map over two "
                        "(.svg, .png, .pdf)")
    parser.add_argument("-o", "--table", default="sweep.csv", help="the table (sweep.csv)")
    parser.add_argument("--jobs", "-j", type=int, help="number of parallel runs; default: one for each processor")
    parser.add_argument("--batch", action="store_true", help="several runs side by side in one system: faster for "
                        "small mechanisms with fixed steps; rows have outputs only")
    parser.add_argument("--dask", metavar="ADDRESS", help="runs on the workers of this Dask scheduler")
    parser.add_argument("--seed", type=int, default=0, help="of sobol, lhs and normal (0)")
    return parser


def main(arguments: "Optional[list[str]]" = None) -> int:
    """Runs the command; returns its exit status: 0, 1 if runs failed, 2 for a fault of model or usage."""
    given = _arguments().parse_args(arguments)
    try:
        return _sweep(given)
    except _Usage as error:
        print(f"polhode sweep: error: {error}", file=sys.stderr)
    except (ModelError, OSError) as error:
        print(error, file=sys.stderr)
    except ModuleNotFoundError as error:
        print(f"polhode sweep: error: {error.name} is missing; install it with 'pip install {error.name}'",
              file=sys.stderr)
    return 2


def _check_outcomes(model: Model, outcomes: "list[str]", paths: "list[str]", changes: "dict[str, Any]") -> None:
    """Raises ModelError for outcomes or parameters without gradient, by a run of one step."""
    from ._gradient import gradient

    step = model.analysis.get("step", "1 ms")
    once = {**changes, "analysis.duration": step}
    at_end = [f"{text.partition('@')[0]}@end" if _is_number(text.partition("@")[2]) else text for text in outcomes]
    gradient(model, at_end, paths, overrides=once, error_bars=False)


def _is_number(text: str) -> bool:
    try:
        return float(text) >= 0
    except ValueError:
        return False


def _sweep(given: argparse.Namespace) -> int:
    from ._measure import measure
    from ._model import load
    from ._run import run
    from ._sweep import sweep

    if not given.vary:
        raise _Usage("nothing varies; write --vary NAME=VALUES, as in --vary L=0.8,1,1.2")
    model = load(given.model)
    parameters = dict(_parameter(text, given.method) for text in given.vary)
    known = model.variables or {}
    parameters = {f"variables.{k}" if k in known else k: v for k, v in parameters.items()}
    if given.method != "grid" and given.n is None:
        raise _Usage(f"the method {given.method} requires -n, the number of points")
    changes = _changes(given.set, known)
    if both := sorted(set(changes) & set(parameters)):
        raise _Usage(f"'{both[0]}' is set and varies; give it to --set or to --vary")
    first = {**changes, **{k: v[0] for k, v in parameters.items()}}
    model.check(first)  # faults of all runs end the command at once
    if given.plot and len(parameters) > 2:
        raise _Usage(f"--plot draws over one or two parameters, and {len(parameters)} vary")
    if given.plot and not given.output and not given.gradient:
        raise _Usage("--plot requires --output, which says what is drawn")
    if given.output and model.analysis.get("type", "dynamics") == "dynamics":
        beginning = run(model, overrides={**first, "analysis.duration": "1e-9 s"}, progress=False)
        for text in given.output:
            try:
                measure(beginning, text)
            except (KeyError, ValueError) as error:
                raise _Usage(f"--output {text}: {error.args[0]}") from None
    if given.gradient:
        _check_outcomes(model, given.gradient, list(parameters), first)
    client: Any = None
    if given.dask:
        client = importlib.import_module("distributed").Client(given.dask)
    try:
        table = sweep(model, parameters, n=given.n, method=given.method, overrides=changes, outputs=given.output,
                      gradients=given.gradient, processes=given.jobs, resume=given.table + ".rows", seed=given.seed,
                      client=client, batch=given.batch)
    finally:
        if client is not None:
            client.close()
    whole = given.table + ".part"
    table.to_parquet(whole) if given.table.endswith(".parquet") else table.to_csv(whole, index=False)
    os.replace(whole, given.table)
    if given.plot:
        from ._sweep_plot import draw

        try:
            draw(table, list(parameters), given.plot)
        except ValueError as error:
            print(f"{given.plot}: {error}", file=sys.stderr)
    failed = int((table.message != "").sum())
    faults = f", {failed} of them failed: see the column message" if failed else ""
    print(f"{given.table}: {len(table)} runs{faults}")
    return 1 if failed else 0
