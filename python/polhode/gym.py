# SPDX-License-Identifier: Apache-2.0
"""Environments of Gymnasium around a model, for reinforcement learning.

    import polhode.gym
    env = polhode.gym.make("cart_pole.yaml", actions=["cart"], action_limit=10, action_period=0.02,
                           reward=lambda sim, action: 1.0, terminated=lambda sim: abs(sim.q[1]) > 0.2, reset=0.05)
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

An action is an array of moments and forces along coordinates of joints, constant over a period of the simulation.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Callable, Optional, Union

import numpy as np

from . import _native
from ._model import Model, Overrides, load
from ._simulation import Simulation

try:
    import gymnasium
    from gymnasium.vector.utils import batch_space
except ModuleNotFoundError as _error:
    raise ModuleNotFoundError(
        "polhode.gym needs Gymnasium. Install it with: pip install 'polhode[gym]'", name=_error.name) from None

Reset = Union[None, float, Callable[[np.random.Generator], "tuple[Any, Any]"]]
_KEPT = ("q", "qd")


class Environment(gymnasium.Env[Any, Any]):
    """A model as an environment; `sim` is its Simulation, to be read and set. See make()."""

    metadata = {"render_modes": []}
    render_mode = None

    def __init__(
        self,
        simulation: Simulation,
        *,
        action_limit: Any,
        observation: "Optional[Callable[[Simulation], Any]]",
        reward: "Optional[Callable[[Simulation, Any], Any]]",
        terminated: "Optional[Callable[[Simulation], Any]]",
        action_period: float,
        max_time: float,
        reset: Reset,
    ) -> None:
        self.sim = simulation
        self.period, self.max_time = action_period, max_time
        self._observation, self._reward, self._terminated, self._reset = observation, reward, terminated, reset
        size = len(simulation.driven)
        limit = np.broadcast_to(np.asarray(action_limit, dtype=np.float32), (size,))
        self.action_space = gymnasium.spaces.Box(-limit, limit, dtype=np.float32)
        seen = self._observe()
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, seen.shape, dtype=np.float64)
        self._periods = 0

    def _observe(self) -> Any:
        if self._observation is not None:
            return np.array(self._observation(self.sim), dtype=np.float64)
        return np.concatenate([self.sim.q, self.sim.qd])

    def _info(self) -> "dict[str, Any]":
        return {"time": self.sim.time}

    def reset(self, *, seed: Optional[int] = None, options: "Optional[dict[str, Any]]" = None) -> "tuple[Any, Any]":
        """Begins an episode at the start of the model, changed as make() was told to; options q and qd are the
        coordinates and rates to begin with."""
        super().reset(seed=seed)
        given = options or {}
        if set(given) - set(_KEPT):
            raise ValueError(f"unknown options {', '.join(sorted(set(given) - set(_KEPT)))}; there are q and qd")
        q, qd = given.get("q"), given.get("qd")
        if q is None and qd is None and self._reset is not None:
            if callable(self._reset):
                q, qd = self._reset(self.np_random)
            else:
                self.sim.reset()
                n = len(self.sim.coordinates)
                q = self.sim.q + self.np_random.uniform(-self._reset, self._reset, n)
                qd = self.sim.qd + self.np_random.uniform(-self._reset, self._reset, n)
        self.sim.reset(q, qd)
        self._periods = 0
        return self._observe(), self._info()

    def _next(self) -> float:
        """End of the next period [s]."""
        self._periods += 1
        return self._periods * self.period

    def _after(self, action: Any, message: str) -> "tuple[float, bool, bool, dict[str, Any]]":
        info = self._info()
        if message:
            info["not_converged"] = message
        ended = self.sim.time >= self.max_time * (1 - 1e-9)
        return (
            0.0 if self._reward is None else float(self._reward(self.sim, action)),
            self._terminated is not None and bool(self._terminated(self.sim)),
            ended or bool(message),
            info,
        )

    def step(self, action: Any) -> "tuple[Any, float, bool, bool, dict[str, Any]]":
        """Applies an action [N m, N] for a period. A step that does not converge ends the episode as truncated; then
        info["not_converged"] says why."""
        self.sim.tau = action
        message = self.sim._engine.advance(self._next())
        return (self._observe(), *self._after(action, message))


class VectorEnvironment(gymnasium.vector.VectorEnv[Any, Any, Any]):
    """Environments side by side, which advance in threads: envs[i] is one. See make_vec().

    One that ended is reset by the next step, whose action is not used (AutoresetMode.NEXT_STEP).
    """

    metadata = {"render_modes": []}
    render_mode = None

    def __init__(self, envs: "list[Environment]", threads: int) -> None:
        self.envs = envs
        self.num_envs = len(envs)
        self.single_observation_space = envs[0].observation_space
        self.single_action_space = envs[0].action_space
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        mode = getattr(gymnasium.vector, "AutoresetMode", None)
        if mode is not None:
            self.metadata = {**self.metadata, "autoreset_mode": mode.NEXT_STEP}
        self._workers = _native.Workers(max(1, min(threads, self.num_envs)))
        self._ended = np.zeros(self.num_envs, dtype=bool)

    def reset(
        self,
        *,
        seed: "Union[None, int, Sequence[Optional[int]]]" = None,
        options: "Optional[dict[str, Any]]" = None,
    ) -> "tuple[Any, dict[str, Any]]":
        """Begins an episode in each environment. seed: that of the first, those of others follow; or a list."""
        n = self.num_envs
        seeds = [None] * n if seed is None else [seed + i for i in range(n)] if isinstance(seed, int) else list(seed)
        if len(seeds) != n:
            raise ValueError(f"{len(seeds)} seeds for {n} environments")
        rows: "list[Any]" = []
        infos: "dict[str, Any]" = {}
        for i, (env, one) in enumerate(zip(self.envs, seeds)):
            row, info = env.reset(seed=one, options=options)
            rows.append(row)
            infos = self._add_info(infos, info, i)
        self._ended[:] = False
        return np.stack(rows), infos

    def step(self, actions: Any) -> "tuple[Any, Any, Any, Any, dict[str, Any]]":
        """Applies an action to each environment. actions: (environments, actions)."""
        moving = [i for i in range(self.num_envs) if not self._ended[i]]
        given = np.asarray(actions, dtype=np.float64)
        messages, seen = self._workers.advance(
            [self.envs[i].sim._engine for i in moving], [self.envs[i]._next() for i in moving],
            np.ascontiguousarray(given[moving]), self.envs[0]._observation is None)
        rewards = np.zeros(self.num_envs)
        terminated, truncated = np.zeros(self.num_envs, dtype=bool), np.zeros(self.num_envs, dtype=bool)
        rows = np.empty((self.num_envs, *(self.single_observation_space.shape or ())))
        times: "list[float]" = [0.0] * self.num_envs
        infos: "dict[str, Any]" = {}
        for i in range(self.num_envs):
            if self._ended[i]:
                rows[i], info = self.envs[i].reset()
                times[i] = info["time"]
        for k, i in enumerate(moving):
            env = self.envs[i]
            rows[i] = env._observe() if env._observation is not None else seen[k]
            rewards[i], terminated[i], truncated[i], info = env._after(actions[i], messages[k])
            times[i] = info.pop("time")
            if info:
                infos = self._add_info(infos, info, i)
        infos.update({"time": np.array(times), "_time": np.ones(self.num_envs, dtype=bool)})
        self._ended = terminated | truncated
        return rows, rewards, terminated, truncated, infos


def _environments(
    model: "Union[Model, str, os.PathLike[str]]",
    count: int,
    *,
    actions: "Optional[Sequence[str]]" = None,
    action_limit: Any = 1.0,
    observation: "Optional[Callable[[Simulation], Any]]" = None,
    reward: "Optional[Callable[[Simulation, Any], Any]]" = None,
    terminated: "Optional[Callable[[Simulation], Any]]" = None,
    action_period: Optional[float] = None,
    max_time: Optional[float] = None,
    reset: Reset = None,
    overrides: Overrides = None,
) -> "list[Environment]":
    """Environments of a model, which is read once."""
    whole = model if isinstance(model, Model) else load(model)
    first = Simulation(whole, overrides, tau=True if actions is None else actions)
    period = first._compiled.step if action_period is None else float(action_period)
    if period is None:
        raise ValueError("The model has automatic steps: give an action_period [s].")
    if not period > 0:
        raise ValueError("action_period must be positive")
    if observation is None:
        _ = first.q  # copies share what is made here
    # Copies share the functions of loads, and a function in Python is not to be called from two threads at once.
    own = bool(whole._calls()[1])
    others = [Simulation(whole, overrides, tau=first.driven) if own else first.copy() for _ in range(count - 1)]
    return [
        Environment(sim, action_limit=action_limit, observation=observation, reward=reward, terminated=terminated,
                    action_period=period, max_time=first.end if max_time is None else float(max_time), reset=reset)
        for sim in (first, *others)
    ]


def make(
    model: "Union[Model, str, os.PathLike[str]]",
    *,
    actions: "Optional[Sequence[str]]" = None,
    action_limit: Any = 1.0,
    observation: "Optional[Callable[[Simulation], Any]]" = None,
    reward: "Optional[Callable[[Simulation, Any], Any]]" = None,
    terminated: "Optional[Callable[[Simulation], Any]]" = None,
    action_period: Optional[float] = None,
    max_time: Optional[float] = None,
    reset: Reset = None,
    overrides: Overrides = None,
) -> Environment:
    """Makes a gymnasium.Env of a model.

    actions:       names of coordinates that moments [N m] and forces [N] act along; all unless given. Other drives of
                   the model act besides.
    action_limit:  largest magnitude, one number or one for each action; actions are a Box of these.
    observation:   observation(sim) returns an array of numbers; [q, qd] unless given.
    reward:        reward(sim, action) after a period; zero unless given.
    terminated:    terminated(sim) after a period; never unless given.
    action_period: time for which an action is constant [s]; one step of the model unless given.
    max_time:      end of an episode [s], which is then truncated; the duration of the model unless given, so never
                   with `duration: none`.
    reset:         how episodes begin: at the start of the model; a number adds uniform noise up to it to q and qd;
                   reset(rng) returns q and qd, None for those of the start, with a NumPy generator.

    Raises ModelError for a faulty model or unknown actions.
    """
    return _environments(model, 1, actions=actions, action_limit=action_limit, observation=observation, reward=reward,
                         terminated=terminated, action_period=action_period, max_time=max_time, reset=reset,
                         overrides=overrides)[0]


def make_vec(model: "Union[Model, str, os.PathLike[str]]", n: int, *, threads: Optional[int] = None,
             **settings: Any) -> VectorEnvironment:
    """Makes a gymnasium VectorEnv of n environments that advance in threads, one for each processor unless given.

    Other arguments are those of make(). All numbers are equal, bit for bit, to those of single environments, with any
    number of threads. observation, reward and terminated are called one after the other, not in the threads.
    """
    return VectorEnvironment(_environments(model, n, **settings), threads or os.cpu_count() or 1)
