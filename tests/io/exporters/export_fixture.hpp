// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/exporters/export_model.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/model/whole_mass.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/paths.hpp>
#include <support/scratch.hpp>

namespace polhode::test {

/// Models that are exported to a folder and read again by the importer of the format.
class Exports : public testing::Test {
 protected:
  static Model model_of(const std::string& text, const io::Overrides& overrides = {}) {
    return io::read_model_text("format: 1\ngravity: [0, 0, -9.81]\n" + text, "model.yaml",
                               overrides);
  }
  [[nodiscard]] io::Exported exported(const Model& model, const std::string& file,
                                      bool partial = false) const {
    return io::export_model(Simulation(model), {folder_ / file, partial});
  }
  /// The model that its file gives. @param overrides  Options of the import.
  [[nodiscard]] Model again(const Model& model, const std::string& file,
                            const io::Overrides& overrides = {}) const {
    std::ofstream(folder_ / file) << exported(model, file).text;
    Model read = io::read_model(folder_ / file, overrides);
    read.analysis = model.analysis;
    return read;
  }
  /// Message of a model that is refused.
  [[nodiscard]] std::string fault(const std::string& text, const std::string& file) const {
    return fault(model_of(text), file);
  }
  [[nodiscard]] std::string fault(const Model& model, const std::string& file) const {
    try {
      static_cast<void>(exported(model, file));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  /// Notes of an export, one a line.
  [[nodiscard]] std::string notes(const std::string& text, const std::string& file,
                                  bool partial = false) const {
    std::string list;
    for (const io::ExportNote& n : exported(model_of(text), file, partial).notes)
      list += format("{}: {}: {}\n", io::word_of(n.kind), n.path, n.what);
    return list;
  }

  /// Compares mass, centre of mass, inertia and mobility at the start, and the motion of every body
  /// over one second.
  static void expect_same(Model a, Model b, double step, double mass_error, double motion_error) {
    a.analysis.step = b.analysis.step = step;
    Simulation first(std::move(a)), second(std::move(b));
    const auto at_start = [](const Simulation& s) {
      Model placed = s.model();
      for (std::size_t i = 0; i < placed.bodies.size(); ++i) {
        placed.bodies[i].position = s.body(static_cast<int>(i)).r;
        placed.bodies[i].orientation = s.body(static_cast<int>(i)).q;
      }
      return whole_mass(placed);
    };
    const auto m = at_start(first), n = at_start(second);
    EXPECT_NEAR(n.mass, m.mass, mass_error);
    EXPECT_NEAR((n.com - m.com).norm(), 0.0, mass_error);
    EXPECT_NEAR((n.inertia - m.inertia).norm(), 0.0, mass_error);
    EXPECT_EQ(rank_report(first.system(), first.state()).mobility,
              rank_report(second.system(), second.state()).mobility);
    while (first.time() < 0.9999) first.step(1.0);
    while (second.time() < 0.9999) second.step(1.0);
    for (const BodySpec& body : first.model().bodies) {
      if (body.fixed) continue;
      const BodyMotion x = first.body(body.name), y = second.body(body.name);
      // The importer's coordinates are those of the link, and the centre of mass is the same.
      EXPECT_NEAR((x.r - y.r).norm(), 0.0, motion_error) << body.name << " at " << step;
      EXPECT_NEAR((x.omega() - y.omega()).norm(), 0.0, 10.0 * motion_error) << body.name;
      EXPECT_NEAR((x.Lambda() - y.Lambda()).norm(), 0.0, motion_error) << body.name;
    }
  }

  test::Scratch folder_;
};

}  // namespace polhode::test
