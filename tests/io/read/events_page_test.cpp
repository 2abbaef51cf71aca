// SPDX-License-Identifier: Apache-2.0
// The examples of docs/reference/events.md, run unchanged.
#include <support/page_examples.hpp>

namespace polhode::test::events_page_tests {

TEST(EventsPage, EveryExampleRuns) { EXPECT_EQ(run_page_examples("docs/reference/events.md"), 7); }

}  // namespace polhode::test::events_page_tests
