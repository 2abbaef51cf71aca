// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/compile/shape_surface.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/io/results/paraview.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/view/scene_parts.hpp>

namespace polhode {

namespace {

/// Triangles around round shapes: fewer for many bodies.
int segments_for(std::size_t bodies) { return bodies > 2000 ? 10 : bodies > 200 ? 16 : 32; }

/// Thickness of the box of a slender body without shapes, as a part of its length: it should be
/// visible in the whole mechanism.
double thinnest(const BodySpec& body, double size) {
  constexpr double kThin = 0.06, kThick = 0.2, kOfAll = 0.004;
  if (body.point_mass) return kThin;
  const Vec3 moments = geometry::principal_axes(body.inertia).moments;
  const double length = std::sqrt(6.0 / body.mass * (moments.sum() - 2.0 * moments[0]));
  return std::clamp(kOfAll * size / length, kThin, kThick);
}

/// Text that is equal for equal shapes.
std::string key_of(const ShapeSpec& shape) {
  std::string key =
      format("{} {} {} {} {}", shape.type, shape.file, shape.scale, shape.columns, shape.spacing);
  for (double v : shape.sizes) key += format(" {}", v);
  for (const Vec3& p : shape.points) key += format(" {} {} {}", p[0], p[1], p[2]);
  for (double v : shape.heights) key += format(" {}", v);
  return key;
}

/// Size of the mechanism at the start, the scale of the cubes of point masses.
double extent_of(const Model& model) {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  bool first = true;
  for (const BodySpec& body : model.bodies) {
    low = first ? body.position : low.cwiseMin(body.position);
    high = first ? body.position : high.cwiseMax(body.position);
    first = false;
  }
  const double size = (high - low).norm();
  return size > 0.0 ? size : 1.0;
}

/// Different meshes, each once.
class Meshes {
 public:
  Meshes(Json& list, ChunkList& chunks) : list_(list), chunks_(chunks) {}
  template <class Make>
  std::size_t index(const std::string& key, const std::string& type, Make make) {
    const auto [entry, fresh] = known_.try_emplace(key, list_.size());
    if (fresh) {
      Json mesh = chunks_.surface(make());
      mesh["type"] = type;
      list_.push_back(std::move(mesh));
    }
    return entry->second;
  }

 private:
  Json& list_;
  ChunkList& chunks_;
  std::map<std::string, std::size_t> known_;
};

/// Entry of that name, usually the one at that index; null if there is none.
template <class Spec>
const Spec* named(const std::vector<Spec>& list, const std::string& name, std::size_t index) {
  if (index < list.size() && list[index].name == name) return &list[index];
  for (const Spec& spec : list)
    if (spec.name == name) return &spec;
  return nullptr;
}

Json parts_of(const BodySpec& body, double size, int segments, Meshes& meshes) {
  Json parts = Json::array();
  for (const ShapeSpec& shape : body.shapes) {
    Json part;
    if (shape.type == "plane")
      part["plane"] = json_of(Vec3(shape.sizes[0], shape.sizes[1], shape.sizes[2]));
    else
      part["mesh"] = meshes.index(key_of(shape), shape.type, [&] {
        return shape_surface(format("bodies.{}.shape", body.name), shape, segments);
      });
    part["p"] = json_of(Vec3(shape.position - body.com));
    if (shape.orientation.w() != 1.0) part["q"] = json_of(shape.orientation);
    parts.push_back(std::move(part));
  }
  if (body.shapes.empty() && !body.fixed) {
    std::string key = format("inertia {}", body.point_mass);
    for (double v : body.inertia.reshaped()) key += format(" {}", v);
    key += format(" {}", body.mass);
    parts.push_back(
        {{"mesh", meshes.index(key, "inertia",
                               [&] { return io::inertia_box(body, size, thinnest(body, size)); })},
         {"p", {0, 0, 0}}});
  }
  return parts;
}

}  // namespace

void add_bodies(Json& manifest, ChunkList& chunks, const io::ResultsReader& results,
                const Model* model, const SceneOptions& options) {
  manifest["meshes"] = Json::array();
  Json& bodies = manifest["bodies"] = Json::array();
  Meshes meshes(manifest["meshes"], chunks);
  const double size = model != nullptr ? extent_of(*model) : 1.0;
  std::map<std::string, std::size_t> index;
  std::vector<bool> nodes;
  if (model != nullptr) {
    nodes = are_nodes(*model);
    for (std::size_t i = 0; i < model->bodies.size(); ++i) index[model->bodies[i].name] = i;
  }
  const std::vector<std::string> names =
      results.names(std::string(io::results::kPackedBodies) + "/names");
  const int segments = segments_for(names.size());
  for (const std::string& name : names) {
    Json entry = {{"name", name}};
    if (const auto mark = options.body_marks.find(name); mark != options.body_marks.end())
      entry["mark"] = mark->second;
    const auto found = index.find(name);
    if (found == index.end()) {
      BodySpec cube;
      cube.point_mass = true;
      cube.mass = 1.0;
      entry["parts"] = parts_of(cube, size, segments, meshes);
    } else {
      const BodySpec& body = model->bodies[found->second];
      entry["line"] = body.place.line;
      if (!body.color.empty()) entry["color"] = body.color;
      if (body.fixed) entry["fixed"] = true;
      if (!body.fixed) entry["mass"] = body.mass;
      if (nodes[found->second])
        entry["node"] = true;
      else
        entry["parts"] = parts_of(body, size, segments, meshes);
    }
    bodies.push_back(std::move(entry));
  }
}

void add_connections(Json& manifest, const io::ResultsReader& results, const Model* model,
                     const SceneOptions& options) {
  const std::string packed = io::results::kPackedJoints, packed_loads = io::results::kPackedLoads;
  Json& joints = manifest["joints"] = Json::array();
  const std::vector<std::string> names = results.names(packed + "/names"),
                                 types = results.names(packed + "/types");
  const std::vector<std::int64_t> first = results.numbers(packed + "/first"),
                                  count = results.numbers(packed + "/count");
  for (std::size_t k = 0; k < names.size(); ++k) {
    Json entry = {{"name", names[k]}};
    if (k < types.size()) entry["type"] = types[k];
    if (k < first.size()) entry["first"] = first[k];
    if (k < count.size()) entry["count"] = count[k];
    if (const auto mark = options.marks.find(names[k]); mark != options.marks.end())
      entry["mark"] = mark->second;
    if (model != nullptr)
      if (const JointSpec* joint = named(model->joints, names[k], k)) {
        entry["line"] = joint->place.line;
        entry["a"] = joint->a;
        entry["b"] = joint->b;
        entry["Za"] = json_of(joint->Z_a);
        entry["Zb"] = json_of(joint->Z_b);
        entry["q"] = json_of(Quat(joint->R_a));
      }
    joints.push_back(std::move(entry));
  }
  Json& loads = manifest["loads"] = Json::array();
  const std::vector<std::string> load_names = results.names(packed_loads + "/names"),
                                 load_types = results.names(packed_loads + "/types");
  const std::vector<std::int64_t> load_first = results.numbers(packed_loads + "/first"),
                                  load_count = results.numbers(packed_loads + "/count");
  if (load_types.size() != load_names.size() || load_first.size() != load_names.size() ||
      load_count.size() != load_names.size())
    results.refuse("its lists of loads do not fit each other");
  for (std::size_t k = 0; k < load_names.size(); ++k) {
    Json entry = {{"name", load_names[k]}, {"type", load_types[k]}, {"first", load_first[k]}};
    Json columns = Json::array();
    std::int64_t numbers = 0;
    for (const LoadChannel& c : load_kind(load_types[k]).channels) {
      numbers += c.size;
      if (numbers > load_count[k]) break;  // results of earlier versions may have fewer
      columns.push_back({{"name", c.name}, {"unit", c.unit}, {"size", c.size}});
    }
    entry["columns"] = columns;
    if (model != nullptr)
      if (const LoadSpec* load = named(model->loads, load_names[k], k)) {
        entry["line"] = load->place.line;
        if (!load->has_end_on_solid()) {  // else it is not drawn: its points are not bodies'
          entry["a"] = load->a;
          entry["b"] = load->b;
          entry["Za"] = json_of(load->Z_a);
          entry["Zb"] = json_of(load->Z_b);
        }
        if (!load->joint.empty()) entry["joint"] = load->joint;
        for (const char* key : {"stiffness", "damping"})
          if (const auto value = load->parameters.find(key); value != load->parameters.end())
            entry[key] = value->second;
        if (load_types[k] == "spring_damper") {
          const auto has = [&](const char* number, const char* law) {
            const auto value = load->parameters.find(number);
            return (value != load->parameters.end() && value->second != 0.0) ||
                   load->laws.count(law) > 0;
          };
          entry["coil"] = has("stiffness", "spring_force") || has("quadratic", "spring_force");
          entry["damper"] = has("damping", "damper_force");
        }
      }
    loads.push_back(std::move(entry));
  }
}

void add_lines(Json& manifest, const io::ResultsReader& results, const Model* model) {
  Json& beams = manifest["beams"] = Json::array();
  for (const std::string& name : results.groups(io::results::kBeams)) {
    Json entry = {{"name", name}};
    if (model != nullptr)
      for (const BeamSpec& beam : model->beams)
        if (beam.name == name) {
          entry["line"] = beam.place.line;
          entry["section"] = beam.section.name;
          entry["height"] = beam.section.height;
          entry["width"] = beam.section.width;
        }
    beams.push_back(std::move(entry));
  }
  Json& cables = manifest["cables"] = Json::array();
  for (const std::string& name : results.groups(io::results::kCables)) {
    Json entry = {{"name", name}};
    if (model != nullptr)
      for (const CableLineSpec& cable : model->cables)
        if (cable.name == name) {
          entry["line"] = cable.place.line;
          if (cable.contact) entry["radius"] = cable.contact->radius;
        }
    cables.push_back(std::move(entry));
  }
}

}  // namespace polhode
