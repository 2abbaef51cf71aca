// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::nodes_tests {
namespace {

using testing::StartsWith;

/// Messages have the number of a node within its solid, as results and probes have.
TEST(Nodes, AreNamedByTheirNumberInTheirSolid) {
  const Model model = io::read_model_text(R"(
format: 1
materials: {rubber: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  first: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}}, material: rubber}
  second: {mesh: {block: {size: [1, 1, 1], cells: [2, 1, 1]}, position: [2, 0, 0]}, material: rubber}
)",
                                          "two_blocks.yaml");
  const System system = build_system(model);
  const Nodes& nodes = system.nodes();
  ASSERT_EQ(nodes.count(), 8 + 12);
  EXPECT_THAT(nodes.node_name(3), StartsWith("node 3, element 0 of 'solids.first' ("));
  EXPECT_THAT(nodes.node_name(8), StartsWith("node 0, element 0 of 'solids.second' ("));
  EXPECT_THAT(nodes.node_name(19), StartsWith("node 11, element 1 of 'solids.second' ("));
  EXPECT_EQ(nodes.place_of(19).number, 11);
}

}  // namespace
}  // namespace polhode::nodes_tests
