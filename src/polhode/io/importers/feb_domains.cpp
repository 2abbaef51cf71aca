// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

/// Name of a material of a file.
std::string material_name(const XmlFile::Element& e) {
  const auto text = [&](const char* attribute) {
    const char* value = e.Attribute(attribute);
    return std::string(value == nullptr ? "" : value);
  };
  if (const std::string name = text("name"); !name.empty()) return name;
  return (lower_case(text("type")) == "rigid body" ? "body" : "material") + text("id");
}

}  // namespace

void check_feb_domains(FebModel& model, const XmlFile::Element* materials) {
  FebFile& file = model.file;
  std::vector<std::string> names;
  if (materials != nullptr)
    for (const auto* e = materials->FirstChildElement("material"); e != nullptr;
         e = e->NextSiblingElement("material"))
      names.push_back(material_name(*e));
  for (const FebPart& part : model.mesh.parts) {
    if (part.domain == nullptr)
      file.xml.fault(*part.at, format("the elements {} are in no domain", quote(part.name)),
                     "Give them a material by a <SolidDomain> of <MeshDomains>.");
    else if (std::find(names.begin(), names.end(), part.material) == names.end() &&
             !part.material.empty())
      file.xml.fault(
          *part.domain, format("there is no material {}", quote(part.material)),
          did_you_mean(part.material, names) + "Materials: " + name_list(names, 12) + ".");
  }
}

}  // namespace polhode::io
