// SPDX-License-Identifier: Apache-2.0
// Spheres that fall into a bin: n spheres of 0.1 m radius and 1 kg, friction 0.5, no rebound, 3 s
// in steps of 2 ms. Prints processor time per step (whole run; last second), contacts, the largest
// penetration, the largest rise of the energy in a step and the largest speed at the end.
//
//   benchmark_contact_bin [n] [side m, 0: by n] [residual / weight] [tolerance m] [duration s]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

#include <polhode/contact/contact_set.hpp>
#include <polhode/solve/crowd_engine.hpp>
#include <polhode/solve/lanes/dispatch.hpp>
#include <polhode/solve/single_step.hpp>

using namespace polhode;

namespace {

constexpr double kRadius = 0.1, kStep = 2e-3;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void fill(System& system, contact::ContactSet& contacts, int n, double side) {
  const int row = static_cast<int>(std::floor((side - 0.21) / 0.22)) + 1;
  const double x0 = -0.11 * (row - 1);
  for (int i = 0; i < n; ++i) {
    BodyData body;
    body.name = "sphere " + std::to_string(i);
    body.mass = 1.0;
    body.inertia = Mat3::Identity() * (0.4 * kRadius * kRadius);
    BodyMotion start;
    start.r = {x0 + 0.22 * (i % row) + 0.005 * std::sin(12.9898 * i),
               x0 + 0.22 * ((i / row) % row) + 0.005 * std::sin(78.233 * i),
               0.12 + 0.22 * (i / (row * row)) + 0.005 * std::sin(37.719 * i)};
    contacts.add_shape(
        {system.add_body(body, start), body.name, contact::sphere(body.name, 2.0 * kRadius)});
  }
  const auto wall = [&](const char* name, const Vec3& normal, double distance) {
    contact::ShapePlace place;
    place.axes = Quat::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    place.origin = -distance * normal;
    contacts.add_shape({kGround, name, contact::plane(place)});
  };
  wall("floor", Vec3::UnitZ(), 0.0);
  wall("west", Vec3::UnitX(), 0.5 * side);
  wall("east", -Vec3::UnitX(), 0.5 * side);
  wall("south", Vec3::UnitY(), 0.5 * side);
  wall("north", -Vec3::UnitY(), 0.5 * side);
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int k, double otherwise) {
    return argc > k ? std::atof(argv[k]) : otherwise;
  };
  const int n = static_cast<int>(number(1, 1000));
  double side = number(2, 0.0);
  if (side <= 0.0) side = 0.25 * std::ceil(std::sqrt(n / 4.0));
  const double residual = number(3, 1e-3), tolerance = number(4, 5e-4), duration = number(5, 3.0);

  System system;
  system.set_gravity({0.0, 0.0, -9.81});
  const auto contacts = std::make_shared<contact::ContactSet>();
  fill(system, *contacts, n, side);
  contact::ContactLaw law;
  law.friction.mu = 0.5;
  law.tolerance = tolerance;
  contacts->set_default(law);
  system.set_contacts(contacts);
  system.finish();
  State state = system.initial_state();
  state.dt_next = kStep;
  auto owned = std::make_unique<CrowdEngine>(system, residual);
  const CrowdEngine& engine = *owned;
  SingleStep single(system, std::move(owned), GeneralizedAlpha::from_spectral_radius(1.0),
                    lane_kernels("automatic"), true);
  single.ledger().begin(state);
  NewtonOptions options;
  options.tolerance = 1e-9;
  options.max_iterations = 60;
  options.line_search = false;

  double spent = 0.0, spent_late = 0.0, deepest = 0.0, rise = 0.0, energy = 1e300, touching = 0.0;
  long iterations = 0, iterations_late = 0, inner_late = 0;
  int steps = 0, late = 0, cuts = 0;
  while (state.t < duration - 1e-9) {
    const double before = processor_seconds();
    const long inner = engine.inner_iterations();
    double left = kStep, h = kStep;
    int used = 0;
    while (left > 1e-9 * kStep) {
      h = std::min(h, left);
      const NewtonReport report = single.take(state, h, options, {1, false});
      used += report.iterations;
      if (report.converged) {
        left -= h;
        continue;
      }
      ++cuts;
      h *= 0.5;
      if (h < 1e-4 * kStep) {
        std::printf("failed at t = %g: %s\n", state.t, report.text().c_str());
        return 1;
      }
    }
    const double took = processor_seconds() - before;
    spent += took;
    ++steps;
    iterations += used;
    if (state.t > duration - 1.0) {
      spent_late += took;
      iterations_late += used;
      inner_late += engine.inner_iterations() - inner;
      ++late;
    }
    const Balance balance = single.ledger().balance(state);
    rise = std::max(rise, balance.kinetic + balance.potential - energy);
    energy = balance.kinetic + balance.potential;
    touching = 0.0;
    for (const contact::ShapePairReport& r : contacts->reports()) {
      deepest = std::max(deepest, -r.gap);
      touching += r.normal_force > 0.0 ? 1.0 : 0.0;
    }
  }
  double fastest = 0.0;
  for (int b = 0; b < n; ++b) fastest = std::max(fastest, system.motion(state, b).v.norm());
  std::printf(
      "{\"spheres\": %d, \"side\": %g, \"residual\": %g, \"tolerance\": %g, \"ms\": %.2f, "
      "\"ms_last_second\": %.2f, \"newton\": %.2f, \"newton_last_second\": %.2f, "
      "\"cg_last_second\": %.1f, \"contacts\": %.0f, \"penetration\": %.2e, \"energy_rise\": "
      "%.1e, \"speed_end\": %.1e, \"cuts\": %d}\n",
      n, side, residual, tolerance, 1e3 * spent / steps, 1e3 * spent_late / std::max(1, late),
      static_cast<double>(iterations) / steps,
      static_cast<double>(iterations_late) / std::max(1, late),
      static_cast<double>(inner_late) / std::max(1, late), touching, deepest, rise, fastest, cuts);
}
