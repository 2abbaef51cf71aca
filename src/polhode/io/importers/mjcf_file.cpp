// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_file.hpp>

#include <cmath>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

constexpr std::size_t kAny = 1000;  ///< Numbers of an attribute.

bool is_true(XmlFile& xml, const Element& e, const char* attribute, bool standard) {
  const auto value = xml.text(e, attribute);
  if (!value || *value == "auto") return standard;
  if (*value == "true" || *value == "false") return *value == "true";
  xml.fault(e, format("'{}' of <{}> is {}", attribute, e.Name(), quote(*value)),
            "Write true or false.");
  return standard;
}

}  // namespace

MjcfFile::MjcfFile(XmlFile& file, std::vector<ImportNote>& list)
    : xml(file), notes(list), ignored(file, list) {
  for (const Element* e : xml.children(xml.root(), "compiler")) read_compiler(*e);
  bool first = true;
  for (const Element* e : xml.children(xml.root(), "default")) {
    if (const auto name = xml.text(*e, "class"); name && first) main_ = *name;
    first = false;
    read_defaults(*e, "");
  }
}

double MjcfFile::angle(double value) const {
  return compiler.degrees ? value * std::numbers::pi / 180.0 : value;
}

std::vector<const Element*> MjcfFile::sections(const char* name) {
  return xml.children(xml.root(), name);
}

void MjcfFile::read_compiler(const Element& e) {
  MjcfCompiler& c = compiler;
  if (const auto unit = xml.text(e, "angle")) {
    c.degrees = *unit != "radian";
    if (*unit != "radian" && *unit != "degree")
      xml.fault(e, format("'angle' of <compiler> is {}", quote(*unit)), "Write radian or degree.");
  }
  if (const auto order = xml.text(e, "eulerseq")) {
    c.euler = *order;
    if (order->size() != 3 || order->find_first_not_of("xyzXYZ") != std::string::npos) {
      xml.fault(e, format("'eulerseq' is {}", quote(*order)), "Give three of x, y, z, X, Y, Z.");
      c.euler = "xyz";
    }
  }
  if (const auto where = xml.text(e, "coordinate"); where && *where != "local")
    xml.fault(e, format("the coordinates are {}", quote(*where)),
              "Only local ones are read; let MuJoCo save the model, which writes these.");
  c.auto_limits = is_true(xml, e, "autolimits", c.auto_limits);
  for (const char* folder : {"assetdir", "meshdir"})
    if (const auto path = xml.text(e, folder)) c.mesh_folder = *path;
  c.strip_path = is_true(xml, e, "strippath", c.strip_path);
  if (const auto how = xml.text(e, "inertiafromgeom")) {
    if (*how != "true" && *how != "false" && *how != "auto")
      xml.fault(e, format("'inertiafromgeom' of <compiler> is {}", quote(*how)),
                "Write true, false or auto.");
    c.inertia = *how == "true"    ? MjcfCompiler::FromGeoms::always
                : *how == "false" ? MjcfCompiler::FromGeoms::never
                                  : MjcfCompiler::FromGeoms::automatic;
  }
  c.least_mass = xml.number(e, "boundmass").value_or(c.least_mass);
  c.least_inertia = xml.number(e, "boundinertia").value_or(c.least_inertia);
  c.total_mass = xml.number(e, "settotalmass").value_or(c.total_mass);
  c.balance = is_true(xml, e, "balanceinertia", c.balance);
  if (const auto range = xml.numbers(e, "inertiagrouprange", 2, 2)) {
    c.groups[0] = (*range)[0];
    c.groups[1] = (*range)[1];
  }
  ignored.attributes(e, {"texturedir", "discardvisual", "usethread", "fusestatic",
                         "exactmeshinertia", "convexhull", "fitaabb", "alignfree", "saveinertial"});
  ignored.skip(e, {"lengthrange"});
}

void MjcfFile::read_defaults(const Element& e, const std::string& parent) {
  const auto given = xml.text(e, "class");
  if (!given && !parent.empty())
    xml.fault(e, "a nested <default> has no 'class'", "Write <default class=\"...\">.");
  const std::string name = parent.empty() ? main_ : given.value_or("");
  Class& c = classes_[name];
  c.parent = parent;
  c.blocks.push_back(&e);
  for (const Element* below : xml.children(e, "default")) read_defaults(*below, name);
  // Attributes of defaults are read where they are used.
  for (const Element* kind = e.FirstChildElement(); kind != nullptr;
       kind = kind->NextSiblingElement())
    if (std::string_view(kind->Name()) != "default") skip(*kind);
}

std::vector<const Element*> MjcfFile::blocks_of(const Element& e, const std::string& child_class) {
  std::vector<const Element*> blocks;
  const auto own = xml.text(e, "class");
  std::string name = own ? *own : child_class.empty() ? main_ : child_class;
  while (!name.empty()) {
    const auto found = classes_.find(name);
    if (found == classes_.end()) {
      if (name == "main") break;  // No defaults at all.
      std::vector<std::string> names;
      for (const auto& c : classes_) names.push_back(c.first);
      xml.fault(e, format("there is no class {}", quote(name)),
                did_you_mean(name, names) + "Classes: " + name_list(names, 12) + ".");
      classes_[name];  // One message for each.
      break;
    }
    blocks.insert(blocks.end(), found->second.blocks.rbegin(), found->second.blocks.rend());
    name = found->second.parent;
  }
  return blocks;
}

std::vector<const Element*> MjcfFile::givers(const Element& e, const char* attribute,
                                             const std::vector<std::string>& kinds,
                                             const std::string& child_class) {
  std::vector<const Element*> list;
  if (e.Attribute(attribute) != nullptr) list.push_back(&e);
  for (const Element* block : blocks_of(e, child_class))
    for (const std::string& kind : kinds)
      for (const Element* d = block->LastChildElement(kind.c_str()); d != nullptr;
           d = d->PreviousSiblingElement(kind.c_str()))
        if (d->Attribute(attribute) != nullptr) list.push_back(d);
  return list;
}

const Element* MjcfFile::giver(const Element& e, const char* attribute,
                               const std::vector<std::string>& kinds,
                               const std::string& child_class) {
  if (e.Attribute(attribute) != nullptr) {
    static_cast<void>(xml.text(e, "class"));
    return &e;
  }
  const std::vector<const Element*> list = givers(e, attribute, kinds, child_class);
  return list.empty() ? nullptr : list.front();
}

std::optional<std::string> MjcfTag::name() const {
  auto own = file.xml.text(e, "name");
  if (own && !own->empty()) *own += suffix;
  return own;
}

bool MjcfTag::has(const char* attribute) const {
  return file.giver(e, attribute, kinds, child_class) != nullptr;
}

std::string MjcfTag::text(const char* attribute, const std::string& standard) const {
  const Element* giver = file.giver(e, attribute, kinds, child_class);
  return giver == nullptr ? standard : file.xml.text(*giver, attribute).value_or(standard);
}

double MjcfTag::number(const char* attribute, double standard) const {
  const Element* giver = file.giver(e, attribute, kinds, child_class);
  return giver == nullptr ? standard : file.xml.number(*giver, attribute).value_or(standard);
}

Vec3 MjcfTag::vector(const char* attribute, const Vec3& standard) const {
  const Element* giver = file.giver(e, attribute, kinds, child_class);
  return giver == nullptr ? standard : file.xml.vector(*giver, attribute).value_or(standard);
}

std::vector<double> MjcfTag::numbers(const char* attribute, std::size_t least,
                                     std::size_t most) const {
  std::vector<double> all;
  for (const Element* giver : file.givers(e, attribute, kinds, child_class)) {
    const auto given = file.xml.numbers(*giver, attribute, least, std::min(most, kAny));
    if (!given) break;
    for (std::size_t k = all.size(); k < given->size(); ++k) all.push_back((*given)[k]);
    if (all.size() >= most) break;
  }
  return all;
}

bool MjcfTag::boolean(const char* attribute, bool standard) const {
  const Element* giver = file.giver(e, attribute, kinds, child_class);
  return giver == nullptr ? standard : is_true(file.xml, *giver, attribute, standard);
}

Mat3 rotation_to(const Vec3& z) {
  const Vec3 axis = Vec3::UnitZ().cross(z);
  const double sine = axis.norm();
  return Eigen::AngleAxisd(std::atan2(sine, z.z()),
                           sine > 0.0 ? Vec3(axis / sine) : Vec3(Vec3::UnitX()))
      .toRotationMatrix();
}

Mat3 MjcfTag::rotation() const {
  const auto nothing = [&](const char* attribute) {
    file.xml.fault(e, format("'{}' of <{}> gives no direction", attribute, e.Name()),
                   "Give numbers that are not all zero.");
    return Mat3::Identity().eval();
  };
  if (const auto q = numbers("quat", 4, 4); !q.empty()) {
    const Quat rotation(q[0], q[1], q[2], q[3]);
    return rotation.norm() > 0.0 ? rotation.normalized().toRotationMatrix() : nothing("quat");
  }
  if (const auto a = numbers("axisangle", 4, 4); !a.empty()) {
    const Vec3 axis(a[0], a[1], a[2]);
    if (!(axis.norm() > 0.0)) return nothing("axisangle");
    return Eigen::AngleAxisd(file.angle(a[3]), axis.normalized()).toRotationMatrix();
  }
  if (const auto angles = numbers("euler", 3, 3); !angles.empty()) {
    Mat3 R = Mat3::Identity();
    for (std::size_t k = 0; k < 3; ++k) {
      const char letter = file.compiler.euler[k];
      const bool fixed = letter < 'a';
      const Mat3 turn =
          Eigen::AngleAxisd(file.angle(angles[k]), Vec3::Unit(letter - (fixed ? 'X' : 'x')))
              .toRotationMatrix();
      R = fixed ? Mat3(turn * R) : Mat3(R * turn);
    }
    return R;
  }
  if (const auto a = numbers("xyaxes", 6, 6); !a.empty()) {
    const Vec3 x = Vec3(a[0], a[1], a[2]).normalized(), given(a[3], a[4], a[5]);
    const Vec3 y = (given - given.dot(x) * x).normalized();
    Mat3 R;
    R << x, y, x.cross(y);
    return R.allFinite() && std::abs(R.determinant() - 1.0) < 0.5 ? R : nothing("xyaxes");
  }
  if (const auto z = numbers("zaxis", 3, 3); !z.empty()) {
    const Vec3 axis(z[0], z[1], z[2]);
    return axis.norm() > 0.0 ? rotation_to(axis.normalized()) : nothing("zaxis");
  }
  return Mat3::Identity();
}

}  // namespace polhode::io
