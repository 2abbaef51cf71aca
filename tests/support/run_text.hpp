// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// The simulation of a model file's text.
inline Simulation made(const std::string& text, const Overrides& overrides = {}) {
  return Simulation(read_model_text(text, "model.yaml", overrides));
}

/// Runs it to its end, which it must reach.
inline RunSummary finished(Simulation& s) {
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return r;
}

/// What is said of a model that has a fault; "" if it has none.
inline std::string fault_of(const std::string& text) {
  try {
    (void)made(text);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

/// Expects that a model has a fault that is told in these words.
inline bool tells(const std::string& text, const std::string& wanted) {
  const std::string fault = fault_of(text);
  EXPECT_NE(fault.find(wanted), std::string::npos) << fault;
  return fault.find(wanted) != std::string::npos;
}

}  // namespace polhode::test
