// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/write_results.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/io/results/results_reader.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/scratch.hpp>

namespace polhode::results_tests {
namespace {

using testing::HasSubstr;

io::ResultsLayout layout(int bodies) {
  io::ResultsLayout l;
  l.title = "Test";
  for (int i = 0; i < bodies; ++i) l.bodies.push_back("b" + std::to_string(i));
  l.joints = {{"hinge", "revolute", 1}, {"ball", "spherical", 3}, {"weld", "fixed", 0}};
  l.loads = {{"push", "force"}, {"spring", "spring_damper"}};
  return l;
}

/// A frame whose numbers are functions of the frame's number k and their place.
io::ResultsFrame frame(const io::ResultsLayout& l, int k) {
  io::ResultsFrame f;
  f.t = 0.5 * k;
  for (std::size_t i = 0; i < l.bodies.size(); ++i) {
    f.position.emplace_back(k, static_cast<double>(i), 0.25);
    f.velocity.emplace_back(-k, 1.0, 2.0);
    f.angular_velocity.emplace_back(k, 2.0 * k, 3.0 * k);
    f.orientation.emplace_back(-0.5, 0.5, 0.5, 0.5);  // w < 0: shown with the other sign.
  }
  for (std::size_t j = 0; j < l.joints.size(); ++j) {
    f.force.emplace_back(k, static_cast<double>(j), 7.0);
    f.moment.emplace_back(1.0, 2.0, k);
  }
  for (int c = 0; c < l.coordinates(); ++c) {
    f.coordinates.push_back(10.0 * c + k);
    f.rates.push_back(-10.0 * c - k);
  }
  for (int c = 0; c < l.load_numbers(); ++c) f.loads.push_back(10.0 * c + k);
  f.balance.kinetic = k;
  f.balance.potential = 2.0 * k;
  f.steps = k;
  return f;
}

/// Runs a Python text with h5py and returns what it prints; "no h5py" if there is none.
std::string python(const std::string& code) {
  const test::Scratch scratch;
  std::ofstream(scratch / "code.py") << code;
  const std::string interpreter =
      std::filesystem::exists("/usr/bin/python3") ? "/usr/bin/python3" : "python3";
  if (std::system((interpreter + " -c 'import h5py' 2>/dev/null").c_str()) != 0) return "no h5py";
  std::FILE* pipe = popen((interpreter + " " + (scratch / "code.py") + " 2>&1").c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  pclose(pipe);
  return output;
}

// Readers find no file or one that they can open, also while it is written, when it looks longer.
TEST(ResultsFile, HasItsNameFromItsFirstFrameOn) {
  const test::Scratch scratch;
  const std::string path = scratch / "results.h5";
  const io::ResultsLayout l = layout(2);
  io::ResultsFile file(path, l, {});
  EXPECT_FALSE(std::filesystem::exists(path));
  file.append(frame(l, 0));
  EXPECT_EQ(io::ResultsReader(path).frames(), 1U);
  const std::uintmax_t during = std::filesystem::file_size(path);
  for (int k = 1; k < 10; ++k) file.append(frame(l, k));
  file.sync();
  EXPECT_EQ(io::ResultsReader(path).frames(), 10U);
  EXPECT_EQ(file.last_time(), 4.5);
  file.close();
  EXPECT_EQ(io::ResultsReader(path).frames(), 10U);
  EXPECT_LT(std::filesystem::file_size(path), during);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch / ""), {}), 1);
}

TEST(ResultsFile, IsReadWithThreeLinesOfPython) {
  const test::Scratch scratch;
  const io::ResultsLayout l = layout(3);
  io::ResultsFile file(scratch / "results.h5", l,
                       {.version = "1.2.3", .model_text = "format: 1\n"});
  for (int k = 0; k < 5; ++k) file.append(frame(l, k));
  file.close();
  const std::string output = python(R"(
import h5py
results = h5py.File(")" + scratch / "results.h5" +
                                    R"(")
print(results["time"][:], results["bodies/b2/position"][:, 0])
print(results["bodies/b1/orientation"][4], results["bodies/b1/position"].attrs["unit"])
print(results["joints/ball/coordinates"][2], results["joints/hinge/force"][3], "weld" in results["joints"])
spring = results["loads/spring"]
print(spring["force"][2], spring["length"][4], spring["rate"].attrs["unit"], results["packed/loads/first"][1])
print(results["packed/bodies/position"].shape, results["packed/bodies/names"].asstr()[:])
print(results["energy/total"][4], results["solver/steps"][4], results["solver/steps"].dtype)
print(results["provenance"].attrs["version"], results["provenance/model"].asstr()[0])
)");
  if (output == "no h5py") GTEST_SKIP() << "h5py is not installed";
  EXPECT_EQ(output,
            "[0.  0.5 1.  1.5 2. ] [0. 1. 2. 3. 4.]\n"
            "[ 0.5 -0.5 -0.5 -0.5] m\n"
            "[12. 22. 32.] [3. 0. 7.] True\n"
            "[32. 42. 52.] 64.0 m/s 3\n"
            "(5, 3, 3) ['b0' 'b1' 'b2']\n"
            "12.0 4 int64\n"
            "1.2.3 format: 1\n\n");
}

/// Data sets of joints with friction or limits; other joints have none.
TEST(ResultsFile, ContainsFrictionAndStopsOfJoints) {
  const test::Scratch scratch;
  io::ResultsLayout l = layout(1);
  l.joints = {{"free", "revolute", 1, 0, 0},
              {"bush", "cylindrical", 2, 2, 1},
              {"pin", "revolute", 1, 1, 0},
              {"gate", "prismatic", 1, 0, 1}};
  io::ResultsFile file(scratch / "results.h5", l, {});
  for (int k = 0; k < 3; ++k) {
    io::ResultsFrame f = frame(l, k);
    f.friction = {1.0 + k, 2.0 + k, 3.0 + k};
    f.slips = {0.0, static_cast<double>(k % 2)};
    f.stops = {-1.0 - k, 5.0 + k};
    file.append(f);
  }
  file.close();
  const std::string output = python(R"(
import h5py
results = h5py.File(")" + scratch / "results.h5" +
                                    R"(")
joints = results["joints"]
print(joints["bush/friction"][2], joints["pin/friction"][1], joints["pin/friction"].attrs["unit"])
print(joints["pin/slips"][:], joints["pin/slips"].dtype, joints["bush/stops"][1], joints["gate/stops"][2])
print([name for name in joints["free"]], "stops" in joints["pin"], "friction" in joints["gate"])
)");
  if (output == "no h5py") GTEST_SKIP() << "h5py is not installed";
  EXPECT_EQ(output,
            "[3. 4.] [4.] N or N m\n"
            "[0 1 0] int64 [-2.] [7.]\n"
            "['coordinates', 'force', 'moment', 'rates'] False False\n");
}

/// Data sets of solids: nodes and elements of all solids in sequence, interfaces by name.
TEST(ResultsFile, ContainsDeformableSolids) {
  const test::Scratch scratch;
  solids::Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.blocks = {{"tet4", {0, 1, 2, 3, 0, 2, 1, 4}}};
  io::ResultsLayout l = layout(1);
  l.solids = {{"pad", &mesh, mesh.nodes, {"b0", "lid"}}};
  io::ResultsFile file(scratch / "results.h5", l, {});
  for (int k = 0; k < 3; ++k) {
    io::ResultsFrame f = frame(l, k);
    SolidReport report;
    for (int i = 0; i < 5; ++i) {
      report.displacement.emplace_back(k, i, 0.5);
      report.velocity.emplace_back(i, k, -0.5);
    }
    report.elements.resize(2);
    for (int e = 0; e < 2; ++e) {
      report.elements[static_cast<std::size_t>(e)].volume = 1.0 / 6.0;
      report.elements[static_cast<std::size_t>(e)].cauchy(2, 2) = 10.0 * k + e;
      report.elements[static_cast<std::size_t>(e)].strain_energy_density = e;
    }
    // Means over the adjacent elements.
    report.nodal.cauchy.assign(5, Mat3::Zero());
    report.nodal.von_mises = {0, 0, 0, 10.0 * k, 10.0 * k + 1.0};
    report.nodal.strain_energy_density = {0.5, 0.5, 0.5, 0.0, 1.0};
    report.nodal.stress_error = {0.25, 0.75};
    f.solids = {report};
    f.interfaces.emplace_back(2);
    f.interfaces[0][0].force = {1.0 * k, 2.0, 3.0};
    f.interfaces[0][1].moment = {4.0, 5.0, 6.0 * k};
    file.append(f);
  }
  file.close();
  const std::string output = python(R"(
import h5py
pad = h5py.File(")" + scratch / "results.h5" +
                                    R"(")["solids/pad"]
print(pad["nodes/displacement"].shape, pad["nodes/displacement"][2, 4], pad["nodes/velocity"][1, 3])
print(pad["elements/cauchy"][2, 1], pad["elements/von_mises"][1], pad["nodes/von_mises"][1, [3, 4]])
print(pad["nodes/strain_energy_density"][0], pad["elements/principal_stretches"].shape)
first, last = pad["elements/offsets"][1:3]
print(pad["elements/connectivity"][first:last], pad["elements/vtk_type"][:], pad["nodes/reference"][4])
print(pad["interfaces/b0/force"][1], pad["interfaces/lid/moment"][2], pad["nodes/cauchy"].attrs["unit"])
)");
  if (output == "no h5py") GTEST_SKIP() << "h5py is not installed";
  EXPECT_EQ(output,
            "(3, 5, 3) [2.  4.  0.5] [ 3.   1.  -0.5]\n"
            "[ 0.  0. 21.  0.  0.  0.] [10. 11.] [10. 11.]\n"
            "[0.5 0.5 0.5 0.  1. ] (3, 2, 3)\n"
            "[0 2 1 4] [10 10] [ 0.  0. -1.]\n"
            "[1. 2. 3.] [ 4.  5. 12.] Pa\n");
}

TEST(ResultsFile, ContinuesAtATimeAndDropsLaterFrames) {
  const test::Scratch scratch;
  const io::ResultsLayout l = layout(2);
  {
    io::ResultsFile file(scratch / "results.h5", l, {});
    for (int k = 0; k < 8; ++k) file.append(frame(l, k));
  }
  io::ResultsFile file = io::ResultsFile::append_to(scratch / "results.h5", l, 1.5);
  EXPECT_EQ(file.frames(), 4u);  // Times 0, 0.5, 1 and 1.5.
  file.append(frame(l, 100));
  file.close();
  io::ResultsFile again = io::ResultsFile::append_to(scratch / "results.h5", l, 1e9);
  EXPECT_EQ(again.frames(), 5u);
}

TEST(ResultsFile, RefusesToContinueTheResultsOfAnotherModel) {
  const test::Scratch scratch;
  { io::ResultsFile file(scratch / "results.h5", layout(2), {}); }
  try {
    (void)io::ResultsFile::append_to(scratch / "results.h5", layout(3), 0.0);
    FAIL() << "continued";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("belongs to another model"));
    EXPECT_THAT(error.what(), HasSubstr("-o"));
  }
}

TEST(ResultsFile, NamesTheFileItCannotWrite) {
  try {
    io::ResultsFile file("/no/such/folder/results.h5", layout(1), {});
    FAIL() << "written";
  } catch (const io::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/folder/results.h5: cannot be written"));
  }
}

TEST(ResultsFile, ContainsAModelWithoutJointsAndLoads) {
  const test::Scratch scratch;
  io::ResultsLayout l = layout(1);
  l.joints.clear();
  l.loads.clear();
  io::ResultsFile file(scratch / "results.h5", l, {});
  file.append(frame(l, 0));
  EXPECT_NO_THROW(file.close());
}

// The number of complete frames is the length of `time`; a writer that is killed at any moment
// leaves at least the frames older than its buffering time.
TEST(ResultsFile, IsWholeAfterItsWriterWasKilled) {
  const test::Scratch scratch;
  const io::ResultsLayout l = layout(20);
  for (const int milliseconds : {60, 137, 211, 305}) {
    const std::string path = scratch / "killed.h5";
    int first_frame[2];  // The writer signals that the first frame is written.
    ASSERT_EQ(pipe(first_frame), 0);
    const pid_t writer = fork();
    if (writer == 0) {
      alarm(10);  // The process ends even if the test is killed.
      io::ResultsFile file(path, l, {});
      for (int k = 0;; ++k) {
        file.append(frame(l, k));
        if (k == 0 && ::write(first_frame[1], "1", 1) != 1) _exit(1);
      }
    }
    char byte = 0;
    ASSERT_EQ(::read(first_frame[0], &byte, 1), 1);
    for (const int end : first_frame) close(end);
    usleep(static_cast<useconds_t>(1000 * milliseconds));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const std::string output = python(R"(
import h5py
f = h5py.File(")" + path + R"(")
n = len(f["time"])
k = 2 * f["time"][:]
good = n > 0 and list(k) == list(range(n))
for name in ["bodies/b7/position", "packed/bodies/angular_velocity", "joints/hinge/force"]:
    good = good and (f[name][:n].reshape(n, -1)[:, 0] == k).all()
print(good and (f["energy/potential"][:n] == 2 * k).all() and (f["solver/steps"][:n] == k).all())
)");
    if (output == "no h5py") GTEST_SKIP() << "h5py is not installed";
    EXPECT_EQ(output, "True\n") << "killed after " << milliseconds << " ms";
  }
}

}  // namespace
}  // namespace polhode::results_tests
