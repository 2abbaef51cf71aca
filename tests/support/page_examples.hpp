// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>

namespace polhode::test {

/// Runs the model files of a page of the documentation; parts of files are skipped.
/// @param page  Path in the repository.
/// @returns their number.
inline int run_page_examples(const std::string& page) {
  std::ifstream file(source_dir() + "/" + page);
  EXPECT_TRUE(file.good()) << page;
  std::stringstream all;
  all << file.rdbuf();
  const std::string whole = all.str(), open = "```yaml\n", close = "```";
  int count = 0;
  for (std::size_t at = whole.find(open); at != std::string::npos; at = whole.find(open, at)) {
    at += open.size();
    const std::size_t end = whole.find(close, at);
    const std::string text = whole.substr(at, end - at);
    at = end + close.size();
    if (!text.starts_with("format: 1\n")) continue;
    SCOPED_TRACE(text);
    Simulation s(io::read_model_text(text, "page.yaml", {"output.hdf5=false"}));
    const RunSummary summary = s.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_LT(summary.energy_drift, 1e-10);
    ++count;
  }
  return count;
}

}  // namespace polhode::test
