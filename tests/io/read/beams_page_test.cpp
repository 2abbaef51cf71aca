// SPDX-License-Identifier: Apache-2.0
// The complete models of docs/reference/beams.md, run unchanged.
#include <support/page_examples.hpp>

namespace polhode::test::beams_page_tests {

TEST(BeamsPage, EveryModelRuns) { EXPECT_EQ(run_page_examples("docs/reference/beams.md"), 5); }

}  // namespace polhode::test::beams_page_tests
