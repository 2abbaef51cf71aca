// SPDX-License-Identifier: Apache-2.0
// Spheres that fall into a bin: n spheres of 0.1 m radius and 1 kg, friction 0.5, no rebound, 3 s
// in steps of 2 ms. Prints processor time per step (whole run; last second), contacts, the largest
// penetration, the largest rise of the energy in a step and the largest speed at the end.
//
//   benchmark_contact_bin [n] [side m, 0: by n] [residual / weight] [tolerance m] [duration s]
//   benchmark_contact_bin nonsmooth [n] [side m] [sweep tolerance] [sweeps] [duration s]
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>

#include <polhode/contact/contact_set.hpp>
#include <polhode/engines/contact_cg_engine.hpp>
#include <polhode/engines/nonsmooth_engine.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/stepping/single_step.hpp>

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
        {system.add_body(body, start), body.name, geometry::sphere(body.name, 2.0 * kRadius)});
  }
  const auto wall = [&](const char* name, const Vec3& normal, double distance) {
    geometry::ShapePlace place;
    place.axes = Quat::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    place.origin = -distance * normal;
    contacts.add_shape({kGround, name, geometry::plane(place)});
  };
  wall("floor", Vec3::UnitZ(), 0.0);
  wall("west", Vec3::UnitX(), 0.5 * side);
  wall("east", -Vec3::UnitX(), 0.5 * side);
  wall("south", Vec3::UnitY(), 0.5 * side);
  wall("north", -Vec3::UnitY(), 0.5 * side);
}

/// What is asked of the run.
struct Task {
  bool nonsmooth = false;
  int n = 1000;
  double side = 0.0;
  double residual = 1e-3;   ///< Of bodies over their weight; or the sweep tolerance.
  double tolerance = 5e-4;  ///< Half the band of the barrier [m].
  int sweeps = 100;
  double duration = 3.0;

  Task(int argc, char** argv) {
    nonsmooth = argc > 1 && std::strcmp(argv[1], "nonsmooth") == 0;
    const int first = nonsmooth ? 2 : 1;
    const auto number = [&](int k, double otherwise) {
      return argc > first + k ? std::atof(argv[first + k]) : otherwise;
    };
    n = static_cast<int>(number(0, n));
    side = number(1, 0.0);
    if (side <= 0.0) side = 0.25 * std::ceil(std::sqrt(n / 4.0));
    residual = number(2, residual);
    if (nonsmooth)
      sweeps = static_cast<int>(number(3, sweeps));
    else
      tolerance = number(3, tolerance);
    duration = number(4, duration);
  }
};

/// A mean over the run and one over its last second.
struct Means {
  double all = 0.0, late = 0.0;
  void add(double x, bool is_late) {
    all += x;
    if (is_late) late += x;
  }
};

/// Steps of one engine, halved where they fail.
class Runner {
 public:
  Runner(const System& system, std::unique_ptr<NewtonEngine> engine)
      : single_(system, std::move(engine), GeneralizedAlpha::from_spectral_radius(1.0),
                lane_kernels("automatic"), true) {
    options_.tolerance = 1e-9;
    options_.max_iterations = 60;
    options_.line_search = false;
  }
  void begin(State& state) { single_.ledger().begin(state); }
  bool step(State& state) {
    double left = kStep, h = kStep;
    iterations = 0;
    while (left > 1e-9 * kStep) {
      h = std::min(h, left);
      const NewtonReport report = single_.take(state, h, options_, {1, false});
      iterations += report.iterations;
      if (report.converged) {
        left -= h;
        continue;
      }
      ++cuts;
      h *= 0.5;
      if (h >= 1e-4 * kStep) continue;
      std::printf("failed at t = %g: %s\n", state.t, report.text().c_str());
      return false;
    }
    return true;
  }
  [[nodiscard]] double energy(const State& state) const {
    const Balance b = single_.ledger().balance(state);
    return b.kinetic + b.potential;
  }
  int iterations = 0, cuts = 0;

 private:
  SingleStep single_;
  NewtonOptions options_;
};

}  // namespace

int main(int argc, char** argv) {
  const Task task(argc, argv);
  System system;
  system.set_gravity({0.0, 0.0, -9.81});
  const auto contacts = std::make_shared<contact::ContactSet>();
  fill(system, *contacts, task.n, task.side);
  contact::ContactLaw law;
  law.friction.mu = 0.5;
  law.tolerance = task.tolerance;
  contacts->set_default(law);
  if (task.nonsmooth) contacts->set_impulses({task.sweeps, task.residual});
  system.set_contacts(contacts);
  system.finish();
  State state = system.initial_state();
  state.dt_next = kStep;
  std::unique_ptr<NewtonEngine> owned;
  if (task.nonsmooth)
    owned = std::make_unique<NonsmoothEngine>(system);
  else
    owned = std::make_unique<ContactCgEngine>(system, task.residual);
  const auto* cg = dynamic_cast<const ContactCgEngine*>(owned.get());
  const auto* impulses = dynamic_cast<const NonsmoothEngine*>(owned.get());
  Runner runner(system, std::move(owned));
  runner.begin(state);

  Means time, iterations, inner;
  double deepest = 0.0, rise = 0.0, energy = 1e300;
  int steps = 0, late = 0, touching = 0, unconverged = 0;
  while (state.t < task.duration - 1e-9) {
    const double before = processor_seconds();
    const long inner_before = cg ? cg->inner_iterations() : 0;
    if (!runner.step(state)) return 1;
    const double took = processor_seconds() - before;
    const bool is_late = state.t > task.duration - 1.0;
    ++steps;
    late += is_late;
    time.add(1e3 * took, is_late);
    iterations.add(impulses ? impulses->last_search().sweeps : runner.iterations, is_late);
    inner.add(cg ? static_cast<double>(cg->inner_iterations() - inner_before) : 0.0, is_late);
    if (impulses && !impulses->last_search().converged) ++unconverged;
    const double now = runner.energy(state);
    rise = std::max(rise, now - energy);
    energy = now;
    touching = 0;
    for (const contact::ShapePairReport& r : contacts->reports()) {
      deepest = std::max(deepest, -r.gap);
      touching += r.normal_force > 0.0;
    }
  }
  double fastest = 0.0, end = 0.0;
  for (int b = 0; b < task.n; ++b) fastest = std::max(fastest, system.motion(state, b).v.norm());
  for (const contact::ShapePairReport& r : contacts->reports()) end = std::max(end, -r.gap);
  const double per_late = 1.0 / std::max(1, late);
  std::printf(
      "{\"law\": \"%s\", \"spheres\": %d, \"side\": %g, \"residual\": %g, \"ms\": %.2f, "
      "\"ms_last_second\": %.2f, \"%s\": %.2f, \"%s_last_second\": %.2f, ",
      impulses ? "nonsmooth" : "barrier", task.n, task.side, task.residual, time.all / steps,
      time.late * per_late, impulses ? "sweeps" : "newton", iterations.all / steps,
      impulses ? "sweeps" : "newton", iterations.late * per_late);
  if (impulses)
    std::printf("\"most_sweeps\": %d, \"steps_at_most\": %d, ", task.sweeps, unconverged);
  else
    std::printf("\"tolerance\": %g, \"cg_last_second\": %.1f, ", task.tolerance,
                inner.late * per_late);
  std::printf(
      "\"contacts\": %d, \"penetration\": %.2e, \"penetration_end\": %.2e, \"energy_rise\": "
      "%.1e, \"speed_end\": %.1e, \"cuts\": %d}\n",
      touching, deepest, end, rise, fastest, runner.cuts);
}
