// SPDX-License-Identifier: Apache-2.0
// The examples of docs/reference/connectors.md run as they stand.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>

namespace polhode::test::connectors_page_tests {

TEST(ConnectorsPage, EveryExampleRuns) {
  std::ifstream file(source_dir() + "/docs/reference/connectors.md");
  ASSERT_TRUE(file.good());
  std::stringstream all;
  all << file.rdbuf();
  const std::string page = all.str(), open = "```yaml\n", close = "```";
  int count = 0;
  for (std::size_t at = page.find(open); at != std::string::npos; at = page.find(open, at)) {
    at += open.size();
    const std::size_t end = page.find(close, at);
    const std::string text = page.substr(at, end - at);
    SCOPED_TRACE(text);
    Simulation s(read_model_text(text, "connectors.yaml", {"output.hdf5=false"}));
    const RunSummary summary = s.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_LT(summary.energy_drift, 1e-10);
    ++count;
    at = end + close.size();
  }
  EXPECT_EQ(count, 8);
}

}  // namespace polhode::test::connectors_page_tests
