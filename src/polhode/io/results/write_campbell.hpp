// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/simulation/modal.hpp>

namespace polhode::io {

/// Writes the modes at several speeds of a spin, campbell.csv and the picture campbell.svg.
/// @param analyses  Of one speed each, all with an equilibrium.
void write_campbell(const std::vector<ModalAnalysis>& analyses, const std::string& folder);

}  // namespace polhode::io
