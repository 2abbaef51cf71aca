// SPDX-License-Identifier: Apache-2.0
#include "engine.hpp"

#include <chrono>
#include <filesystem>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/results/summary_json.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode::python {

namespace {

constexpr std::chrono::milliseconds kLook{50};

const char* end_name(RunEnd end) {
  switch (end) {
    case RunEnd::finished:
      return "finished";
    case RunEnd::not_converged:
      return "not_converged";
    case RunEnd::limit:
      return "limit";
    case RunEnd::interrupted:
      break;
  }
  return "interrupted";
}

/// Signals and progress of a run for Python, every 50 ms of wall time.
class Attention {
 public:
  explicit Attention(const nb::object& progress) : progress_(progress) {}

  void look(double time) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + kLook;
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) {
      if (PyErr_ExceptionMatches(PyExc_KeyboardInterrupt) == 0) throw nb::python_error();
      PyErr_Clear();
      stop = true;
    }
    if (progress_.is_none()) return;
    try {
      progress_(time);
    } catch (const nb::python_error& e) {  // Ctrl-C may come while the bar is drawn
      if (!e.matches(PyExc_KeyboardInterrupt)) throw;
      stop = true;
    }
  }
  std::atomic<bool> stop{false};

 private:
  const nb::object& progress_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + kLook;
};

}  // namespace

std::string Engine::run(Recording* recording, const std::string& folder,
                        const std::string& model_text, const std::vector<std::string>& overrides,
                        const nb::object& progress) {
  Attention attention(progress);
  const Use used(*this);
  const nb::gil_scoped_release unlocked;
  std::optional<io::Recorder> file;
  if (!folder.empty()) {
    const RunSummary s = simulation_->summary();
    file.emplace(
        *simulation_, folder,
        io::Provenance{.version = version(),
                       .solver = s.solver,
                       .instruction_set = s.instruction_set,
                       .model_file = std::filesystem::path(model().source_file).filename().string(),
                       .model_text = model_text,
                       .overrides = overrides});
    file->step(*simulation_);
  }
  if (recording) recording->step(*simulation_);
  const auto frame = [&](Simulation& s) {
    if (recording) recording->frame(s);
    if (file) file->frame(s);
  };
  const RunSummary summary = simulation_->run(
      frame,
      [&](Simulation& s) {
        if (file) file->step(s);
        if (recording) recording->step(s);
        attention.look(s.time());
      },
      &attention.stop);
  if (summary.end == RunEnd::finished || summary.end == RunEnd::not_converged) frame(*simulation_);
  if (file) {
    file->conclude(summary);
    file->close();
  }
  return io::summary_json(summary, {.end = end_name(summary.end),
                                    .exit_code = 0,
                                    .folder = folder,
                                    .frames = recording ? recording->frames() : 0});
}

std::string Engine::summary() {
  const RunSummary summary = use()->summary();
  return io::summary_json(summary, {.end = end_name(summary.end)});
}

namespace {

nb::dict body_report(Engine& engine, int body) {
  const Engine::Use simulation = engine.use();
  const BodyMotion m = simulation->body(body);
  const Quat q = m.q.w() < 0.0 ? Quat(-m.q.coeffs()) : m.q;
  const auto point = simulation->point(body, Vec3::Zero());
  nb::dict result;
  result["position"] = array_of(m.r);
  result["orientation"] = array_of(std::vector<double>{q.w(), q.x(), q.y(), q.z()}, {4});
  result["velocity"] = array_of(m.v);
  result["angular_velocity"] = array_of(m.omega());
  result["acceleration"] = array_of(point.acceleration);
  // Accelerations of points off the centre of mass give the angular acceleration normal to their
  // arm: with all three axes each component twice.
  const Vec3 omega = m.omega();
  const Mat3 axes = m.Lambda();
  Vec3 alpha = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 arm = axes.col(k);
    const Vec3 a = simulation->point(body, Vec3::Unit(k)).acceleration;
    alpha += 0.5 * arm.cross(a - point.acceleration - omega.cross(omega.cross(arm)));
  }
  result["angular_acceleration"] = array_of(alpha);
  return result;
}

nb::dict joint_report(Engine& engine, int joint) {
  JointReport r = engine.use()->joint(joint);
  const auto list = [](std::vector<double> numbers) {
    const std::size_t n = numbers.size();
    return array_of(std::move(numbers), {n});
  };
  nb::dict result;
  result["coordinates"] = list(std::move(r.coordinates));
  result["rates"] = list(std::move(r.rates));
  result["force"] = array_of(r.force);
  result["moment"] = array_of(r.moment);
  result["residual"] = r.residual;
  if (!r.friction.empty()) {
    result["friction"] = list(std::move(r.friction));
    result["slips"] = r.slips;
  }
  if (!r.stops.empty()) result["stops"] = list(std::move(r.stops));
  if (!r.power.empty()) {
    result["power"] = list(std::move(r.power));
    result["work"] = list(std::move(r.work));
  }
  return result;
}

nb::dict energy(Engine& engine) {
  const Balance b = engine.use()->balance();
  nb::dict result;
  result["kinetic"] = b.kinetic;
  result["potential"] = b.potential;
  result["total"] = b.kinetic + b.potential;
  result["put_in"] = b.put_in;
  result["dissipated"] = b.dissipated;
  result["linear_momentum"] = array_of(b.linear_momentum);
  result["angular_momentum"] = array_of(b.angular_momentum);
  return result;
}

using Numbers = std::optional<std::vector<double>>;

Vec3 vector(const std::vector<double>& x, const char* what) {
  if (x.size() != 3) throw InputError(what, "expects three numbers", "Give [x, y, z]");
  return {x[0], x[1], x[2]};
}

BodyMotion changed_motion(Engine& engine, int body, const Numbers& position,
                          const Numbers& orientation, const Numbers& velocity,
                          const Numbers& angular_velocity) {
  BodyMotion m = engine.use()->body(body);
  const Vec3 omega = angular_velocity ? vector(*angular_velocity, "angular_velocity") : m.omega();
  if (position) m.r = vector(*position, "position");
  if (velocity) m.v = vector(*velocity, "velocity");
  if (orientation) {
    if (orientation->size() != 4)
      throw InputError("orientation", "expects four numbers", "Give [w, x, y, z]");
    const std::vector<double>& q = *orientation;
    m.q = Quat(q[0], q[1], q[2], q[3]).normalized();
  }
  m.W = m.q.conjugate() * omega;
  return m;
}

void set_body(Engine& engine, int body, const Numbers& position, const Numbers& orientation,
              const Numbers& velocity, const Numbers& angular_velocity) {
  engine.set_motions(
      {{body, changed_motion(engine, body, position, orientation, velocity, angular_velocity)}});
}

/// Several bodies at once: index, position, orientation, velocity, angular velocity of each.
void set_bodies(Engine& engine,
                const std::vector<std::tuple<int, std::vector<double>, std::vector<double>,
                                             std::vector<double>, std::vector<double>>>& motions) {
  std::map<int, BodyMotion> all;
  for (const auto& [body, r, q, v, omega] : motions)
    all.emplace(body, changed_motion(engine, body, r, q, v, omega));
  engine.set_motions(all);
}

template <class Specs>
std::vector<std::string> names_of(const Specs& specs) {
  std::vector<std::string> names;
  for (const auto& spec : specs) names.push_back(spec.name);
  return names;
}

/// Steps to a time, without Python in between. @returns why a step was not accepted, or nothing.
std::string advance_engine(Engine& engine, double until) {
  const Engine::Use simulation = engine.use();
  const nb::gil_scoped_release unlocked;
  return advance(*simulation, until);
}

nb::tuple step(Engine& engine, double limit) {
  StepReport report;
  {
    const Engine::Use simulation = engine.use();
    const nb::gil_scoped_release unlocked;
    report = simulation->step(limit);
  }
  return nb::make_tuple(report.accepted, report.t, report.dt, report.rejected,
                        report.newton.iterations, report.message);
}

}  // namespace

void bind_engine(nb::module_& m) {
  nb::class_<Engine> engine(m, "Engine", "A compiled model with its state.",
                            nb::type_slots(CallSlots<Engine>::slots));
  bind_joint_space(engine);
  engine.def(nb::init<const CompiledModel&>(), nb::arg("model"))
      .def("record", [](Engine& e) { return Recording(*e.use()); })
      .def("run", &Engine::run, nb::arg("recording").none(), nb::arg("folder"),
           nb::arg("model_text"), nb::arg("overrides"), nb::arg("progress").none())
      .def("step", &step, nb::arg("limit"))
      .def("advance", &advance_engine, nb::arg("until"))
      .def("record_frame",
           [](Engine& e, Recording& r) {
             const Engine::Use simulation = e.use();
             r.frame(*simulation);
             r.step(*simulation);
           })
      .def("copy", &Engine::copy)
      .def("set_body", &set_body, nb::arg("index"), nb::arg("position").none(),
           nb::arg("orientation").none(), nb::arg("velocity").none(),
           nb::arg("angular_velocity").none())
      .def("set_bodies", &set_bodies, nb::arg("motions"))
      .def_prop_ro("fixed",
                   [](Engine& e) {
                     std::vector<bool> fixed;
                     for (const BodySpec& b : e.model().bodies) fixed.push_back(b.fixed);
                     return fixed;
                   })
      .def_prop_ro("time", [](Engine& e) { return e.simulation().time(); })
      .def_prop_ro("bodies", [](Engine& e) { return names_of(e.model().bodies); })
      .def_prop_ro("joints", [](Engine& e) { return names_of(e.model().joints); })
      .def_prop_ro("loads", [](Engine& e) { return names_of(e.model().loads); })
      .def_prop_ro("state", &Engine::state)
      .def("restore", &Engine::restore, nb::arg("state"))
      .def_prop_ro("state_hash", [](Engine& e) { return e.simulation().state_hash(); })
      .def("body", &body_report, nb::arg("index"))
      .def("joint", &joint_report, nb::arg("index"))
      .def(
          "load", [](Engine& e, int i) { return e.use()->load(i); }, nb::arg("index"))
      .def(
          "load_channels",
          [](Engine& e, int i) {
            const LoadSpec& load = e.model().loads.at(static_cast<std::size_t>(i));
            std::vector<std::pair<std::string, int>> channels;
            if (load.reports())
              for (const LoadChannel& c : load_kind(load.type).channels)
                channels.emplace_back(c.name, c.size);
            return channels;
          },
          nb::arg("index"), "Name and number of values of each reported quantity of a load.")
      .def_prop_ro("probes", [](Engine& e) { return names_of(e.model().output.probes); })
      .def(
          "probe",
          [](Engine& e, const std::string& name) {
            const Engine::Use simulation = e.use();
            return nb::make_tuple(nb::cast(simulation->probe_columns(name)),
                                  nb::cast(simulation->probe(name)));
          },
          nb::arg("name"))
      .def("energy", &energy)
      .def("summary", &Engine::summary);
}

}  // namespace polhode::python
