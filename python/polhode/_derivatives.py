# SPDX-License-Identifier: Apache-2.0
"""Derivatives of results by numbers of their model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union, overload

import numpy as np

from ._errors import fault
from ._gradient import Gradient, Source, gradients, pulled_back, tangents

if TYPE_CHECKING:
    from ._fit import Fit


class Uncertainty:
    """Standard deviations of channels over time, to first order in the deviations of parameters.

    time (T,) [s]; values, deviation: by channel, each (T, components) or (T,), in SI units; units: of these;
    parts: by channel and parameter, the deviation of the channel if that parameter alone were uncertain, with the sign
    of its derivative.
    """

    def __init__(self, time: Any, values: "dict[str, Any]", deviation: "dict[str, Any]",
                 parts: "dict[str, dict[str, Any]]", units: "dict[str, str]") -> None:
        self.time, self.values, self.deviation, self.parts, self.units = time, values, deviation, parts, units

    def plot(self) -> Any:
        """Draws each channel with a band of two standard deviations, a panel for each. Returns the figure."""
        from matplotlib import pyplot

        figure, panels = pyplot.subplots(len(self.values), 1, sharex=True, squeeze=False, layout="constrained")
        for panel, (name, value) in zip(panels[:, 0], self.values.items()):
            several = value.ndim > 1 and value.shape[1] > 1
            rows, bands = value.reshape(len(value), -1).T, self.deviation[name].reshape(len(value), -1).T
            for row, band, number in zip(rows, bands, components(name, len(rows))):
                axis = number.rpartition(".")[2] if several else ""
                (line,) = panel.plot(self.time, row, label=axis or None)
                panel.fill_between(self.time, row - 2 * band, row + 2 * band, color=line.get_color(), alpha=0.25)
            panel.set_ylabel(f"{name} [{self.units[name]}]")
            if several:
                panel.legend(loc="best", fontsize="small")
        panels[-1, 0].set_xlabel("time [s]")
        return figure

    def __repr__(self) -> str:
        rows = [f"{name:40} {np.max(deviation):.6g}" for name, deviation in self.deviation.items()]
        return "\n".join(["largest standard deviation over time", *rows])


def components(channel: str, count: int) -> "list[str]":
    """Names of the numbers of a channel of results."""
    if channel.endswith(".coordinates"):
        return [f"{channel}.{k}" for k in range(count)]
    return [channel] if count == 1 else [f"{channel}.{axis}" for axis in "xyz"[:count]]


class Differentiable:
    """Derivatives of a run by numbers of its model.

    Exact for the steps of the run, which is computed anew for them: docs/how_to/gradients.md says for which models.
    """

    _origin: Optional[Source] = None

    def _source(self) -> Source:
        if self._origin is None:
            raise fault("", "opened results have no derivatives: a file does not hold the functions of a model",
                        "Run the model with polhode.run, or use polhode.gradient")
        return self._origin

    def _channel(self, name: str) -> Any:
        """A channel as (frames, ...)."""
        return np.asarray(self[name])  # type: ignore[index]

    def _numbers_of(self, channel: str) -> "tuple[list[str], tuple[int, ...]]":
        """Names of the numbers of a channel, and its shape without frames."""
        if channel.startswith("probes."):
            return [channel], ()
        shape = self._channel(channel).shape[1:]
        return components(channel, int(np.prod(shape, dtype=int))), shape

    @overload
    def gradient(self, of: str, wrt: "Union[str, Sequence[str]]", *, forward: Optional[bool] = ...,
                 error_bars: bool = ...) -> Gradient: ...
    @overload
    def gradient(self, of: "list[str]", wrt: "Union[str, Sequence[str]]", *, forward: Optional[bool] = ...,
                 error_bars: bool = ...) -> "list[Gradient]": ...

    def gradient(self, of: "Union[str, list[str]]", wrt: "Union[str, Sequence[str]]", *,
                 forward: Optional[bool] = None, error_bars: bool = True) -> "Union[Gradient, list[Gradient]]":
        """Derivatives of outcomes of this run by parameters of its model, as polhode.gradient computes them."""
        outcomes = [of] if isinstance(of, str) else list(of)
        paths = [wrt] if isinstance(wrt, str) else list(wrt)
        found = gradients(self._source(), outcomes, paths, forward, error_bars)
        return found[0] if isinstance(of, str) else found

    def push_forward(self, change: "Mapping[str, float]", channels: "Sequence[str]") -> "dict[str, Any]":
        """First-order change of channels over time, if parameters change: by channel, in its shape.

        change:   by path, as overrides: {"bodies.rod.mass": 0.01, "gravity.2": -0.1}.
        channels: positions and velocities: "bodies.rod.position", "joints.A.coordinates", "probes.tip.x".

        One tangent for each parameter. Frames must be step ends. Raises ModelError for what has no gradient.
        """
        slopes = self._tangents(list(change), channels)
        factors = np.array(list(change.values()), dtype=float)
        return {name: by @ factors for name, (_, by) in slopes.items()}

    def pull_back(self, weights: "Mapping[str, Any]", wrt: "Union[str, Sequence[str]]") -> "dict[str, float]":
        """Derivative by parameters of the sum over frames and channels of weight times value.

        weights: by channel, each in the shape of the channel: {"bodies.rod.position": w (T, 3)}. With the derivative
                 of a cost by its channels the result is the derivative of the cost by the parameters.
        wrt:     parameters by path.

        One adjoint, however many parameters. Frames must be step ends. Raises ModelError for what has no gradient,
        ValueError for weights of another shape.
        """
        paths = [wrt] if isinstance(wrt, str) else list(wrt)
        times = np.asarray(self.time)  # type: ignore[attr-defined]
        if not weights or not paths:
            raise ValueError("pull_back needs weights of a channel, and parameters")
        names: "list[str]" = []
        columns: "list[Any]" = []
        for channel, given in weights.items():
            found, shape = self._numbers_of(channel)
            array = np.asarray(given, dtype=float)
            if array.shape != (len(times), *shape):
                raise ValueError(f"the weights of '{channel}' have the shape {array.shape}, the channel "
                                 f"{(len(times), *shape)}")
            names += found
            columns.append(array.reshape(len(times), -1))
        slopes = pulled_back(self._source(), names, times, np.hstack(columns), paths)
        return dict(zip(paths, slopes.tolist()))

    def uncertainty(self, deviations: "Union[Mapping[str, float], Fit]", channels: "Sequence[str]", *,
                    correlation: Any = None) -> Uncertainty:
        """Standard deviations of channels over time that follow from those of parameters, to first order.

        deviations:  standard deviations by path: {"bodies.rod.mass": 0.01}, or a Fit: its estimates with their
                     covariance.
        channels:    positions and velocities, as in push_forward.
        correlation: (p, p), in the order of `deviations`; None: independent. Not with a Fit.

        Raises ModelError for what has no gradient, ValueError for a correlation of another shape, or that is none.
        """
        from ._measure import unit_of

        if isinstance(deviations, Mapping):
            paths, sizes = list(deviations), np.array(list(deviations.values()), dtype=float)
            joint = np.eye(len(paths)) if correlation is None else np.asarray(correlation, dtype=float)
            if joint.shape != (len(paths), len(paths)) or not np.allclose(joint, joint.T) or \
                    not np.allclose(np.diag(joint), 1) or np.min(np.linalg.eigvalsh(joint)) < -1e-9:
                raise ValueError(f"correlation must be a correlation matrix of {len(paths)} parameters")
            covariance = joint * np.outer(sizes, sizes)
        else:
            if correlation is not None:
                raise ValueError("a Fit has its own covariance; leave out correlation")
            paths, covariance = list(deviations.parameters), np.asarray(deviations.covariance)
            sizes = np.sqrt(np.diag(covariance))
            if not np.all(np.isfinite(covariance)):
                raise ValueError("the data of the fit do not determine all its parameters, so nothing follows from it")
        values, spread, parts = {}, {}, {}
        for name, (value, by) in self._tangents(paths, channels).items():
            values[name] = value
            spread[name] = np.sqrt(np.maximum(0.0, np.einsum("...i,ij,...j->...", by, covariance, by)))
            parts[name] = {path: by[..., k] * sizes[k] for k, path in enumerate(paths)}
        units = {name: unit_of(self, name) for name in values}  # type: ignore[arg-type]
        return Uncertainty(np.asarray(self.time), values, spread, parts, units)  # type: ignore[attr-defined]

    def _tangents(self, paths: "list[str]", channels: "Sequence[str]") -> "dict[str, tuple[Any, Any]]":
        """Values (T, ...) and derivatives (T, ..., parameters) of channels."""
        wanted = [channels] if isinstance(channels, str) else list(channels)
        parts = [(channel, *self._numbers_of(channel)) for channel in wanted]
        times = np.asarray(self.time)  # type: ignore[attr-defined]
        values, by = tangents(self._source(), [name for _, names, _ in parts for name in names], times, paths)
        found, first = {}, 0
        for channel, names, shape in parts:
            last = first + len(names)
            found[channel] = (values[:, first:last].reshape(len(times), *shape),
                              by[:, first:last].reshape(len(times), *shape, len(paths)))
            first = last
        return found
