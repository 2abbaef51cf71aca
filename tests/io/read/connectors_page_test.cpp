// SPDX-License-Identifier: Apache-2.0
// The examples of docs/reference/connectors.md and joints.md, run unchanged.
#include <support/page_examples.hpp>

namespace polhode::test::connectors_page_tests {

TEST(ConnectorsPage, EveryExampleRuns) {
  EXPECT_EQ(run_page_examples("docs/reference/connectors.md"), 12);
}

TEST(JointsPage, EveryExampleRuns) { EXPECT_EQ(run_page_examples("docs/reference/joints.md"), 2); }

}  // namespace polhode::test::connectors_page_tests
