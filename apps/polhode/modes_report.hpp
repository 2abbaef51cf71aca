// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/simulation/modal.hpp>

#include "console.hpp"

namespace polhode::cli {

/// Computes the natural frequencies of a model, writes and prints them, and returns the exit code.
int run_modes(Model model, const ModelArguments& arguments, std::string folder, bool json,
              bool quiet);

}  // namespace polhode::cli
