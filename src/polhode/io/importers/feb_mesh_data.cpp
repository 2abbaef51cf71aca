// SPDX-License-Identifier: Apache-2.0
// Data of elements of an FEBio file: axes and directions of fibres.
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

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
    for (const Element* e : file.xml.children(section, tag))
      file.refuse(*e, format("<{}> is not read", tag), "Give one value for all.");
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
