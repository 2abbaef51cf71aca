// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::mjcf_tests {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

const std::string kBall = "<inertial pos='0 0 0' mass='2' diaginertia='0.3 0.2 0.1'/>";

class Mjcf : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Model read(const std::string& inside, const io::Overrides& overrides = {}) {
    return io::read_model(write("robot.xml", "<mujoco>\n" + inside + "</mujoco>\n"), overrides);
  }
  Model read_bodies(const std::string& bodies, const io::Overrides& overrides = {}) {
    return read("<worldbody>" + bodies + "</worldbody>\n", overrides);
  }
  /// Message of a file that is refused.
  std::string fault(const std::string& inside, const io::Overrides& overrides = {}) {
    try {
      static_cast<void>(read(inside, overrides));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  std::string body_fault(const std::string& bodies) {
    return fault("<worldbody>" + bodies + "</worldbody>\n");
  }
  /// Notes of a report, one a line.
  std::string notes(const std::string& inside, const io::Overrides& overrides = {}) {
    write("robot.xml", "<mujoco>\n" + inside + "</mujoco>\n");
    std::string text;
    for (const io::ImportNote& n :
         io::expanded_model(folder_ / "robot.xml", overrides).report.notes)
      text += format("{}: {}: {}\n", n.place.line, io::word_of(n.kind), n.what);
    return text;
  }

  test::Scratch folder_;
};

inline const LoadSpec* load_of(const Model& model, const std::string& name) {
  for (const LoadSpec& load : model.loads)
    if (load.name == name) return &load;
  return nullptr;
}

}  // namespace polhode::mjcf_tests
