// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/compile/build_system.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/stepping/single_step.hpp>
#include <polhode/stepping/start.hpp>

namespace polhode::test {

/// A model at its start, with its single steps along the tree.
struct SteppedModel {
  /// @param text  Of a model file.
  explicit SteppedModel(const std::string& text, double rho_inf = 1.0)
      : system(build_system(io::read_model_text(text, "m.yaml", {}))),
        state(system.initial_state()),
        step(system, std::make_unique<TreeEngine>(system),
             GeneralizedAlpha::from_spectral_radius(rho_inf), lane_kernels("automatic"), true) {
    (void)start(system, state, GeneralizedAlpha::from_spectral_radius(rho_inf), 0.01);
    step.ledger().begin(state);
  }

  System system;
  State state;
  SingleStep step;
};

}  // namespace polhode::test
