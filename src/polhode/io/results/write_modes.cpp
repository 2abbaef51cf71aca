// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/io/results/paraview.hpp>
#include <polhode/io/results/write_modes.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode::io {

namespace {

/// Largest displacement in a picture, as a part of the model's size.
constexpr double kShown = 0.1;

std::vector<Channel> channels(std::size_t bodies, std::size_t nodes) {
  std::vector<Channel> list{{"/number", {}, "-"},
                            {"/frequency", {}, "Hz"},
                            {"/damping_ratio", {}, "-"},
                            {"/kind", {}, "-"},
                            {"/eigenvalue", {2}, "rad/s"},
                            {"/omega_squared", {}, "rad^2/s^2"},
                            {"/participation", {3}, "kg^0.5"},
                            {"/effective_mass", {3}, "-"},
                            {"/residual", {}, "-"}};
  for (const std::string part : {"", "_imaginary"}) {
    if (bodies > 0) {
      list.push_back({"/bodies/displacement" + part, {bodies, 3}, "kg^-0.5"});
      list.push_back({"/bodies/rotation" + part, {bodies, 3}, "rad kg^-0.5 m^-1"});
    }
    if (nodes > 0) list.push_back({"/nodes/displacement" + part, {nodes, 3}, "kg^-0.5"});
  }
  return list;
}

/// Largest displacement of a mode: of bodies, with rotations times the model's size, and of nodes.
double largest_move(const ModalAnalysis& analysis, int mode, double size) {
  double most = 0.0;
  for (const bool imaginary : {false, true}) {
    for (int body = 0; body < static_cast<int>(analysis.model().bodies.size()); ++body) {
      const Vec6 x = analysis.body_shape(mode, body, imaginary);
      most = std::max({most, x.head<3>().norm(), size * x.tail<3>().norm()});
    }
    const std::vector<double> nodes = analysis.node_shapes(mode, imaginary);
    for (std::size_t k = 0; k + 2 < nodes.size(); k += 3)
      most = std::max(most, std::hypot(nodes[k], nodes[k + 1], nodes[k + 2]));
  }
  return most;
}

/// Solids in a mode: displaced nodes, stresses of the equilibrium.
std::vector<SolidReport> solids_in(const ModalAnalysis& analysis, int mode, bool imaginary,
                                   double factor) {
  const Simulation& simulation = analysis.simulation();
  const std::vector<double> shape = analysis.node_shapes(mode, imaginary);
  std::vector<SolidReport> reports;
  for (int i = 0; i < static_cast<int>(simulation.solids().size()); ++i) {
    SolidReport report = simulation.solid(i);
    const auto first =
        static_cast<std::size_t>(simulation.solids()[static_cast<std::size_t>(i)].first_node);
    for (std::size_t k = 0; k < report.position.size(); ++k) {
      const Vec3 x = factor * Eigen::Map<const Vec3>(shape.data() + 3 * (first + k));
      report.position[k] += x;
      report.displacement[k] = report.velocity[k] = x;
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

void write_pictures(const ModalAnalysis& analysis, const std::string& folder) {
  const Model& model = analysis.model();
  const Simulation& simulation = analysis.simulation();
  const double size = simulation.system().length_scale();
  std::vector<BodyPicture> pictures = body_pictures(model, size);
  ParaviewWriter writer(folder + "/paraview", "modes", pictures);
  std::optional<SolidsWriter> solids;
  if (!model.solids.empty()) {
    std::vector<std::string> names;
    std::vector<const solids::Mesh*> meshes;
    for (std::size_t i = 0; i < model.solids.size(); ++i) {
      names.push_back(model.solids[i].name);
      meshes.push_back(&simulation.solids()[i].plan.mesh);
    }
    solids.emplace(folder + "/paraview", "modes_solids", std::move(names), std::move(meshes));
  }
  const auto append = [&](int mode, bool imaginary, double factor, double time) {
    std::vector<BodyMotion> motions;
    for (const BodyPicture& picture : pictures) {
      const int body = model.body_index(picture.name);
      BodyMotion m = simulation.body(body);
      const Vec6 x = factor * analysis.body_shape(mode, body, imaginary);
      m.r += x.head<3>();
      m.q = (quaternion_from_rotation_vector(x.tail<3>()) * m.q).normalized();
      m.v = x.head<3>();
      m.W = m.q.conjugate() * Vec3(x.tail<3>());
      motions.push_back(m);
    }
    writer.append(time, motions);
    if (solids) solids->append(time, solids_in(analysis, mode, imaginary, factor));
  };
  for (int mode = 0; mode < static_cast<int>(analysis.report().modes.size()); ++mode) {
    const double most = largest_move(analysis, mode, size);
    const double factor = most > 0.0 ? kShown * size / most : 0.0;
    append(mode, false, factor, mode + 1.0);
    if (analysis.report().modes[static_cast<std::size_t>(mode)].shape_imag.size() > 0)
      append(mode, true, -factor, mode + 1.25);  // a quarter of a period later
  }
  writer.close();
  if (solids) solids->close();
}

}  // namespace

void write_modes(const ModalAnalysis& analysis, const std::string& folder,
                 const Provenance& provenance) {
  std::filesystem::create_directories(folder);
  const Model& model = analysis.model();
  const std::size_t bodies = model.bodies.size();
  const auto nodes = static_cast<std::size_t>(analysis.simulation().system().nodes().count());
  Hdf5File file(folder + "/modes.h5", channels(bodies, nodes), {});
  file.attribute("/", "format", "polhode modes");
  file.attribute("/", "format_version", 1.0);
  file.attribute("/", "title", model.title);
  file.attribute("/", "version", provenance.version);
  file.attribute("/", "model_file", provenance.model_file);
  std::vector<std::string> names;
  for (const BodySpec& body : model.bodies) names.push_back(body.name);
  if (bodies > 0) file.names("/bodies/names", names);
  std::vector<std::string> kinds;
  for (int kind = 0; kind <= static_cast<int>(ModeKind::free); ++kind)
    kinds.emplace_back(kind_name(static_cast<ModeKind>(kind)));
  file.names("/kinds", kinds);
  const ModesReport& report = analysis.report();
  for (std::size_t i = 0; i < report.modes.size(); ++i) {
    const Mode& mode = report.modes[i];
    std::vector<double> frame{static_cast<double>(i + 1),
                              mode.frequency,
                              mode.damping,
                              static_cast<double>(mode.kind),
                              mode.eigenvalue.real(),
                              mode.eigenvalue.imag(),
                              mode.omega_squared};
    frame.insert(frame.end(), mode.participation.begin(), mode.participation.end());
    frame.insert(frame.end(), mode.effective_mass.begin(), mode.effective_mass.end());
    frame.push_back(mode.residual);
    const auto number = static_cast<int>(i);
    for (const bool imaginary : {false, true}) {
      for (const int part : {0, 3})
        for (std::size_t body = 0; body < bodies; ++body) {
          const Vec6 x = analysis.body_shape(number, static_cast<int>(body), imaginary);
          for (int k = 0; k < 3; ++k) frame.push_back(x[part + k]);
        }
      const std::vector<double> d = analysis.node_shapes(number, imaginary);
      frame.insert(frame.end(), d.begin(), d.end());
    }
    file.append(frame);
  }
  file.close();
  if (model.output.paraview) write_pictures(analysis, folder);
}

}  // namespace polhode::io
