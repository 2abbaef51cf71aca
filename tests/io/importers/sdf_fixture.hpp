// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::sdf_tests {

/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

const std::string kInertial =
    "<inertial><mass>2</mass><inertia><ixx>0.3</ixx><iyy>0.3</iyy><izz>0.2</izz></inertia>"
    "</inertial>";

inline std::string link(const std::string& name, const std::string& inside = "",
                        const std::string& inertial = kInertial) {
  return "<link name='" + name + "'>" + inertial + inside + "</link>\n";
}
inline std::string pose(const std::string& text, const std::string& relative_to = "") {
  return "<pose relative_to='" + relative_to + "'>" + text + "</pose>";
}
inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent>" + parent + "</parent><child>" +
         child + "</child>" + inside + "</joint>\n";
}
inline std::string axis(const std::string& xyz, const std::string& inside = "",
                        const std::string& tag = "axis") {
  return "<" + tag + "><xyz>" + xyz + "</xyz>" + inside + "</" + tag + ">";
}
inline std::string model(const std::string& name, const std::string& inside) {
  return "<model name='" + name + "'>\n" + inside + "</model>\n";
}
inline std::string sdf(const std::string& inside, const std::string& version = "1.10") {
  return "<sdf version='" + version + "'>\n" + inside + "</sdf>\n";
}

class SdfFixture : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = std::filesystem::path(folder_ / name);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
    return path.string();
  }
  /// A file with this text.
  Model read_text(const std::string& text, const io::Overrides& overrides = {}) {
    return io::read_model(write("robot.sdf", text), overrides);
  }
  /// A file with a model that contains this.
  Model read(const std::string& inside, const io::Overrides& overrides = {}) {
    return read_text(sdf(model("m", inside)), overrides);
  }
  /// Message of a file that is refused.
  std::string text_fault(const std::string& text, const io::Overrides& overrides = {}) {
    try {
      static_cast<void>(read_text(text, overrides));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  std::string fault(const std::string& inside, const io::Overrides& overrides = {}) {
    return text_fault(sdf(model("m", inside)), overrides);
  }
  /// What a report says, one note a line.
  std::string notes(const std::string& inside, const io::Overrides& overrides = {}) {
    write("robot.sdf", sdf(model("m", inside)));
    std::string text;
    for (const io::ImportNote& n :
         io::expanded_model(folder_ / "robot.sdf", overrides).report.notes)
      text += format("{}: {}: {}\n", n.place.line, io::word_of(n.kind), n.what);
    return text;
  }
  static const BodySpec& body(const Model& model, const std::string& name) {
    for (const BodySpec& b : model.bodies)
      if (b.name == name) return b;
    throw std::out_of_range("no body " + name);
  }
  static int freedoms(const Model& model) {
    const Simulation simulation(model);
    return 6 * simulation.system().body_count() - simulation.system().rows();
  }

  test::Scratch folder_;
};

/// A simulation of a model after some time.
inline Simulation run(Model model, double step, double duration) {
  model.analysis.step = step;
  Simulation simulation(std::move(model));
  while (simulation.time() < duration - 0.5 * step) simulation.step(duration);
  return simulation;
}

}  // namespace polhode::sdf_tests
