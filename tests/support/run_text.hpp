// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// The simulation of a model file's text.
inline Simulation made(const std::string& text, const io::Overrides& overrides = {}) {
  return Simulation(io::read_model_text(text, "model.yaml", overrides));
}

/// Runs a simulation to its end; it fails the test otherwise.
inline RunSummary finished(Simulation& s) {
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return r;
}

/// Error message for a faulty model; "" if it has no fault.
inline std::string fault_of(const std::string& text) {
  try {
    (void)made(text);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

/// Expects the error message of a model to contain a text. @returns whether it does.
inline bool expect_fault(const std::string& text, const std::string& wanted) {
  const std::string fault = fault_of(text);
  EXPECT_NE(fault.find(wanted), std::string::npos) << fault;
  return fault.find(wanted) != std::string::npos;
}

}  // namespace polhode::test
