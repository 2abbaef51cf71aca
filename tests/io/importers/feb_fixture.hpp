// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::feb_tests {

/// A coarse step, the usual one and a hundredth of that [s].
constexpr double kSteps[] = {1e-2, 1e-3, 1e-5};
/// Error of positions and angles of size 1 at second order; 1e-9 is what iterations leave.
inline double error_at(double step) { return 10.0 * step * step + 1e-9; }

inline std::string tag(const std::string& name, const std::string& inside,
                       const std::string& attributes = "") {
  return "<" + name + (attributes.empty() ? "" : " ") + attributes + ">" + inside + "</" + name +
         ">\n";
}
inline std::string typed(const std::string& name, const std::string& type,
                         const std::string& inside) {
  return tag(name, inside, "type='" + type + "'");
}
inline std::string control(const std::string& analysis = "DYNAMIC", int steps = 1000,
                           double step = 1e-3, const std::string& inside = "") {
  return tag("Control", tag("analysis", analysis) + tag("time_steps", format("{}", steps)) +
                            tag("step_size", format("{}", step)) + inside);
}
inline std::string rigid(int id, const std::string& name, const std::string& inside = "") {
  return tag("material", tag("density", "1000") + inside,
             format("id='{}' name='{}' type='rigid body'", id, name));
}
/// Nodes and one hexahedron of a block.
/// @param first  Number of the first node, and of the element.
inline std::string block(int first, const std::string& name, const Vec3& from, const Vec3& to) {
  const double x[2] = {from.x(), to.x()}, y[2] = {from.y(), to.y()}, z[2] = {from.z(), to.z()};
  static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::string nodes, list;
  for (int k = 0; k < 8; ++k) {
    nodes += tag("node", format("{},{},{}", x[corner[k][0]], y[corner[k][1]], z[corner[k][2]]),
                 format("id='{}'", first + k));
    list += format("{}{}", k > 0 ? "," : "", first + k);
  }
  return tag("Nodes", nodes) + tag("Elements", tag("elem", list, format("id='{}'", first)),
                                   "type='hex8' name='" + name + "'");
}
inline std::string domain(const std::string& name, const std::string& material) {
  return "<SolidDomain name='" + name + "' mat='" + material + "'/>\n";
}
inline std::string fixed(const std::string& body, const std::string& freedoms) {
  std::string inside = tag("rb", body);
  static const char* const names[] = {"Rx", "Ry", "Rz", "Ru", "Rv", "Rw"};
  for (std::size_t k = 0; k < 6; ++k)
    inside += tag(std::string(names[k]) + "_dof", std::string(1, freedoms[k]));
  return typed("rigid_bc", "rigid_fixed", inside);
}
inline std::string connector(const std::string& type, const std::string& inside,
                             const std::string& a = "base", const std::string& b = "bar") {
  return tag("rigid_connector", tag("body_a", a) + tag("body_b", b) + inside,
             "name='link' type='" + type + "'");
}
inline std::string curve(int id, const std::string& points, const std::string& rule = "LINEAR",
                         const std::string& extend = "CONSTANT") {
  std::string list;
  std::size_t at = 0;
  while (at < points.size()) {
    const std::size_t end = std::min(points.find(';', at), points.size());
    list += tag("pt", points.substr(at, end - at));
    at = end + 1;
  }
  return tag("load_controller",
             tag("interpolate", rule) + tag("extend", extend) + tag("points", list),
             format("id='{}' type='loadcurve'", id));
}
inline std::string feb(const std::string& inside) {
  return "<febio_spec version='4.0'>\n<Module type='solid'/>\n" + inside + "</febio_spec>\n";
}

/// Mass and side lengths of the block "bar" below.
constexpr double kMass = 1000 * 1.0 * 0.2 * 0.4;
/// Its moments about its centre [kg m²].
const Vec3 kMoments = kMass / 12.0 * Vec3(0.04 + 0.16, 1.0 + 0.16, 1.0 + 0.04);

/// A fixed body "base" without a mesh, and a block "bar" with its centre at the origin.
inline std::string two_bodies(const std::string& control_text, const std::string& rigid_section,
                              const std::string& more = "") {
  return feb(control_text +
             tag("Material", rigid(1, "base", tag("center_of_mass", "0,0,0")) + rigid(2, "bar")) +
             tag("Mesh", block(1, "part", Vec3(-0.5, -0.1, -0.2), Vec3(0.5, 0.1, 0.2))) +
             tag("MeshDomains", domain("part", "bar")) +
             tag("Rigid", fixed("base", "111111") + rigid_section) + more);
}

class FebFixture : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = folder_ / name;
    std::ofstream(path) << text;
    return path;
  }
  Model read(const std::string& text, const io::Overrides& overrides = {}) {
    return io::read_model(write("model.feb", text), overrides);
  }
  /// Message of a file that is refused.
  std::string fault(const std::string& text, const io::Overrides& overrides = {}) {
    try {
      static_cast<void>(read(text, overrides));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  /// What a report says, one note a line.
  std::string notes(const std::string& text, const io::Overrides& overrides = {}) {
    const std::string path = write("model.feb", text);
    std::string list;
    for (const io::ImportNote& n : io::expanded_model(path, overrides).report.notes)
      list += format("{}: {}: {}\n", n.place.line, io::word_of(n.kind), n.what);
    return list;
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
  /// A simulation of a model up to a time, with its own step or another one.
  static Simulation run(Model model, double until, double step = 0.0) {
    if (step > 0.0) model.analysis.step = step;
    model.analysis.duration = until;
    Simulation simulation(std::move(model));
    while (simulation.time() < until * (1.0 - 1e-9)) simulation.step(until);
    return simulation;
  }

  test::Scratch folder_;
};

}  // namespace polhode::feb_tests
