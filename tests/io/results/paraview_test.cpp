// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/paraview.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/io/text/file_error.hpp>
#include <support/scratch.hpp>

namespace polhode::paraview_tests {
namespace {

using testing::HasSubstr;

/// Numbers of a named array of a .vtp file, read by its offset.
template <class T>
std::vector<T> array(const std::string& vtp, const std::string& name) {
  std::smatch match;
  const std::string head = vtp.substr(0, vtp.find("<AppendedData"));
  if (!std::regex_search(head, match, std::regex("Name=\"" + name + "\"[^>]*offset=\"(\\d+)\"")))
    return {};
  const std::size_t begin =
      vtp.find('_', vtp.find("<AppendedData")) + 1 + std::stoul(match[1].str());
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, vtp.data() + begin, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), vtp.data() + begin + sizeof bytes, bytes);
  return values;
}

BodySpec box_body(const std::string& name) {
  BodySpec body;
  body.name = name;
  body.mass = 1.0;
  body.inertia = Mat3::Identity();
  ShapeSpec box;
  box.type = "box";
  box.sizes = {2.0, 4.0, 6.0};
  body.shapes.push_back(box);
  return body;
}

Model two_bodies() {
  Model model;
  model.bodies = {box_body("alpha"), box_body("beta")};
  return model;
}

/// Quarter turn about z, moving along x and turning about z.
BodyMotion quarter_turned() {
  BodyMotion m;
  m.r = {10.0, 0.0, 0.0};
  m.q = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()));
  m.v = {1.0, 0.0, 0.0};
  m.W = {0.0, 0.0, 2.0};
  return m;
}

TEST(Paraview, DrawsAPlaneAsASquareLargerThanAllBodies) {
  Model model = two_bodies();
  model.bodies[1].position = {3.0, 4.0, 0.0};
  BodySpec floor;
  floor.name = "floor";
  floor.fixed = true;
  floor.position = {0.0, 0.0, 1.0};
  ShapeSpec plane;
  plane.type = "plane";
  plane.sizes = {0.0, 1.0, 1.0};
  floor.shapes.push_back(plane);
  model.bodies.push_back(floor);
  const geometry::TriangleSurface square = io::body_pictures(model, 0.5)[2].surface;
  ASSERT_EQ(square.points.size(), 4u);
  ASSERT_EQ(square.triangles.size(), 2u);
  const double far = (Vec3(3, 4, 0) - floor.position).norm();
  for (const Vec3& p : square.points) {
    EXPECT_NEAR(p.dot(Vec3(0, 1, 1)), 0.0, 1e-12);
    EXPECT_GT(p.norm(), std::sqrt(2.0) * far);
  }
  const auto& [a, b, c] = square.triangles[0];
  const Vec3 out = (square.points[b] - square.points[a]).cross(square.points[c] - square.points[a]);
  EXPECT_GT(out.dot(Vec3(0, 1, 1)), 0.0);
}

TEST(ParaviewWriter, PutsShapesWhereTheBodiesAre) {
  const test::Scratch scratch;
  io::ParaviewWriter writer(scratch / "view", "results", io::body_pictures(two_bodies(), 1.0));
  writer.append(0.25, {BodyMotion{}, quarter_turned()});
  writer.close();
  const std::string vtp = io::read_file(scratch / "view/results/000000.vtp");
  const auto points = array<float>(vtp, "points");
  const auto velocity = array<float>(vtp, "velocity");
  const auto owner = array<std::int32_t>(vtp, "body");
  const auto corners = array<std::int64_t>(vtp, "connectivity");
  ASSERT_EQ(points.size() % 6, 0u);
  ASSERT_EQ(velocity.size(), points.size());
  ASSERT_EQ(owner.size(), 24u);  // Two boxes of twelve triangles.
  EXPECT_EQ(owner.front(), 0);
  EXPECT_EQ(owner.back(), 1);
  EXPECT_EQ(corners.size(), 72u);
  const auto half = static_cast<std::ptrdiff_t>(points.size() / 2);
  // The first box stands at the origin; the second has turned its long side y into −x.
  float x_most = 0, x_most_turned = 0;
  for (std::ptrdiff_t i = 0; i < half; i += 3)
    x_most = std::max(x_most, points[static_cast<std::size_t>(i)]);
  for (std::ptrdiff_t i = half; i < 2 * half; i += 3)
    x_most_turned = std::max(x_most_turned, points[static_cast<std::size_t>(i)]);
  EXPECT_FLOAT_EQ(x_most, 1.0F);
  EXPECT_FLOAT_EQ(x_most_turned, 12.0F);
  // v + ω × z at each corner, from the corner's own place; single precision.
  for (std::size_t i = static_cast<std::size_t>(half); i < points.size(); i += 3) {
    EXPECT_NEAR(velocity[i], 1.0 - 2.0 * points[i + 1], 1e-5);
    EXPECT_NEAR(velocity[i + 1], 2.0 * (points[i] - 10.0), 1e-5);
  }
  EXPECT_THAT(vtp, HasSubstr("97 108 112 104 97 0 98 101 116 97 0"));  // alpha, beta
}

TEST(ParaviewWriter, ListsOnlyFilesThatExist) {
  const test::Scratch scratch;
  io::ParaviewWriter writer(scratch / "view", "results", io::body_pictures(two_bodies(), 1.0));
  for (int k = 0; k < 3; ++k) {
    writer.append(0.5 * k, {BodyMotion{}, BodyMotion{}});
    const std::string pvd = io::read_file(scratch / "view/results.pvd");  // As after a kill.
    const std::regex entry("file=\"([^\"]*)\"");
    for (std::sregex_iterator it(pvd.begin(), pvd.end(), entry), end; it != end; ++it)
      EXPECT_THAT(io::read_file(scratch / ("view/" + (*it)[1].str())), HasSubstr("</VTKFile>"));
    EXPECT_THAT(pvd, HasSubstr("</VTKFile>"));
  }
  writer.close();
  const std::string pvd = io::read_file(scratch / "view/results.pvd");
  EXPECT_THAT(pvd, HasSubstr("timestep=\"1\" part=\"0\" file=\"results/000002.vtp\""));
}

TEST(ParaviewWriter, ContinuesAtATime) {
  const test::Scratch scratch;
  {
    io::ParaviewWriter writer(scratch / "view", "results", io::body_pictures(two_bodies(), 1.0));
    for (int k = 0; k < 4; ++k) writer.append(k, {BodyMotion{}, BodyMotion{}});
    writer.close();
  }
  const io::ParaviewWriter writer(scratch / "view", "results", io::body_pictures(two_bodies(), 1.0),
                                  2.0);
  EXPECT_EQ(writer.frames(), 3u);
}

// A box of lengths a, b, c has I_x = m (b² + c²)/12: the drawn box must have the body's inertia.
TEST(BodyPictures, DrawABodyWithoutShapesAsTheBoxOfItsInertia) {
  Model model;
  BodySpec body;
  body.name = "plain";
  body.mass = 3.0;
  const Vec3 half(0.1, 0.2, 0.3);
  body.inertia = Vec3(half[1] * half[1] + half[2] * half[2], half[0] * half[0] + half[2] * half[2],
                      half[0] * half[0] + half[1] * half[1])
                     .asDiagonal();  // m/12·(2·half)² = half², as m = 3
  model.bodies.push_back(body);
  const auto pictures = io::body_pictures(model, 1.0);
  Vec3 most = Vec3::Zero();
  for (const Vec3& p : pictures[0].surface.points) most = most.cwiseMax(p.cwiseAbs());
  EXPECT_TRUE(most.isApprox(half, 1e-12)) << most.transpose();
}

}  // namespace
}  // namespace polhode::paraview_tests
