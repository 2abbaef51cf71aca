// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::shapes_tests {
namespace {

// A point inside each shape, no symmetric one.
const Vec3 kInside{0.21, 0.34, 0.17};

TEST(CellShapes, HaveShapeFunctionsThatAreOneAtTheirNodeAndZeroAtTheOthers) {
  for (const solids::CellShape& shape : solids::cell_shapes()) {
    // Reference coordinates of thirds are rounded.
    const bool thirds = shape.name == "tri7" || shape.name == "tet15";
    for (int b = 0; b < shape.size(); ++b) {
      const Vec N = solids::shape_functions(shape, shape.nodes[b]);
      for (int a = 0; a < shape.size(); ++a)
        if (thirds) {
          EXPECT_NEAR(N[a], a == b ? 1.0 : 0.0, 2e-15) << shape.name << " " << a << " " << b;
        } else {
          EXPECT_EQ(N[a], a == b ? 1.0 : 0.0) << shape.name << " " << a << " " << b;
        }
    }
  }
}

TEST(CellShapes, ReproducePositionsAndTheirGradients) {
  for (const solids::CellShape& shape : solids::cell_shapes()) {
    const Vec N = solids::shape_functions(shape, kInside);
    const Mat gradients = solids::shape_gradients(shape, kInside);
    Vec3 x = Vec3::Zero();
    Mat3 F = Mat3::Zero();
    for (int a = 0; a < shape.size(); ++a) {
      x += N[a] * shape.nodes[a];
      F += shape.nodes[a] * gradients.row(a);
    }
    EXPECT_NEAR(N.sum(), 1.0, 1e-14) << shape.name;
    for (int i = 0; i < shape.dimension; ++i) {
      EXPECT_NEAR(x[i], kInside[i], 1e-14) << shape.name;
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(F(i, j), i == j ? 1.0 : 0.0, 1e-14) << shape.name << " " << i << " " << j;
    }
  }
}

TEST(CellShapes, HaveEdgeNodesInTheMiddlesOfTheirEdges) {
  for (const solids::CellShape& shape : solids::cell_shapes())
    for (const solids::CellEdge& edge : shape.edges) {
      EXPECT_EQ(edge.middle >= 0, shape.order == 2) << shape.name;
      if (edge.middle < 0) continue;
      const Vec3 middle = 0.5 * (shape.nodes[edge.begin] + shape.nodes[edge.end]);
      EXPECT_EQ(shape.nodes[edge.middle], middle) << shape.name;
    }
}

TEST(CellShapes, HaveFacesThatFaceOutward) {
  for (const solids::CellShape& shape : solids::cell_shapes()) {
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < shape.corners; ++i) centre += shape.nodes[i] / shape.corners;
    for (const solids::CellFace& face : shape.faces) {
      const solids::CellShape& flat = solids::cell_shape(face.type);
      ASSERT_EQ(flat.size(), static_cast<int>(face.nodes.size()));
      const Vec3 a = shape.nodes[face.nodes[0]], b = shape.nodes[face.nodes[1]],
                 c = shape.nodes[face.nodes[2]];
      EXPECT_GT((b - a).cross(c - a).dot(a - centre), 0.0) << shape.name;
      for (const solids::CellEdge& edge : flat.edges) {
        if (edge.middle < 0) continue;
        const Vec3 middle =
            0.5 * (shape.nodes[face.nodes[edge.begin]] + shape.nodes[face.nodes[edge.end]]);
        EXPECT_EQ(shape.nodes[face.nodes[edge.middle]], middle) << shape.name << " " << face.type;
      }
    }
  }
}

TEST(CellShapes, HaveAPositiveDeterminantEverywhere) {
  for (const solids::CellShape& shape : solids::cell_shapes()) {
    if (shape.dimension != 3) continue;
    EXPECT_NEAR(solids::least_jacobian(shape, shape.nodes.data()), 1.0, 1e-13) << shape.name;
  }
}

TEST(CellShapes, ListTheTypesWhenAskedForAnotherOne) {
  try {
    (void)solids::cell_shape("hex9");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "element type: there is no type 'hex9'. Did you mean 'hex8'? Types: point, line2, "
        "line3, tri3, tri6, tri7, quad4, quad8, quad9, tet4, tet10, tet15, wedge6, wedge15, hex8, "
        "hex20, hex27.");
  }
}

}  // namespace
}  // namespace polhode::shapes_tests
