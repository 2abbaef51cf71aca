// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/statics/modes.hpp>

namespace polhode {

/// Natural frequencies and shapes of a model about the static equilibrium found from its start, or
/// about the start itself (analysis.about). Bodies and beams may rotate steadily about axes through
/// their centres of mass: rotors, with gyroscopic moments. Or everything spins steadily about one
/// axis (analysis.spin, one speed): modes are seen from the frame that turns with it.
class ModalAnalysis {
 public:
  /// @throws InputError if the model cannot be built or its start not assembled, or if a centre of
  ///         mass or a solid has a velocity.
  /// @param stop  Ends the search for the equilibrium when it becomes true; null: never.
  explicit ModalAnalysis(Model model, const std::atomic<bool>* stop = nullptr);

  /// Whether an equilibrium was found; if not, message() says why, and there are no modes.
  [[nodiscard]] bool converged() const { return message_.empty(); }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const Model& model() const { return simulation_->model(); }
  /// Simulation at the equilibrium.
  [[nodiscard]] const Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const ModesReport& report() const { return report_; }
  /// Speed of the steady spin in whose frame modes are seen [rad/s]; 0 without one.
  [[nodiscard]] double spin() const {
    const std::vector<double>& speeds = model().analysis.spin;
    return speeds.empty() ? 0.0 : speeds.front();
  }
  /// Motion of a body of the model in a mode: displacement of its centre of mass and small
  /// rotation, world, of the mass-normalised shape; zero for fixed bodies.
  /// @param imaginary  Of the imaginary part of the shape.
  [[nodiscard]] Vec6 body_shape(int mode, int body, bool imaginary = false) const;
  /// Displacements of the nodes of solids, three each, likewise.
  [[nodiscard]] std::vector<double> node_shapes(int mode, bool imaginary = false) const;
  [[nodiscard]] double wall_time() const { return wall_time_; }  ///< [s]
  [[nodiscard]] double cpu_time() const { return cpu_time_; }    ///< Of one processor [s].

 private:
  std::unique_ptr<Simulation> simulation_;
  SystemMap map_;
  ModesReport report_;
  std::string message_;
  double wall_time_ = 0.0, cpu_time_ = 0.0;
};

/// Modes at each speed of analysis.spin, as far as there are equilibria: the last may have none.
/// @throws InputError as ModalAnalysis does, or if the model is not steady in the turning frame.
[[nodiscard]] std::vector<ModalAnalysis> spin_analyses(const Model& model,
                                                       const std::atomic<bool>* stop = nullptr);

}  // namespace polhode
