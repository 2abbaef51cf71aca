// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <polhode/model/build_system.hpp>
#include <polhode/model/simulation.hpp>
#include <polhode/solve/modes.hpp>

namespace polhode {

/// Natural frequencies and shapes of a model about the equilibrium that statics finds from its
/// start, or about the start itself (analysis.about).
class ModalAnalysis {
 public:
  /// @throws InputError if the model cannot be built or its start not assembled, if a body has a
  ///         velocity, or if nothing can move.
  explicit ModalAnalysis(Model model);

  /// False if no equilibrium was found: message() says why, and there are no modes.
  [[nodiscard]] bool converged() const { return message_.empty(); }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const Model& model() const { return simulation_->model(); }
  /// At the equilibrium.
  [[nodiscard]] const Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const ModesReport& report() const { return report_; }
  /// How a body of the model moves in a mode: displacement of its centre of mass and small
  /// rotation, world, of the mass-normalised shape. Fixed bodies do not.
  [[nodiscard]] Vec6 body_shape(int mode, int body) const;

 private:
  std::unique_ptr<Simulation> simulation_;
  SystemMap map_;
  ModesReport report_;
  std::string message_;
};

}  // namespace polhode
