// SPDX-License-Identifier: Apache-2.0
// Data of elements, nodes and surfaces of an FEBio file: directions of fibres, values of conditions
// and loads.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Different values of a map: each becomes a condition or load.
constexpr std::size_t kMostValues = 1000;

/// Numbers of the elements of a part or a set; null if there is none of this name.
const std::vector<std::int64_t>* elements_named(const FebMesh& mesh, const std::string& name) {
  for (const FebPart& part : mesh.parts)
    if (part.name == name) return &part.ids;
  const auto set = mesh.element_sets.find(name);
  return set == mesh.element_sets.end() ? nullptr : &set->second;
}

/// Axes with the first one along a and the second one in the plane of a and d.
std::optional<Mat3> axes_of(FebFile& file, const Element& e) {
  const Vec3 a = file.direction(e, "a", Vec3::UnitX());
  const Vec3 normal = a.cross(file.direction(e, "d", Vec3::UnitY()));
  if (!(normal.norm() > 1e-9)) {
    file.xml.fault(e, "<a> and <d> are along one line", "Give two directions.");
    return std::nullopt;
  }
  Mat3 Q;
  Q << a, normal.normalized().cross(a), normal.normalized();
  return Q;
}

}  // namespace

void FebSolids::read_mesh_data(const Element& section) {
  FebFile& file = model_.file;
  for (const char* tag : {"NodeData", "SurfaceData"})
    for (const Element* e : file.xml.children(section, tag)) read_map(*e);
  for (const Element* data : file.xml.children(section, "ElementData")) {
    file.ignored.attributes(*data, {"name", "datatype", "format"});
    std::string type = file.xml.text(*data, "type").value_or("");
    if (type.empty()) type = file.xml.text(*data, "var").value_or("");
    const std::string set = file.xml.required_text(*data, "elem_set");
    if (type != "mat_axis" && type != "fiber") {
      file.refuse(*data, format("<ElementData> of type {} is not read", quote(type)),
                  "Types are mat_axis and fiber, with a value for each element.");
      continue;
    }
    const std::vector<std::int64_t>* elements = elements_named(model_.mesh, set);
    if (elements == nullptr) {
      if (!set.empty())
        file.xml.fault(*data, format("there are no elements {}", quote(set)),
                       "Give the name of an <Elements> or <ElementSet>.");
      continue;
    }
    for (const Element* e : file.children(*data)) {
      const std::int64_t lid = file.id(*e, "lid").value_or(0);
      if (lid < 1 || lid > static_cast<std::int64_t>(elements->size())) {
        file.xml.fault(*e,
                       format("the set {} has {} elements, and none of this lid", quote(set),
                              elements->size()),
                       "Number them from 1.");
        break;
      }
      FebElementData& own = element_data_[(*elements)[static_cast<std::size_t>(lid - 1)]];
      if (type == "mat_axis") {
        own.axes = axes_of(file, *e);
      } else if (const auto v = file.numbers(*e, 3, 3)) {
        own.fibre = Vec3((*v)[0], (*v)[1], (*v)[2]);
        if (!(own.fibre->norm() > 0.0)) {
          file.xml.fault(*e, "the direction of a fibre is zero", "Give a vector of any length.");
          own.fibre.reset();
        }
      }
    }
  }
}

/// Numbers of <NodeData> or <SurfaceData>, one for each node or facet.
void FebSolids::read_map(const Element& data) {
  FebFile& file = model_.file;
  const bool nodes = std::string_view(data.Name()) == "NodeData";
  const std::string name = file.xml.required_text(data, "name");
  FebMap map{&data, file.xml.required_text(data, nodes ? "node_set" : "surface"), {}};
  for (const char* kind : {"data_type", "datatype"})
    if (const auto type = file.xml.text(data, kind); type && *type != "scalar") {
      file.refuse(data, format("<{}> of data_type {} is not read", data.Name(), quote(*type)),
                  "Give a scalar for each component.");
      return;
    }
  file.ignored.attributes(data, {"format"});
  std::size_t count = 0;
  if (nodes) {
    const auto found = model_.mesh.node_sets.find(map.set);
    count = found == model_.mesh.node_sets.end() ? 0 : found->second.size();
  } else {
    const auto found = model_.mesh.surfaces.find(map.set);
    count = found == model_.mesh.surfaces.end() ? 0 : found->second.size();
  }
  std::vector<char> given(count, 0);
  map.values.resize(count);
  for (const Element* e : file.children(data)) {
    const std::int64_t lid = file.id(*e, "lid").value_or(0);
    const auto value = file.numbers(*e, 1, 1);
    if (!value) return;
    if (lid < 1 || lid > static_cast<std::int64_t>(count)) {
      file.xml.fault(*e, format("{} has {} members, and none of this lid", quote(map.set), count),
                     "Number them from 1.");
      return;
    }
    map.values[static_cast<std::size_t>(lid - 1)] = (*value)[0];
    given[static_cast<std::size_t>(lid - 1)] = 1;
  }
  if (count == 0 || std::find(given.begin(), given.end(), 0) != given.end())
    file.xml.fault(
        data, format("the map {} has no value for a member of {}", quote(name), quote(map.set)),
        "Give one for each.");
  else if (!maps_.try_emplace(name, std::move(map)).second)
    file.xml.fault(data, format("the map {} stands twice", quote(name)), "Rename one of them.");
}

const FebMap* FebSolids::map_of(const Element& parent, const char* tag, const std::string& set) {
  FebFile& file = model_.file;
  const Element* e = file.child(parent, tag);
  if (e == nullptr || file.xml.text(*e, "type").value_or("") != "map") return nullptr;
  const std::string name = XmlFile::content(*e).value_or("");
  const auto found = maps_.find(name);
  if (found == maps_.end()) {
    std::vector<std::string> names;
    for (const auto& [known, map] : maps_) names.push_back(known);
    file.xml.fault(*e, format("there is no map {}", quote(name)),
                   did_you_mean(name, names) + "Give the name of a <NodeData> or <SurfaceData>.");
    return nullptr;
  }
  if (found->second.set != set) {
    file.xml.fault(
        *e,
        format("the map {} is of {}, not of {}", quote(name), quote(found->second.set), quote(set)),
        "Give it for the same set.");
    return nullptr;
  }
  return &found->second;
}

FebValue FebSolids::value_of(const Element& parent, const char* tag) {
  FebFile& file = model_.file;
  const Element* e = file.child(parent, tag);
  if (e == nullptr || file.xml.text(*e, "type").value_or("") != "map")
    return file.value(parent, tag);
  return {1.0, file.controller(*e), e};
}

bool FebSolids::is_short(const Element& e, std::size_t values) {
  if (values <= kMostValues) return true;
  model_.file.refuse(e, format("a map of {} different values is not read", values),
                     format("Round them to at most {} values.", kMostValues));
  return false;
}

void FebSolids::put_fibres(const FebSolid& solid, const NodeBuilder& make, SourceNode& node) const {
  SourceNode list = make.list();
  bool any = false;
  for (const FebPart* part : solid.parts) {
    const FebMaterial& material = materials_.at(part->material);
    for (const std::int64_t id : part->ids) {
      const auto own = element_data_.find(id);
      const bool has = own != element_data_.end();
      if (has && own->second.fibre && material.fibres.size() > 1) {
        model_.file.refuse(*part->at,
                           format("the <ElementData> of type fiber for {}, whose material has "
                                  "several families of fibres, is not read",
                                  quote(part->name)),
                           "Give mat_axis.");
        return;
      }
      const Mat3 axes = has ? own->second.axes.value_or(material.axes) : material.axes;
      for (const Vec3& local : material.fibres) {
        any = any || has;
        const Vec3 a = has && own->second.fibre ? own->second.fibre->normalized() : local;
        list.children.push_back(make.direction(Vec3(axes * a)));
      }
    }
  }
  if (any) make.put(node, "fibre_directions", std::move(list));
}

}  // namespace polhode::io
