// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Part of a body's volume by which its convex hull may exceed it.
constexpr double kConvex = 1e-3;

/// Whether a rigid body is its convex hull.
bool is_convex(const FebMesh& mesh, const FebBody& body) {
  if (!(body.volume > 0.0)) return false;
  std::vector<Vec3> corners;
  for (const int n : body.nodes) corners.push_back(mesh.nodes[static_cast<std::size_t>(n)]);
  try {
    const double hull = geometry::signed_volume(geometry::convex_hull(body.name, corners));
    return hull <= body.volume * (1.0 + kConvex);
  } catch (const InputError&) {
    return false;
  }
}

/// Distance of coinciding nodes, as a part of the extent of their surface.
constexpr double kSameNode = 1e-6;

/// Nodes of a with the node of b at the same place, by their numbers.
std::map<int, int> twins_of(const std::vector<Vec3>& X, const std::set<int>& a,
                            const std::set<int>& b) {
  const auto at = [&](int node) -> const Vec3& { return X[static_cast<std::size_t>(node)]; };
  Vec3 least = at(*a.begin()), most = least;
  for (const int n : a) {
    least = least.cwiseMin(at(n));
    most = most.cwiseMax(at(n));
  }
  const double tolerance = kSameNode * (most - least).norm();
  std::multimap<double, int> by_x;
  for (const int n : b) by_x.emplace(at(n).x(), n);
  std::map<int, int> twins;
  for (const int n : a)
    for (auto k = by_x.lower_bound(at(n).x() - tolerance);
         k != by_x.end() && k->first <= at(n).x() + tolerance; ++k)
      if ((at(k->second) - at(n)).norm() <= tolerance) twins.emplace(n, k->second);
  return twins;
}

/// Reads what a contact has besides friction: what changes the forces is refused, what belongs to
/// FEBio's penalty and search is not needed.
void read_rest_of_contact(FebFile& file, const Element& e) {
  for (const char* tag :
       {"max_traction", "offset", "node_reloc", "shell_bottom_primary", "shell_bottom_secondary"})
    if (file.number(e, tag).value_or(0.0) != 0.0)
      file.refuse(*file.child(e, tag), format("<{}> of contact is not read", tag), "Leave it out.");
  if (file.boolean(e, "tension", false))
    file.refuse(*file.child(e, "tension"), "contact with tension is not read",
                "Leave it out, or use a tie.");
  file.skip_all(e, {"laugon",         "tolerance",
                    "gaptol",         "penalty",
                    "auto_penalty",   "update_penalty",
                    "two_pass",       "search_tol",
                    "search_radius",  "symmetric_stiffness",
                    "seg_up",         "snap_tol",
                    "minaug",         "maxaug",
                    "smooth_aug",     "flip_primary",
                    "flip_secondary", "knmult",
                    "ktmult",         "edge_penalty",
                    "fric_penalty",   "fric_tol",
                    "sf_penalty",     "max_augmentations",
                    "smooth"});
}

/// Names as a list of a model file.
SourceNode name_nodes(const NodeBuilder& make, const std::set<std::string>& names) {
  SourceNode list = make.list();
  for (const std::string& name : names) list.children.push_back(make.text(name));
  return list;
}

}  // namespace

FebSolids::Side FebSolids::side_of(const std::string& surface) {
  Side side;
  const auto found = model_.mesh.surfaces.find(surface);
  if (found == model_.mesh.surfaces.end() || found->second.empty()) return side;
  side.facets = &found->second;
  std::set<int> nodes;
  for (const std::vector<int>& facet : found->second) nodes.insert(facet.begin(), facet.end());
  const auto all = [&](const auto& test) { return std::all_of(nodes.begin(), nodes.end(), test); };
  for (FebSolid& solid : solids_)
    if (all([&](int n) { return solid.place.contains(n); }) &&
        !all([&](int n) { return attached_.contains(n); }))
      side.solid = &solid;
  if (side.solid != nullptr) return side;
  for (FebBody& body : model_.bodies)
    if (all([&](int n) { return std::binary_search(body.nodes.begin(), body.nodes.end(), n); }))
      side.body = &body;
  return side;
}

void FebSolids::merge_ties() {
  FebMesh& mesh = model_.mesh;
  std::set<int> soft;
  for (const FebPart& part : mesh.parts)
    if (materials_.contains(part.material)) soft.insert(part.nodes.begin(), part.nodes.end());
  const auto nodes_of = [&](const std::string& surface) {
    std::set<int> nodes;
    if (const auto found = mesh.surfaces.find(surface); found != mesh.surfaces.end())
      for (const std::vector<int>& facet : found->second) nodes.insert(facet.begin(), facet.end());
    return nodes;
  };
  const auto is_soft = [&](const std::set<int>& nodes) {
    return !nodes.empty() &&
           std::all_of(nodes.begin(), nodes.end(), [&](int n) { return soft.contains(n); });
  };
  model_.each_section("Contact", FebIn::values, [&](const Element& section) {
    if (model_.step != nullptr) return;
    for (const Element* e = section.FirstChildElement("contact"); e != nullptr;
         e = e->NextSiblingElement("contact")) {
      const std::string type = e->Attribute("type") == nullptr ? "" : e->Attribute("type");
      const char* name = e->Attribute("surface_pair");
      if (!type.starts_with("tied-") || name == nullptr) continue;
      const auto pair = mesh.surface_pairs.find(std::string_view(name));
      if (pair == mesh.surface_pairs.end()) continue;
      const std::set<int> a = nodes_of(pair->second.first), b = nodes_of(pair->second.second);
      if (!is_soft(a) || !is_soft(b)) continue;
      const auto twins = twins_of(mesh.nodes, a, b);
      if (twins.size() != std::min(a.size(), b.size())) continue;
      mesh.replace(twins);
      merged_.insert(e);
    }
  });
}

void FebSolids::tie(const Element& e, const Side& a, const Side& b) {
  if (merged_.contains(&e)) return;
  const Side& soft = a.solid != nullptr ? a : b;
  const Side& rigid = a.solid != nullptr ? b : a;
  if (soft.solid == nullptr || rigid.body == nullptr) {
    model_.file.refuse(
        e, "a tie between two solids whose nodes do not coincide, or two rigid bodies, is not read",
        soft.solid != nullptr ? "Let all nodes of one surface coincide with nodes of the other."
                              : "Connect rigid bodies by a rigid lock.");
    return;
  }
  for (const std::vector<int>& facet : *soft.facets)
    for (const int n : facet) attached_.emplace(n, rigid.body->name);
  model_.file.approximated(e,
                           format("nodes of {} that are tied to {} are bonded to it, all of them "
                                  "and with their distance",
                                  quote(soft.solid->name), quote(rigid.body->name)));
}

void FebSolids::touch(const Element& e, const Side& side, const std::string& own,
                      const std::string& other) {
  if (side.solid != nullptr) {
    side.solid->touching.insert(side.solid->touching.end(), side.facets->begin(),
                                side.facets->end());
    side.solid->groups.insert(own);
    side.solid->meets.insert(other);
    return;
  }
  side.body->groups.insert(own);
  side.body->meets.insert(other);
  if (is_convex(model_.mesh, *side.body) && model_.file.options.shapes != "none")
    model_.file.approximated(
        e, format("the rigid body {} touches with its whole surface", quote(side.body->name)));
  else
    model_.file.refuse(e, format("the rigid body {} is not convex", quote(side.body->name)),
                       "Give it a shape from an STL file in an overlay, or convex parts.");
}

void FebSolids::read_contact(const Element& section) {
  FebFile& file = model_.file;
  for (const Element* e : file.xml.children(section, "contact")) {
    const std::string type = file.type(*e);
    const std::string name = file.xml.text(*e, "name").value_or(type);
    const std::string pair_name = file.xml.required_text(*e, "surface_pair");
    const bool slides = type.starts_with("sliding-") && type != "sliding-tension-compression";
    const bool ties = type.starts_with("tied-") || type == "sticky";
    if (!slides && !ties) {
      if (!type.empty())
        file.refuse(*e, format("contact of type {} is not read", quote(type)),
                    "Use sliding-elastic, sliding-facet-on-facet, sliding-node-on-facet, or a tie "
                    "to a rigid body.");
      continue;
    }
    const double friction = file.number(*e, "fric_coeff").value_or(0.0);
    read_rest_of_contact(file, *e);
    const auto pair = model_.mesh.surface_pairs.find(pair_name);
    if (pair == model_.mesh.surface_pairs.end()) {
      if (!pair_name.empty())
        file.xml.fault(*e, format("there is no <SurfacePair> {}", quote(pair_name)),
                       "Give its name.");
      continue;
    }
    const Side a = side_of(pair->second.first), b = side_of(pair->second.second);
    if ((a.solid == nullptr && a.body == nullptr) || (b.solid == nullptr && b.body == nullptr)) {
      file.refuse(
          *e, format("a surface of {} is not that of one solid or rigid body", quote(pair_name)),
          "Give surfaces of <Surface> that belong to one part.");
      continue;
    }
    if (model_.step != nullptr &&
        (ties || a.solid != nullptr || b.solid != nullptr || !model_.dynamic)) {
      file.refuse(*e,
                  "contact of one step of several is not read, except between rigid bodies in "
                  "dynamics",
                  "Put it outside the steps.");
      continue;
    }
    if (ties) {
      tie(*e, a, b);
      continue;
    }
    if (a.solid == b.solid && a.body == b.body) {
      file.refuse(*e, "contact of a part with itself is not read",
                  "Add self: true to the solid's contact.");
      continue;
    }
    if (friction < 0.0)
      file.xml.fault(*e, format("<fric_coeff> is {}", friction),
                     "Give a value that is not negative.");
    if (friction > 0.0 && !model_.dynamic)
      file.refuse(*e, "statics has no friction between surfaces",
                  "Set fric_coeff to 0, or the analysis to DYNAMIC.");
    // Events name contacts, joints and loads alike.
    const std::string group =
        file.name(*e, name, model_.steps.size() > 1 ? model_.joint_names : contact_names_);
    if (model_.step != nullptr) model_.switched.push_back(group);
    touch(*e, a, group + "_primary", group + "_secondary");
    touch(*e, b, group + "_secondary", group + "_primary");
    const NodeBuilder make = file.make(*e);
    SourceNode law = make.map();
    const auto side_name = [](const Side& s) {
      return s.solid != nullptr ? s.solid->name : s.body->name;
    };
    make.put(law, "between", make.list({make.text(side_name(a)), make.text(side_name(b))}));
    make.put(law, "friction", make.number(model_.dynamic ? std::max(0.0, friction) : 0.0));
    if (contacts_.kind != SourceNode::Kind::kMap) contacts_ = make.map();
    make.put(contacts_, group, std::move(law));
    file.approximated(
        *e, format("the contact {} has a barrier in a thin band instead of FEBio's penalty",
                   quote(name)));
  }
}

void FebSolids::put_contact(const FebSolid& solid, const NodeBuilder& make, SourceNode& node) {
  if (contacts_.kind != SourceNode::Kind::kMap) return;
  SourceNode contact = make.map();
  if (solid.groups.empty()) {
    make.put(contact, "touches", make.boolean(false));
  } else {
    SourceNode selection;
    double sign = 1.0;
    if (select(*solid.at, solid, solid.touching, selection, sign))
      make.put(contact, "surface", std::move(selection));
    make.put(contact, "groups", name_nodes(make, solid.groups));
    make.put(contact, "meets", name_nodes(make, solid.meets));
  }
  make.put(node, "contact", std::move(contact));
}

void FebSolids::put_contact(const FebBody& body, const NodeBuilder& make, SourceNode& node) const {
  if (contacts_.kind != SourceNode::Kind::kMap || node.find("shape") == nullptr) return;
  SourceNode contact = make.map();
  if (body.groups.empty()) {
    make.put(contact, "touches", make.boolean(false));
  } else {
    make.put(contact, "groups", name_nodes(make, body.groups));
    make.put(contact, "meets", name_nodes(make, body.meets));
  }
  make.put(node, "contact", std::move(contact));
}

}  // namespace polhode::io
