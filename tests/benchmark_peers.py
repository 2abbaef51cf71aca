#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The parts of benchmarks/peers that need no other program: definitions, references, tables."""

from __future__ import annotations

import math
import pathlib
import sys
import unittest
from typing import Any

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "benchmarks/peers"))

import cases  # noqa: E402
import mechanism as parts  # noqa: E402
import page  # noqa: E402
import references  # noqa: E402
import table  # noqa: E402


def size(a: parts.Vector) -> float:
    return math.sqrt(parts.dot(a, a))


class Definitions(unittest.TestCase):
    def test_velocities_agree_with_the_joints_at_the_start(self) -> None:
        for mechanism in cases.all_cases().values():
            for joint in mechanism.joints:
                with self.subTest(mechanism=mechanism.name, joint=joint.name):
                    (va, wa), (vb, wb) = (mechanism.motion(b, joint.at) for b in (joint.parent, joint.child))
                    speed, turning = parts.minus(vb, va), parts.minus(wb, wa)
                    if joint.kind == "prismatic":
                        along = parts.scaled(parts.dot(speed, joint.axes[0]), joint.axes[0])
                        self.assertLess(size(parts.minus(speed, along)), 1e-12)
                        self.assertLess(size(turning), 1e-12)
                        continue
                    self.assertLess(size(speed), 1e-12)
                    rest = turning
                    for axis in joint.axes if joint.kind != "spherical" else (parts.X, parts.Y, parts.Z):
                        rest = parts.minus(rest, parts.scaled(parts.dot(turning, axis), axis))
                    self.assertLess(size(rest), 1e-12)

    def test_every_body_hangs_on_one_joint_after_its_parent(self) -> None:
        for mechanism in cases.all_cases().values():
            seen = {parts.GROUND}
            for body in mechanism.bodies:
                carriers = [j for j in mechanism.joints if j.child == body.name and not j.closes]
                self.assertEqual(len(carriers), 1, f"{mechanism.name}: {body.name}")
                self.assertIn(carriers[0].parent, seen)
                seen.add(body.name)

    def test_axes_of_bodies_and_joints_are_orthonormal(self) -> None:
        for mechanism in cases.all_cases().values():
            for body in mechanism.bodies:
                columns = parts.transposed(body.axes)
                for i, a in enumerate(columns):
                    for j, b in enumerate(columns):
                        self.assertAlmostEqual(parts.dot(a, b), float(i == j), places=14)
            for joint in mechanism.joints:
                for axis in joint.axes:
                    self.assertAlmostEqual(size(axis), 1.0, places=14)

    def test_springs_of_the_governor_are_unstretched_and_its_slider_is_at_rest(self) -> None:
        governor = cases.flyball_governor()
        for spring in governor.springs:
            self.assertAlmostEqual(size(parts.minus(*spring.at)), spring.free_length, places=14)
        self.assertEqual(governor.body("slider").velocity, parts.ZERO)
        shaft = governor.body("shaft")
        self.assertAlmostEqual(parts.dot(shaft.angular_velocity, parts.Z), 2.0 * math.pi)

    def test_energy_of_the_four_bar_is_that_of_its_definition(self) -> None:
        cells = 7
        kinetic = potential = 0.0
        for body in cases.n_four_bar(cells).bodies:
            w = body.angular_velocity
            kinetic += 0.5 * body.mass * parts.dot(body.velocity, body.velocity) + 0.5 * body.inertia[2] * w[2] ** 2
            potential += body.mass * 9.81 * body.position[1]
        self.assertAlmostEqual(kinetic, (cells + 1) / 6.0 + cells / 2.0)
        self.assertAlmostEqual(potential, 9.81 * ((cells + 1) / 2.0 + cells))

    def test_loops_of_the_squeezer_close_in_one_point(self) -> None:
        """K2, K4 and K6 meet K3 at E: 28 mm, 20 mm and 20 mm from their own hinges F, G and H."""
        squeezer = cases.andrews_squeezer()
        for joint in squeezer.loops():
            hinge = squeezer.joint_of(joint.child).at
            self.assertAlmostEqual(
                size(parts.minus(joint.at, hinge)), 0.028 if joint.child == "K2" else 0.02, places=12
            )

    def test_links_of_a_ball_joint_have_the_whole_rate(self) -> None:
        links = cases.heavy_top().links()
        self.assertEqual([link.body is None for link in links], [True, True, False])
        total = parts.ZERO
        for link in links:
            total = parts.add(total, parts.scaled(link.rate, link.axis))
        self.assertLess(size(parts.minus(total, (0.0, 150.0, -4.61538))), 1e-12)
        self.assertAlmostEqual(links[-1].rate, 150.0)

    def test_every_case_has_a_reference_of_the_right_length(self) -> None:
        known = references.load()
        for name, mechanism in cases.all_cases().items():
            count = sum(1 if seen.joint else len(seen.components) for seen in mechanism.observed)
            self.assertEqual(len(known[name].value), count)
            self.assertLess(known[name].uncertainty, 1e-11)
            self.assertIn(name, table.WANTED)

    def test_closed_forms_lie_on_their_circles(self) -> None:
        for name in references.CLOSED:
            self.assertAlmostEqual(math.hypot(*references.load()[name].value), 1.0, places=11)


def head(program: str, version: str, absent: str = "", remarks: str = "") -> dict[str, Any]:
    return {"program": program, "case": "pendulum", "version": version, "absent": absent, "remarks": remarks}


def run_line(method: str, value: float, error: float | None, cpu: float) -> dict[str, Any]:
    line: dict[str, Any] = {"program": "Polhode", "case": "pendulum", "method": method, "value": value}
    return line | ({"failed": "unstable"} if error is None else {"error": error, "cpu_s": cpu})


class Tables(unittest.TestCase):
    def test_a_coarse_run_that_is_right_by_luck_does_not_count(self) -> None:
        runs = [run_line("a", 0.4, 1e-9, 0.001), run_line("a", 0.2, 1e-3, 0.002), run_line("a", 0.1, 1e-5, 0.004)]
        found = table.cheapest(runs, 1e-4)
        assert found
        self.assertEqual(found["value"], 0.1)
        self.assertIsNone(table.cheapest(runs, 1e-6))

    def test_a_failed_run_is_worse_than_any(self) -> None:
        runs = [run_line("a", 0.4, 1e-9, 0.001), run_line("a", 0.2, None, 0.0), run_line("a", 0.1, 1e-5, 0.004)]
        self.assertIsNone(table.cheapest(runs, 1e-6))

    def test_the_best_method_of_a_program_wins_and_what_is_absent_has_a_row(self) -> None:
        results = {
            "programs": [head("Polhode", "1", remarks="r"), head("Drake", "2", "no hinges")],
            "runs": [run_line("slow", 0.1, 1e-7, 0.02), run_line("fast", 0.5, 1e-6, 0.003)],
        }
        best = table.best(results, "pendulum", "Polhode", 1e-5)
        assert best
        self.assertEqual(best["method"], "fast")
        text = table.work_table(results, "pendulum")
        self.assertIn("no hinges", text)
        self.assertRegex(text, r"\| Polhode \| slow +\| 20 +\|")
        self.assertEqual(len({len(line) for line in text.splitlines()}), 1)
        self.assertEqual(table.remarks(results, "pendulum"), "Polhode: r.")
        self.assertEqual(table.versions(results), "Polhode 1, Drake 2")

    def test_a_method_that_reaches_no_error_of_the_table_says_what_it_reached(self) -> None:
        results = {
            "programs": [head("Polhode", "1")],
            "runs": [run_line("rough", 0.1, 0.3, 0.02), run_line("broken", 0.1, None, 0.0)],
        }
        text = table.work_table(results, "pendulum")
        self.assertIn("best error 3e-01", text)
        self.assertIn("no run succeeded", text)

    def test_a_program_without_runs_has_a_row(self) -> None:
        results = {"programs": [head("Polhode", "1"), head("Pinocchio", "4")], "runs": [run_line("a", 0.1, 1e-7, 0.02)]}
        self.assertIn("no run ended in its time", table.work_table(results, "pendulum"))

    def test_the_best_error_of_a_method_is_that_of_its_finest_run(self) -> None:
        runs = [run_line("a", 0.4, 1e-9, 0.001), run_line("a", 0.1, 1e-5, 0.004)]
        self.assertEqual(table.finest(runs)["error"], 1e-5)

    def test_a_section_is_replaced_between_its_comments_only(self) -> None:
        text = "a\n<!-- x: written by benchmarks/peers -->\nold\n<!-- end of x -->\nb\n"
        new = page.replaced(text, "x", "new")
        self.assertEqual(new, "a\n<!-- x: written by benchmarks/peers -->\n\nnew\n\n<!-- end of x -->\nb\n")
        with self.assertRaises(ValueError):
            page.replaced(text, "y", "new")


if __name__ == "__main__":
    unittest.main()
