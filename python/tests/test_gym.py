# SPDX-License-Identifier: Apache-2.0
"""Environments for reinforcement learning."""

import time
import warnings
from typing import Any

import numpy as np
import pytest

import polhode

pytest.importorskip("gymnasium")

import polhode.gym  # noqa: E402

G = 9.81


def cart_pole(**keys: Any) -> polhode.Model:
    """A cart of 1 kg on a rail along x, with a rod of 1 m and 0.1 kg that stands on it."""
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 2, "step": "5 ms"}, **keys)
    cart = m.add_body("cart", mass=1, inertia=[0.01, 0.01, 0.01])
    pole = m.add_body("pole", mass=0.1, inertia=[0.1 / 12, 0.1 / 12, 1e-4], position=[0, 0, 0.5])
    m.add_joint("rail", "prismatic", ["ground", cart], at=[0, 0, 0], axis="x")
    m.add_joint("pivot", "revolute", [cart, pole], at=[0, 0, 0], axis="y")
    return m


def settings() -> "dict[str, Any]":
    return {
        "actions": ["rail"], "action_limit": 10.0, "action_period": 0.02, "reset": 0.05,
        "reward": lambda sim, action: 1.0 - 1e-3 * float(action[0]) ** 2,
        "terminated": lambda sim: abs(sim.q[1]) > 0.2 or abs(sim.q[0]) > 2.4,
    }


def test_an_environment_passes_the_checker() -> None:
    from gymnasium.utils.env_checker import check_env

    cases: "list[dict[str, Any]]" = [{}, {"observation": lambda sim: [sim.q[1], sim.bodies["pole"].position[2]]}]
    for more in cases:
        env = polhode.gym.make(cart_pole(), **settings(), **more)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.filterwarnings("ignore", message=".*(spec|unbounded|infinity|render|normalized).*")
            check_env(env, skip_render_check=True)
        assert env.action_space.contains(np.array([10], np.float32))
        assert not env.action_space.contains(np.array([11], np.float32))


def balance(observation: Any) -> Any:
    """Forces that balance the pole: state feedback with poles at about -2 to -4 / s."""
    x, angle, speed, rate = observation
    return np.clip([30 * angle + 8 * rate + 1.5 * x + 3 * speed], -10, 10).astype(np.float32)


def test_a_feedback_balances_the_pole_and_none_lets_it_fall() -> None:
    env = polhode.gym.make(cart_pole(), **settings())
    lengths, rewards = [], []
    for act in (balance, lambda _: np.zeros(1, dtype=np.float32)):
        observation, info = env.reset(seed=3)
        assert info == {"time": 0.0} and np.abs(observation).max() <= 0.05 and np.abs(observation).max() > 0
        total, steps, done = 0.0, 0, False
        while not done:
            observation, reward, terminated, truncated, info = env.step(act(observation))
            total, steps, done = total + reward, steps + 1, terminated or truncated
            assert info["time"] == pytest.approx(steps * 0.02, abs=1e-12)
        lengths.append((steps, terminated, truncated))
        rewards.append(total)
    assert lengths[0] == (100, False, True) and np.abs(observation[1]) > 0.2
    assert lengths[1][0] < 100 and lengths[1][1:] == (True, False)
    assert rewards[1] == pytest.approx(lengths[1][0]) and 90 < rewards[0] < 100


def test_the_start_of_an_episode_is_chosen() -> None:
    env = polhode.gym.make(cart_pole(), actions=["rail"])
    assert np.array_equal(env.reset()[0], np.zeros(4))
    observation, _ = env.reset(options={"q": [0.5, 3.0], "qd": [1.0, 0.0]})
    assert observation == pytest.approx([0.5, 3, 1, 0], abs=1e-12)
    with pytest.raises(ValueError, match="unknown options v"):
        env.reset(options={"v": 1})
    env = polhode.gym.make(cart_pole(), reset=lambda rng: ([rng.uniform(1, 2), 0], None), max_time=0.01)
    first = [env.reset(seed=seed)[0] for seed in (1, 2, 1)]
    assert 1 < first[0][0] < 2 and np.array_equal(first[0], first[2]) and not np.array_equal(first[0], first[1])
    assert env.action_space.shape == (2,)
    assert [env.step(np.zeros(2))[2:4] for _ in range(2)] == [(False, False), (False, True)]


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_environments_side_by_side_have_the_numbers_of_single_ones(threads: int) -> None:
    n, rng = 7, np.random.default_rng(0)
    actions = rng.uniform(-10, 10, (60, n, 1)).astype(np.float32)
    many = polhode.gym.make_vec(cart_pole(), n, threads=threads, **settings())
    single = [polhode.gym.make(cart_pole(), **settings()) for _ in range(n)]
    seen, _ = many.reset(seed=11)
    ended = [False] * n
    assert many.observation_space.contains(seen)
    for i, env in enumerate(single):
        assert np.array_equal(seen[i], env.reset(seed=11 + i)[0])
    resets = 0
    for step in actions:
        seen, rewards, terminated, truncated, infos = many.step(step)
        for i, env in enumerate(single):
            if ended[i]:
                expected = (env.reset()[0], 0.0, False, False)
                resets += 1
            else:
                expected = env.step(step[i])[:4]
            assert np.array_equal(seen[i], expected[0]) and rewards[i] == expected[1]
            assert (terminated[i], truncated[i]) == expected[2:]
            ended[i] = terminated[i] or truncated[i]
        assert infos["time"] == pytest.approx([env.sim.time for env in single], abs=0)
    assert resets > 3


def test_loops_turn_side_by_side() -> None:
    m = polhode.Model(gravity=[0, 0, -G], analysis={"duration": 10, "step": "2 ms"})
    for name, x in (("crank", 0), ("coupler", 0.5), ("rocker", 1)):
        m.add_body(name, mass=1, inertia=[0.01, 0.05, 0.05], position=[x, 0, 0.5 if name == "coupler" else 0.25])
    ends = [("A", "ground", "crank", 0, 0), ("B", "crank", "coupler", 0, 0.5), ("C", "coupler", "rocker", 1, 0.5),
            ("D", "rocker", "ground", 1.1, 0)]
    for name, a, b, x, z in ends:
        m.add_joint(name, "revolute", [a, b], at=[x, 0, z], axis="y")
    many = polhode.gym.make_vec(m, 6, threads=3, actions=["A"], action_limit=20, reset=0.3)
    single = polhode.gym.make(m, actions=["A"], action_limit=20, reset=0.3)
    seen, other = many.reset(seed=5)[0], single.reset(seed=8)[0]
    assert seen.shape == (6, 2)
    for k in range(100):
        seen, other = many.step(np.full((6, 1), 20 - k))[0], single.step(np.array([20.0 - k]))[0]
        assert np.array_equal(seen[3], other)


def test_functions_in_python_act_side_by_side() -> None:
    model = cart_pole()
    model.add_load("wind", "force", body="pole", at=[0, 0, 1], force=lambda t: [0.3 * np.sin(5 * t), 0, 0])
    many = polhode.gym.make_vec(model, 4, threads=4, actions=["rail"], reset=0.1)
    single = polhode.gym.make(model, actions=["rail"], reset=0.1)
    seen, _ = many.reset(seed=5)
    other, _ = single.reset(seed=7)
    for _ in range(40):
        seen, other = many.step(np.ones((4, 1)))[0], single.step(np.ones(1))[0]
        assert np.array_equal(seen[2], other)


def test_a_step_without_solution_ends_the_episode() -> None:
    m = cart_pole()
    m.add_load("wall", "linear_motor", joint="rail", force=lambda t: float("nan") if t > 0.1 else 0.0)
    env = polhode.gym.make(m, actions=["pivot"], action_period=0.05)
    env.reset()
    ends = [env.step(np.zeros(1)) for _ in range(3)]
    assert not ends[0][3] and ends[2][3] and "not a finite number" in ends[2][4]["not_converged"]


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(polhode.ModelError, match="'rial' is not a coordinate"):
        polhode.gym.make(cart_pole(), actions=["rial"])
    with pytest.raises(ValueError, match="action_period"):
        polhode.gym.make(cart_pole(), action_period=0)
    automatic = cart_pole()
    automatic.analysis.step = None
    with pytest.raises(ValueError, match="automatic steps"):
        polhode.gym.make(automatic)
    with pytest.raises(TypeError):
        polhode.gym.make_vec(cart_pole(), 2, actoins=["rail"])
    many = polhode.gym.make_vec(cart_pole(), 2)
    with pytest.raises(ValueError, match="3 seeds for 2"):
        many.reset(seed=[1, 2, 3])
    many.reset()
    with pytest.raises(ValueError):
        many.step(np.zeros((2, 3)))


def test_other_threads_run_while_environments_step() -> None:
    import threading

    many = polhode.gym.make_vec(cart_pole(), 2, threads=2, action_period=20.0, max_time=1e6)
    many.reset()
    ticks = 0
    going = True

    def tick() -> None:
        nonlocal ticks
        while going:
            ticks += 1
            time.sleep(1e-4)

    thread = threading.Thread(target=tick)
    thread.start()
    before = ticks
    many.step(np.zeros((2, 2)))
    during = ticks - before
    going = False
    thread.join()
    assert during > 0
