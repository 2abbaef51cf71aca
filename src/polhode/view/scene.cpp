// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/scene.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/view/chunk.hpp>
#include <polhode/view/scene_parts.hpp>

namespace polhode {

namespace {

/// Placeholder of the data in a page, written by viewer/build.mjs.
constexpr const char* kPlace = "<!--POLHODE-DATA-->";
/// Placeholder of numbers not needed for the first picture, behind the player, which starts before
/// a browser has read them.
constexpr const char* kLaterPlace = "<!--POLHODE-LATER-->";

bool starts_with(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

/// Fields of solids are added by add_solids().
bool is_channel(const std::string& path) {
  if (path == io::results::kTime) return false;
  if (!starts_with(path, io::results::kSolids)) return true;
  return path.find("/interfaces/") != std::string::npos;
}

/// Whether a channel is not needed for the first picture.
bool is_later(const std::string& path) {
  for (const char* first : {"/packed/bodies/position", "/packed/bodies/orientation",
                            "/packed/contacts/force", "/packed/contacts/point", "/packed/loads/"})
    if (starts_with(path, first)) return false;
  return starts_with(path, "/packed/");
}

/// Numbers per frame of all data used by the page.
std::size_t frame_size(const io::ResultsReader& results) {
  std::size_t size = 0;
  for (const io::ResultsReader::DataSet& set : results.data_sets())
    if (set.path != io::results::kTime) size += set.size();
  return size;
}

std::size_t choose_every(const io::ResultsReader& results, const SceneOptions& options) {
  const std::size_t frames = results.frames();
  if (frames == 0) return 1;
  const std::size_t bytes = std::max<std::size_t>(1, 4 * frame_size(results));
  std::size_t most = std::max<std::size_t>(2, options.max_bytes / bytes);
  if (options.max_frames > 0) most = std::min(most, options.max_frames);
  return std::max<std::size_t>(1, (frames + most - 1) / most);
}

std::string model_text(const io::ResultsReader& results) {
  const std::vector<std::string> text =
      results.names(std::string(io::results::kProvenance) + "/model");
  return text.empty() ? "" : text[0];
}

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

Json json_of(const Vec3& v) { return {v[0], v[1], v[2]}; }
Json json_of(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Json ChunkList::add(std::string bytes, std::size_t count, std::size_t width, const char* type) {
  chunks_.push_back(std::move(bytes));
  return {
      {"c", chunks_.size() - 1}, {"n", width == 0 ? 0 : count / width}, {"w", width}, {"t", type}};
}

Json ChunkList::floats(std::span<const double> values, std::size_t width) {
  return add(pack_floats(values, width), values.size(), width, "f");
}

Json ChunkList::integers(std::span<const std::uint32_t> values, std::size_t width) {
  return add(pack_integers(values, width), values.size(), width, "u");
}

Json ChunkList::surface(const geometry::TriangleSurface& surface) {
  std::vector<double> points;
  for (const Vec3& p : surface.points) points.insert(points.end(), {p[0], p[1], p[2]});
  std::vector<std::uint32_t> corners;
  for (const auto& [a, b, c] : surface.triangles)
    corners.insert(corners.end(), {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                   static_cast<std::uint32_t>(c)});
  return {{"points", floats(points, 3)}, {"triangles", integers(corners, 3)}};
}

Model model_of_results(const io::ResultsReader& results, const std::string& folder) {
  namespace fs = std::filesystem;
  const std::string group = io::results::kProvenance, text = model_text(results);
  const std::string name = results.attribute(group, "model_file");
  const io::Overrides overrides = lines_of(results.attribute(group, "overrides"));
  const fs::path here = fs::absolute(folder);
  try {
    return io::read_model_text(text, (here.parent_path() / name).string(), overrides);
  } catch (const std::exception&) {
    return io::read_model_text(text, (here / name).string(), overrides);
  }
}

SceneData make_scene(const io::ResultsReader& results, const Model* model,
                     const SceneOptions& options) {
  SceneData scene;
  scene.every = choose_every(results, options);
  ChunkList chunks(scene);
  const std::vector<double> time = results.read(io::results::kTime, scene.every);
  scene.frames = time.size();
  scene.title = results.attribute("/", "title");
  const std::string group = io::results::kProvenance;
  Json manifest = {{"format", "polhode scene"},
                   {"version", 1},
                   {"title", scene.title},
                   {"name", options.name},
                   {"compared", options.compared},
                   {"frames", time.size()},
                   {"file_frames", results.frames()},
                   {"time", time},
                   {"statics", model != nullptr && model->analysis.type == "statics"},
                   {"cut_short", results.cut_short()},
                   {"notes", options.notes},
                   {"source",
                    {{"file", results.attribute(group, "model_file")},
                     {"text", model_text(results)},
                     {"overrides", lines_of(results.attribute(group, "overrides"))},
                     {"version", results.attribute(group, "version")},
                     {"solver", results.attribute(group, "solver")}}}};
  if (model != nullptr) manifest["gravity"] = json_of(model->gravity);
  // The drift of the run is that at its last frame, which the page may leave out.
  const std::string drift = std::string(io::results::kEnergy) + "/drift";
  if (results.has(drift) && results.frames() > 0)
    manifest["energy_drift"] = results.read(drift).back();
  if (model == nullptr && !model_text(results).empty())
    manifest["notes"].push_back("The model of these results cannot be read: shapes are not known.");
  add_bodies(manifest, chunks, results, model, options);
  add_connections(manifest, results, model, options);
  add_solids(manifest, chunks, results, scene.every);
  add_lines(manifest, results, model);
  manifest["contacts"] = results.names(std::string(io::results::kPackedContacts) + "/names");
  Json& channels = manifest["channels"] = Json::array();
  for (const io::ResultsReader::DataSet& set : results.data_sets())
    if (is_channel(set.path) && set.size() > 0) {
      if (is_later(set.path)) chunks.later();
      channels.push_back(
          {{"path", set.path.substr(1)},
           {"unit", set.unit},
           {"dims", set.dims},
           {"data", chunks.floats(results.read(set.path, scene.every), set.size())}});
    }
  // Replaces bytes that are not UTF-8: titles and names come from files.
  scene.manifest = manifest.dump(-1, ' ', false, Json::error_handler_t::replace);
  return scene;
}

namespace {

/// Chunks of a recording, either those needed for the first picture or the others.
std::string chunk_elements(const SceneData& scene, const std::string& suffix, bool later) {
  std::string data;
  for (std::size_t i = 0; i < scene.chunks.size(); ++i)
    if (scene.later.contains(i) == later)
      data += format("<script type=\"application/octet-stream\" id=\"chunk{}-{}\">{}</script>\n",
                     suffix, i, base64(scene.chunks[i]));
  return data;
}

/// Elements of a recording; `suffix` distinguishes a second one from the first.
std::string scene_elements(const SceneData& scene, const std::string& suffix) {
  std::string data = format("<script type=\"application/json\" id=\"polhode-scene{}\">", suffix);
  for (char c : scene.manifest) {
    if (c == '<')
      data += "\\u003c";  // No text of a model may end the element.
    else
      data += c;
  }
  return data + "</script>\n" + chunk_elements(scene, suffix, false);
}

}  // namespace

std::string scene_page(const std::string& page, const SceneData& scene, const SceneData* compared) {
  const std::size_t place = page.find(kPlace);
  if (place == std::string::npos)
    throw std::invalid_argument("scene_page: the page has no place for data");
  std::string data = scene_elements(scene, ""), later = chunk_elements(scene, "", true);
  if (compared != nullptr) {
    data += scene_elements(*compared, "-1");
    later += chunk_elements(*compared, "-1", true);
  }
  std::string filled = page;
  const std::size_t behind = filled.find(kLaterPlace);
  if (behind == std::string::npos)
    data += later;
  else
    filled.replace(behind, std::string(kLaterPlace).size(), later);
  return filled.replace(place, std::string(kPlace).size(), data);
}

}  // namespace polhode
