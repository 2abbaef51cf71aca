// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/recorder.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include <polhode/core/format.hpp>
#include <polhode/io/results/csv_probes.hpp>
#include <polhode/io/results/earlier_results.hpp>
#include <polhode/io/results/folder_lock.hpp>
#include <polhode/io/results/paraview.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/output_file.hpp>

namespace polhode::io {

namespace {

/// File events.csv: a line whenever a sensor's overlap begins or ends.
class SensorFile {
 public:
  SensorFile(std::string path, std::optional<double> keep) : path_(std::move(path)) {
    text_ = "t [s],sensor,event\n";
    if (keep && std::filesystem::exists(path_)) {
      std::istringstream lines(read_file(path_));
      std::string line;
      std::getline(lines, line);
      while (std::getline(lines, line))
        if (std::strtod(line.c_str(), nullptr) <= *keep * (1.0 + 1e-14)) text_ += line + "\n";
    }
    write_file_atomically(path_, text_, false);
  }
  void record(const std::vector<SensorEvent>& events) {
    if (done_ == events.size()) return;
    for (; done_ < events.size(); ++done_)
      text_ += format("{},{},{}\n", events[done_].t, events[done_].sensor,
                      events[done_].began ? "began" : "ended");
    write_file_atomically(path_, text_, false);
  }
  void sync() { write_file_atomically(path_, text_); }

 private:
  std::string path_, text_;
  std::size_t done_ = 0;
};

/// Contact points of bodies, then those of surfaces of solids and of cables, which are side a.
std::vector<contact::TouchingPoint> touching_points(const Simulation& simulation) {
  std::vector<contact::TouchingPoint> points = simulation.contact_points();
  int side = static_cast<int>(simulation.contact_map().body.size());
  const auto surfaces = static_cast<int>(simulation.contact_map().surfaces.size());
  for (int s = 0; s < surfaces; ++s, side += 2)
    for (const surface_contact::SurfacePointReport& p : simulation.surface_points(s)) {
      contact::TouchingPoint point;
      point.a = side;
      point.b = side + 1;
      point.point = p.point;
      point.normal = p.normal;
      point.force = p.force;
      point.friction = p.friction;
      point.gap = p.gap;
      points.push_back(point);
    }
  return points;
}

/// Removes what a killed run left half written.
void remove_unfinished(const std::string& folder) {
  for (const char* part : {"", "/probes", "/paraview"}) remove_unfinished_files(folder + part);
}

bool has_sensors(const Simulation& simulation) {
  const std::vector<ContactMap::Pair>& pairs = simulation.contact_map().pairs;
  return std::any_of(pairs.begin(), pairs.end(), [](const auto& p) { return !p.sensor.empty(); });
}

}  // namespace

struct Recorder::Impl {
  std::optional<FolderLock> lock;  // Given back last.
  std::optional<ResultsFile> results;
  std::optional<ParaviewWriter> paraview;
  std::optional<SolidsWriter> solids;
  std::optional<LinesWriter> lines;
  std::optional<ContactsWriter> contacts;
  std::optional<SensorFile> sensors;
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
  impl_->lock.emplace(folder, provenance.model_file);
  remove_unfinished(folder);
  if (!restarted) clear_earlier_results(folder);
  if (output.hdf5) {
    const std::string path = folder + "/" + results::kFileName;
    const ResultsLayout layout = results_layout(simulation);
    if (keep && std::filesystem::exists(path))
      impl_->results.emplace(ResultsFile::append_to(path, layout, *keep));
    else
      impl_->results.emplace(path, layout, provenance);
  }
  if (output.paraview)
    impl_->paraview.emplace(folder + "/paraview", "results",
                            body_pictures(simulation.model(), simulation.system().length_scale()),
                            keep);
  if (output.paraview && !simulation.solids().empty()) {
    std::vector<std::string> names;
    std::vector<const solids::Mesh*> meshes;
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
  if (output.paraview && simulation.has_contacts()) {
    std::vector<std::string> names;
    for (const BodySpec& body : model.bodies) names.push_back(body.name);
    for (const SolidSpec& solid : model.solids) names.push_back(solid.name);
    for (const CableLineSpec& cable : model.cables) names.push_back(cable.name);
    const auto number_of = [bodies = static_cast<int>(model.bodies.size()),
                            solids = static_cast<int>(model.solids.size())](const Side& side) {
      if (side.is_cable()) return bodies + solids + side.index;
      return side.is_solid() ? bodies + side.index : side.index;
    };
    // Sides of surfaces are numbered after the shapes of bodies, see touching_points().
    std::vector<int> side = simulation.contact_map().body;
    for (const ContactMap::Surface& surface : simulation.contact_map().surfaces)
      side.insert(side.end(), {number_of(surface.own), number_of(surface.side)});
    impl_->contacts.emplace(folder + "/paraview", "contacts", std::move(names), std::move(side),
                            keep);
  }
  // Frames of the earlier run are not written again.
  std::optional<double> last;
  if (impl_->results)
    last = impl_->results->last_time();
  else if (impl_->paraview)
    last = impl_->paraview->last_time();
  if (last) impl_->last_frame = *last;
  if (has_sensors(simulation)) impl_->sensors.emplace(folder + "/events.csv", keep);
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
    reports.reserve(simulation.solids().size());
    std::vector<SolidContactFields> contacts;
    bool touching = false;
    for (int i = 0; i < static_cast<int>(simulation.solids().size()); ++i) {
      reports.push_back(simulation.solid(i));
      contacts.emplace_back();
      if (!has_contact_fields(simulation, i)) continue;
      contacts.back() = solid_contact_fields(simulation, i);
      touching = true;
    }
    if (!touching) contacts.clear();
    impl_->solids->append(simulation.time(), reports, contacts);
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
  if (impl_->contacts) impl_->contacts->append(simulation.time(), touching_points(simulation));
  // Frames at the ends of steps are followed by step(), those between steps are not.
  if (impl_->probes && simulation.between_steps()) impl_->probes->record(simulation);
  ++impl_->frames;
}

void Recorder::step(const Simulation& simulation) {
  if (impl_->probes) impl_->probes->record(simulation);
  if (impl_->sensors) impl_->sensors->record(simulation.sensor_events());
}

void Recorder::sync() {
  if (impl_->results) impl_->results->sync();
  if (impl_->paraview) impl_->paraview->sync();
  if (impl_->solids) impl_->solids->sync();
  if (impl_->lines) impl_->lines->sync();
  if (impl_->contacts) impl_->contacts->sync();
  if (impl_->sensors) impl_->sensors->sync();
  if (impl_->probes) impl_->probes->sync();
}

void Recorder::conclude(const RunSummary& summary) {
  if (impl_->results) impl_->results->conclude(summary.distrust, summary.warnings);
}

void Recorder::close() {
  if (impl_->results) impl_->results->close();
  if (impl_->paraview) impl_->paraview->close();
  if (impl_->solids) impl_->solids->close();
  if (impl_->lines) impl_->lines->close();
  if (impl_->contacts) impl_->contacts->close();
  if (impl_->probes) impl_->probes->flush();
}

std::size_t Recorder::frames() const {
  return impl_->results ? impl_->results->frames() : impl_->frames;
}

}  // namespace polhode::io
