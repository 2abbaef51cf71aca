// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <stdexcept>

#include <polhode/io/read/model_places.hpp>
#include <polhode/io/results/write_results.hpp>
#include <polhode/simulation/held_values.hpp>
#include <polhode/simulation/simulation_details.hpp>

#include "compiled_model.hpp"
#include "coordinates.hpp"
#include "recording.hpp"

namespace polhode::python {

/// Error for a force in Python that uses its own simulation for an evaluation of forces.
struct NestedUse : std::runtime_error {
  NestedUse()
      : std::runtime_error(
            "A force cannot use its simulation during its evaluation. Store the values after each "
            "step, in a loop over the steps or in run(observe=...). A force may read only the "
            "time.") {}
};

/// Makes something of a model; errors that are found there get their place in the model's file.
template <class Make>
auto located(const io::ModelPlaces& places, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    if (const auto found = places.located(error)) throw io::ModelErrors({*found});
    throw;
  }
}

/// A simulation with its names, for Python.
class Engine {
 public:
  explicit Engine(const CompiledModel& compiled)
      : calls(compiled.calls), preferred_(compiled.preferred) {
    const nb::gil_scoped_release unlocked;
    simulation_ = located(io::ModelPlaces(compiled.model),
                          [&] { return std::make_unique<Simulation>(compiled.model); });
  }
  Engine(const Model& model, State state, nb::object owner)
      : calls(std::move(owner)),
        simulation_(std::make_unique<Simulation>(model, std::move(state))) {}

  /// Access that evaluates no forces.
  [[nodiscard]] Simulation& simulation() { return *simulation_; }
  /// A simulation in use by one call: steps and reports evaluate forces, so a force in Python that
  /// used a report would be evaluated recursively.
  class Use {
   public:
    /// @throws NestedUse if it is in use already.
    explicit Use(Engine& engine) : busy_(engine.busy_), simulation_(*engine.simulation_) {
      if (busy_) throw NestedUse();
      busy_ = true;
    }
    ~Use() { busy_ = false; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Simulation* operator->() const { return &simulation_; }
    Simulation& operator*() const { return simulation_; }

   private:
    bool& busy_;
    Simulation& simulation_;
  };
  [[nodiscard]] Use use() { return Use(*this); }
  [[nodiscard]] const Model& model() const { return simulation_->model(); }

  /// Runs to the end; checks for Ctrl-C and calls progress(time) every 50 ms of wall time.
  /// @param folder      Folder for results, unless it is empty.
  /// @returns the summary as JSON, see summary_json().
  std::string run(Recording* recording, const std::string& folder, const std::string& model_text,
                  const std::vector<std::string>& overrides, const nb::object& progress);
  [[nodiscard]] std::string summary();

  [[nodiscard]] nb::bytes state() const;
  void restore(const nb::bytes& bytes);
  [[nodiscard]] Engine copy() {
    const Use used(*this);
    Engine other(model(), simulation_->state(), calls);
    other.preferred_ = preferred_;
    other.coordinates_ = coordinates_;
    other.start_ = start_;
    return other;
  }
  /// Sets positions and velocities of moving bodies, by index, at the present time. Then joints are
  /// assembled, velocities projected, and turn counts and the energy balance reset.
  /// @throws InputError if the joints cannot be assembled, and for models with solids or with
  /// surfaces in contact.
  void set_motions(const std::map<int, BodyMotion>& motions);

  /// Joint coordinates, made at first use. @throws InputError for a model that has none.
  [[nodiscard]] const Coordinates& coordinates();
  /// Present motions of all bodies of the model, as Coordinates::motions().
  [[nodiscard]] JointSpace::Motions motions();
  /// Places all bodies at coordinates; without: as they are. Likewise with rates.
  void set_coordinates(const std::optional<std::vector<double>>& positions,
                       const std::optional<std::vector<double>>& rates);
  /// Returns to the start of the model; numbers held by it become zero.
  void reset();
  /// Numbers of loads that are set between steps; null if there are none.
  [[nodiscard]] std::shared_ptr<HeldNumbers> held() const { return held_numbers(model()); }

  nb::object calls;  ///< Owns the callables of the loads, see CompiledModel.

 private:
  /// Motions of the moving bodies, at the present time.
  void put(const std::vector<BodyMotion>& moving, const std::string& where,
           const std::vector<double>& positions = {});

  std::vector<std::string> preferred_;
  std::shared_ptr<const Coordinates> coordinates_;  ///< Null until used.
  std::shared_ptr<const State> start_;              ///< Likewise.
  std::unique_ptr<Simulation> simulation_;
  bool busy_ = false;  ///< Guarded by Python's lock: set and read while it is held.
};

/// Steps to a time. @returns why a step was not accepted, or an empty text.
[[nodiscard]] std::string advance(Simulation& simulation, double until);

void bind_joint_space(nb::class_<Engine>& engine);

}  // namespace polhode::python
