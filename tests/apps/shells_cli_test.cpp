// SPDX-License-Identifier: Apache-2.0
// Meshes of shells, which are refused by name.
#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::shells_tests {
namespace {

using testing::HasSubstr;

class ShellsCli : public test::CommandLine {};

TEST_F(ShellsCli, MeshesOfShellsAreRefusedByName) {
  write("plate.inp",
        "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT, TYPE=S4, "
        "ELSET=plate\n1,1,2,3,4\n");
  write("plate.yaml",
        "format: 1\nmaterials: {m: {type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, "
        "density: 1}}\nsolids: {p: {mesh: {file: plate.inp}, material: m}}\n");
  EXPECT_THAT(run({"check", "plate.yaml"}).err,
              HasSubstr("quad4 is no solid element, and there are no shells (S3, S4 and their like)"
                        ". Use hexahedra, tetrahedra or wedges; for a plate one layer of hex20"));
}

}  // namespace
}  // namespace polhode::shells_tests
