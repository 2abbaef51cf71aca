// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/recorder.hpp>

#include <filesystem>
#include <limits>
#include <optional>

#include <polhode/io/csv_probes.hpp>
#include <polhode/io/file_error.hpp>
#include <polhode/io/paraview.hpp>
#include <polhode/io/results_format.hpp>

namespace polhode {

struct Recorder::Impl {
  std::optional<ResultsFile> results;
  std::optional<ParaviewWriter> paraview;
  std::optional<SolidsWriter> solids;
  std::optional<LinesWriter> lines;
  std::optional<CsvProbes> probes;
  double last_frame = -std::numeric_limits<double>::infinity();
  std::size_t frames = 0;
};

Recorder::Recorder(const Simulation& simulation, const std::string& folder,
                   const Provenance& provenance, bool restarted)
    : impl_(std::make_unique<Impl>()) {
  const OutputSpec& output = simulation.model().output;
  const std::optional<double> keep =
      restarted ? std::optional<double>(simulation.time()) : std::nullopt;
  make_folder(folder);
  if (output.hdf5) {
    const std::string path = folder + "/" + results::kFileName;
    const ResultsLayout layout = results_layout(simulation);
    if (keep && std::filesystem::exists(path))
      impl_->results.emplace(ResultsFile::append_to(path, layout, *keep));
    else
      impl_->results.emplace(path, layout, provenance);
    // The start of a continued run is an instant the earlier run has dealt with already.
    if (impl_->results->frames() > 0) impl_->last_frame = simulation.time();
  }
  if (output.paraview)
    impl_->paraview.emplace(folder + "/paraview", "results",
                            body_pictures(simulation.model(), simulation.system().length_scale()),
                            keep);
  if (output.paraview && !simulation.solids().empty()) {
    std::vector<std::string> names;
    std::vector<const Mesh*> meshes;
    for (std::size_t i = 0; i < simulation.solids().size(); ++i) {
      names.push_back(simulation.model().solids[i].name);
      meshes.push_back(&simulation.solids()[i].plan.mesh);
    }
    impl_->solids.emplace(folder + "/paraview", "solids", std::move(names), std::move(meshes),
                          keep);
  }
  const Model& model = simulation.model();
  if (output.paraview && !(model.beams.empty() && model.cables.empty()))
    impl_->lines.emplace(folder + "/paraview", "lines", model, simulation.system().length_scale(),
                         keep);
  if (output.csv) impl_->probes.emplace(simulation, folder + "/probes", keep);
}

Recorder::~Recorder() = default;

void Recorder::frame(const Simulation& simulation) {
  if (simulation.time() <= impl_->last_frame) return;
  impl_->last_frame = simulation.time();
  if (impl_->results) impl_->results->append(results_frame(simulation));
  if (impl_->paraview) {
    std::vector<BodyMotion> motions;
    for (std::size_t i = 0; i < simulation.model().bodies.size(); ++i)
      motions.push_back(simulation.body(static_cast<int>(i)));
    impl_->paraview->append(simulation.time(), motions);
  }
  if (impl_->solids) {
    std::vector<SolidReport> reports;
    for (int i = 0; i < static_cast<int>(simulation.solids().size()); ++i)
      reports.push_back(simulation.solid(i));
    impl_->solids->append(simulation.time(), reports);
  }
  if (impl_->lines) {
    std::vector<BeamReport> beams;
    for (std::size_t i = 0; i < simulation.model().beams.size(); ++i)
      beams.push_back(simulation.beam(static_cast<int>(i)));
    std::vector<CableReport> cables;
    for (std::size_t i = 0; i < simulation.model().cables.size(); ++i)
      cables.push_back(simulation.cable(static_cast<int>(i)));
    impl_->lines->append(simulation.time(), beams, cables);
  }
  ++impl_->frames;
}

void Recorder::step(const Simulation& simulation) {
  if (impl_->probes) impl_->probes->record(simulation);
}

void Recorder::close() {
  if (impl_->results) impl_->results->close();
  if (impl_->paraview) impl_->paraview->close();
  if (impl_->solids) impl_->solids->close();
  if (impl_->lines) impl_->lines->close();
  if (impl_->probes) impl_->probes->flush();
}

std::size_t Recorder::frames() const {
  return impl_->results ? impl_->results->frames() : impl_->frames;
}

}  // namespace polhode
