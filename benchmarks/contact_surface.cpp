// SPDX-License-Identifier: Apache-2.0
// A ball and a crate that go over height fields of up to 1e5 triangles, flat and wavy: 0.1 m and 1
// kg, 2 m/s, friction 0.3, steps of 1 ms. Prints processor time per step (median of rounds of 50
// steps, and the mean) and Newton iterations. What is far away should cost nothing.
//
//   benchmark_contact_surface [steps]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include <contact/scene.hpp>

#include "measure.hpp"

using namespace polhode;
using namespace polhode::test;

namespace {

constexpr double kStep = 1e-3, kSide = 4.5;
constexpr int kRound = 50;

struct Task {
  const char* body;
  const char* surface;
  int cells;  ///< In a row.
};

void measure(const Task& task, int steps) {
  const double cell = kSide / task.cells;
  const double height = std::string(task.surface) == "wavy" ? 0.02 : 0.0;
  std::vector<double> z;
  for (int j = 0; j <= task.cells; ++j)
    for (int i = 0; i <= task.cells; ++i)
      z.push_back(height * std::sin(2.0 * std::numbers::pi * cell * i) *
                  std::cos(2.0 * std::numbers::pi * cell * j));
  Scene s;
  const BodyMotion start = at({-1.8, 0.013, 0.11 + height}, {2.0, 0.1, 0.0});
  if (std::string(task.body) == "ball")
    s.add_ball("ball", 0.1, 1.0, start);
  else
    s.add_box("crate", {0.3, 0.2, 0.2}, 1.0, start);
  s.contacts->add_shape(
      {kGround, "ground", geometry::height_field("ground", task.cells + 1, cell, z)});
  s.law(0.3, 0.0, 1e-5);
  s.begin(kStep);
  std::vector<double> rounds;
  const double all = benchmark::thread_cpu();
  bool good = true;
  for (int k = 0; k < steps / kRound && good; ++k) {
    const double before = benchmark::thread_cpu();
    good = s.run(kRound * kStep);
    rounds.push_back(1e3 * (benchmark::thread_cpu() - before) / kRound);
  }
  std::printf(
      "{\"body\": \"%s\", \"surface\": \"%s\", \"triangles\": %d, \"ms\": %.4f, \"ms_mean\": %.4f, "
      "\"newton\": %.2f, \"solved\": %s}\n",
      task.body, task.surface, 2 * task.cells * task.cells, benchmark::median(rounds),
      1e3 * (benchmark::thread_cpu() - all) / std::max(1, s.steps),
      static_cast<double>(s.iterations) / std::max(1, s.steps), good ? "true" : "false");
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::max(kRound, std::atoi(argv[1])) : 1000;
  for (const char* body : {"ball", "crate"})
    for (const char* surface : {"flat", "wavy"})
      for (const int cells : {22, 71, 224}) measure({body, surface, cells}, steps);
}
