// SPDX-License-Identifier: Apache-2.0
// Results, probes, pictures and restarts of beams and cables.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/scratch.hpp>

namespace polhode::beam_results_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A mast stands on the ground and is pulled at its end; a rope with mass hangs from its end, a
/// stay holds it.
constexpr const char* kModel = R"(
format: 1
gravity: [0, 0, -10]
bodies:
  stone: {point_mass: true, mass: 2, position: [1, 0, 1]}
materials:
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 8000}
sections:
  rod: {type: circle, diameter: 20 mm, material: steel}
beams:
  mast: {points: [[0, 0, 0], [0, 0, 2]], elements: 4, section: rod, up: y, bonded: {ground: start}}
cables:
  stay: {through: [[ground, [-2, 0, 0]], [mast, end]], stiffness: 10 kN}
  rope: {through: [[mast, end], [stone]], stiffness: 10 kN, mass_per_length: 0.1, elements: 3}
analysis: {duration: 4 ms, step: 1 ms}
output:
  paraview: true
  probes:
    foot: {beam: mast}
    top: {beam: mast, element: 3}
    pull: {cable: rope, element: 2}
)";

std::vector<double> numbers(hid_t file, const std::string& path, std::vector<hsize_t>& dims) {
  const hid_t set = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
  EXPECT_GE(set, 0) << path;
  if (set < 0) return {};
  const hid_t space = H5Dget_space(set);
  dims.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  hsize_t count = 1;
  for (const hsize_t d : dims) count *= d;
  std::vector<double> values(count);
  H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream stream(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Floats of a named array of a VTK file.
std::vector<float> array(const std::string& file, const std::string& name) {
  std::smatch match;
  const std::string head = file.substr(0, file.find("<AppendedData"));
  if (!std::regex_search(head, match, std::regex("Name=\"" + name + "\"[^>]*offset=\"(\\d+)\"")))
    return {};
  const std::size_t begin =
      file.find('_', file.find("<AppendedData")) + 1 + std::stoul(match[1].str());
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + begin, sizeof bytes);
  std::vector<float> values(bytes / sizeof(float));
  std::memcpy(values.data(), file.data() + begin + sizeof bytes, bytes);
  return values;
}

std::string run_into(const std::string& folder, const std::string& text) {
  Simulation s(io::read_model_text(text, "mast.yaml"));
  io::Recorder recorder(s, folder, {});
  recorder.step(s);
  const RunSummary r = s.run([&](Simulation& now) { recorder.frame(now); },
                             [&](Simulation& now) { recorder.step(now); });
  recorder.close();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return s.state_hash();
}

}  // namespace

TEST(BeamResults, ContainNodesSectionForcesAndTensions) {
  const test::Scratch scratch;
  const std::string folder = scratch / "out";
  const Model model = io::read_model_text(kModel, "mast.yaml");
  Simulation s(model);
  io::Recorder recorder(s, folder, {});
  s.run([&](Simulation& now) { recorder.frame(now); });
  recorder.close();
  const hid_t file = H5Fopen((folder + "/results.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  std::vector<hsize_t> dims;
  const std::vector<double> x = numbers(file, "/beams/mast/nodes/position", dims);
  ASSERT_THAT(dims, ElementsAre(5, 5, 3));
  const BeamReport beam = s.beam(0);
  const CableReport rope = s.cable(1);
  for (std::size_t c = 0; c < 3; ++c)  // of the last frame's last node
    EXPECT_EQ(x[4 * 15 + 12 + c], beam.position[4][static_cast<Eigen::Index>(c)]);
  const std::vector<double> q = numbers(file, "/beams/mast/nodes/orientation", dims);
  EXPECT_THAT(dims, ElementsAre(5, 5, 4));
  EXPECT_NEAR(Quat(q[0], q[1], q[2], q[3]).angularDistance(beam.orientation[0]), 0.0, 1e-9);
  for (const auto& [name, first, of] : {std::tuple("force", 0, &beam.forces),
                                        {"moment", 3, &beam.forces},
                                        {"strain", 0, &beam.strains},
                                        {"curvature", 3, &beam.strains}}) {
    const std::vector<double> v = numbers(file, "/beams/mast/elements/" + std::string(name), dims);
    ASSERT_THAT(dims, ElementsAre(5, 4, 3)) << name;
    for (std::size_t e = 0; e < 4; ++e) EXPECT_EQ(v[4 * 12 + 3 * e], (*of)[e][first]) << name << e;
  }
  const std::vector<double> tension = numbers(file, "/cables/rope/tension", dims);
  ASSERT_THAT(dims, ElementsAre(5, 3));
  EXPECT_EQ(tension.back(), rope.tension.back());
  numbers(file, "/cables/stay/position", dims);
  EXPECT_THAT(dims, ElementsAre(5, 2, 3));
  numbers(file, "/beams/mast/nodes/reference", dims);
  EXPECT_THAT(dims, ElementsAre(5, 3));
  numbers(file, "/bodies/stone/position", dims);
  EXPECT_THAT(dims, ElementsAre(5, 3));
  // Nodes have no group of views; the joint that holds the mast has one.
  EXPECT_LE(H5Lexists(file, "/bodies/mast.1", H5P_DEFAULT), 0);
  numbers(file, "/joints/mast.start/force", dims);
  H5Fclose(file);
}

TEST(BeamResults, RecordProbesOfElementsAndCablePieces) {
  const test::Scratch scratch;
  run_into(scratch / "out", kModel);
  const std::vector<std::string> top = lines_of(scratch / "out/probes/top.csv");
  ASSERT_EQ(top.size(), 6u);
  EXPECT_EQ(
      top[0],
      "t [s],fx [N],fy [N],fz [N],mx [N m],my [N m],mz [N m],strain x [-],strain y [-],strain "
      "z [-],curvature x [1/m],curvature y [1/m],curvature z [1/m]");
  const std::vector<std::string> pull = lines_of(scratch / "out/probes/pull.csv");
  ASSERT_EQ(pull.size(), 6u);
  EXPECT_EQ(pull[0], "t [s],tension [N],length [m]");
  // The force at the start is zero to the round-off of its length.
  EXPECT_NEAR(std::stod(pull[1].substr(2)), 0.0, 1e-9);
}

TEST(BeamResults, WriteLinesWithTheirForcesForParaview) {
  const test::Scratch scratch;
  run_into(scratch / "out", kModel);
  const std::string view = io::read_file(scratch / "out/paraview/lines/000004.vtp");
  EXPECT_THAT(view, HasSubstr(R"(NumberOfPoints="11" NumberOfLines="8")"));
  EXPECT_EQ(array(view, "points").size(), 33u);
  const std::vector<float> radius = array(view, "radius"), force = array(view, "force");
  ASSERT_EQ(radius.size(), 11u);
  EXPECT_FLOAT_EQ(radius[0], 0.01F);
  ASSERT_EQ(force.size(), 24u);
  EXPECT_GT(force[3 * 5], 0.0F);  // the rope is taut
  // results.pvd contains the bodies that the user named.
  const std::string bodies = io::read_file(scratch / "out/paraview/results/000004.vtp");
  EXPECT_THAT(bodies, HasSubstr(R"(NumberOfPolys="12")"));  // the cube of the stone
}

TEST(BeamResults, ContinueInTheSameBitsAfterARestart) {
  const test::Scratch scratch;
  std::string viscous = kModel;
  viscous.replace(viscous.find("density: 8000"), 13,
                  "density: 8000, viscosity: {relaxation_time: 1 ms}");
  const Model model = io::read_model_text(viscous, "mast.yaml");
  Simulation straight(model);
  for (int k = 0; k < 4; ++k) {
    if (k == 2)
      io::write_checkpoint(scratch / "half.pst", model, straight.system(), straight.state());
    ASSERT_TRUE(straight.step(1.0).accepted);
  }
  Simulation continued(model, io::read_checkpoint(scratch / "half.pst", model, straight.system()));
  for (int k = 2; k < 4; ++k) ASSERT_TRUE(continued.step(1.0).accepted);
  EXPECT_EQ(continued.state_hash(), straight.state_hash());
}

// Section forces of cantilevers under their weight: at the foot of a horizontal one the weight as
// shear and weight × L/2 as moment; the axial force of a vertical one is its weight.
TEST(BeamResults, HaveSectionForcesThatBalanceTheWeight) {
  std::string text = kModel;
  const auto cut = [&](const char* from, const char* to) {
    const std::size_t at = text.find(from);
    text.erase(at, text.find(to) - at);
  };
  cut("cables:", "analysis:");
  cut("output:", "nothing");
  // Viscosity brings it to rest: relaxation of the lowest mode in some periods.
  text.replace(text.find("density: 8000"), 13,
               "density: 8000, viscosity: {relaxation_time: 10 ms}");
  text.replace(text.find("duration: 4 ms, step: 1 ms"), 26,
               "duration: 3, step: 10 ms, rho_inf: 0.5");
  Simulation s(io::read_model_text(text, "mast.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  const BeamReport beam = s.beam(0);
  const double weight = 8000.0 * std::numbers::pi * 1e-4 * 2.0 * 10.0;
  // An element's force is that at its middle: 7/8 of the weight is above the first.
  EXPECT_NEAR(beam.forces[0][0], -7.0 / 8.0 * weight, 1e-4 * weight);
  EXPECT_NEAR(beam.strains[0][0], beam.forces[0][0] / (2e11 * std::numbers::pi * 1e-4), 1e-12);
  EXPECT_NEAR(s.joint(0).force.z(), weight, 1e-4 * weight);
}

TEST(BeamResults, ReportInvalidProbes) {
  Model model = io::read_model_text(kModel, "mast.yaml");
  const test::Scratch scratch;
  model.output.probes[1].element = 4;
  const Simulation s(model);
  EXPECT_THROW(io::Recorder(s, scratch / "out", {}), InputError);
}

}  // namespace polhode::beam_results_tests
