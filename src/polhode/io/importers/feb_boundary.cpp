// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Points of a rigid body that may have a force of their own.
constexpr std::size_t kMostForces = 1000;

std::vector<int> in_order(std::vector<int> nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/// Corners of a facet: of 3, 6 or 7 nodes three, of others four.
std::size_t corners_of(std::size_t nodes) { return nodes == 3 || nodes == 6 || nodes == 7 ? 3 : 4; }

/// Normal of a facet by its corners.
Vec3 normal_of(const std::vector<Vec3>& nodes, const std::vector<int>& facet) {
  const auto at = [&](std::size_t k) { return nodes[static_cast<std::size_t>(facet[k])]; };
  const std::size_t last = corners_of(facet.size()) - 1;
  return (at(1) - at(0)).cross(at(last) - at(0));
}

/// Number of a component by a letter; -1 if there is none.
int component_of(const std::string& dof) {
  return dof == "x" ? 0 : dof == "y" ? 1 : dof == "z" ? 2 : -1;
}

}  // namespace

const std::vector<int>* FebSolids::named_nodes(const Element& e) {
  FebFile& file = model_.file;
  const std::string name = file.xml.required_text(e, "node_set");
  if (name.empty()) return nullptr;
  if (const auto found = model_.mesh.node_sets.find(name); found != model_.mesh.node_sets.end())
    return &found->second;
  for (const std::string prefix : {"@surface:", "@edge:", ""}) {
    if (!name.starts_with(prefix)) continue;
    const auto surface = model_.mesh.surfaces.find(name.substr(prefix.size()));
    if (surface == model_.mesh.surfaces.end()) continue;
    std::set<int> nodes;
    for (const std::vector<int>& facet : surface->second) nodes.insert(facet.begin(), facet.end());
    std::vector<int>& list = surface_nodes_[name];
    list.assign(nodes.begin(), nodes.end());
    return &list;
  }
  std::vector<std::string> names;
  for (const auto& [set, nodes] : model_.mesh.node_sets) names.push_back(set);
  file.xml.fault(e, format("there is no set of nodes {}", quote(name)),
                 did_you_mean(name, names) + "Give the name of a <NodeSet>.");
  return nullptr;
}

void FebSolids::hold(const std::vector<int>& nodes, int component, int hold) {
  Held& held = model_.step == nullptr ? held_ : held_in_[model_.step_number()];
  for (const int n : nodes) {
    int& holder = held.try_emplace(n, std::array{-1, -1, -1})
                      .first->second[static_cast<std::size_t>(component)];
    const auto k = static_cast<std::size_t>(component);
    const FebHold& own = holds_[static_cast<std::size_t>(hold)];
    if (holder >= 0 && own.prescribed) {
      const FebHold& other = holds_[static_cast<std::size_t>(holder)];
      if (other.prescribed && (own.values[k].factor != other.values[k].factor ||
                               own.values[k].controller != other.values[k].controller))
        model_.file.refuse(*own.at,
                           format("the node {} has two prescribed displacements of one component",
                                  model_.mesh.labels[static_cast<std::size_t>(n)]),
                           "Prescribe each component once.");
    }
    // FEBio lets what is prescribed override what is fixed.
    if (holder < 0 || own.prescribed) holder = hold;
  }
}

void FebSolids::read_boundary(const Element& section) {
  FebFile& file = model_.file;
  // The interfaces of a solid with bodies have the bodies' names.
  hold_names_.insert("ground");
  for (const FebBody& body : model_.bodies) hold_names_.insert(body.name);
  for (const Element* e : file.xml.children(section, "bc")) {
    const std::string type = file.type(*e);
    const std::string name = file.xml.text(*e, "name").value_or("");
    if (type == "zero rotation" && model_.step == nullptr) {
      const std::vector<int>* nodes = named_nodes(*e);
      const bool all = file.boolean(*e, "u_dof", false) && file.boolean(*e, "v_dof", false) &&
                       file.boolean(*e, "w_dof", false);
      if (!all)
        file.refuse(*e, "<bc> of type \"zero rotation\" fixes some of the rotations alone",
                    "Fix all three of them.");
      else if (nodes != nullptr)
        clamped_.insert(nodes->begin(), nodes->end());
      continue;
    }
    if (type != "zero displacement" && type != "prescribed displacement" && type != "rigid") {
      static_cast<void>(file.xml.text(*e, "node_set"));
      if (!type.empty())
        file.refuse(*e, format("<bc> of type {} is not read", quote(type)),
                    "Use zero displacement, prescribed displacement or rigid.");
      continue;
    }
    const std::vector<int>* nodes = named_nodes(*e);
    if (type == "rigid") {
      if (model_.step != nullptr) {
        file.refuse(*e, "<bc> of type \"rigid\" of one step of several is not read",
                    "Put it outside the steps: nodes are bonded to a body throughout.");
        continue;
      }
      static_cast<void>(file.boolean(*e, "clamp_shells", true));  // There are none.
      const FebBody* body = model_.body(*e, "rb");
      if (nodes == nullptr || body == nullptr) continue;
      for (const int n : *nodes) attached_.insert_or_assign(n, body->name);
      continue;
    }
    const int number = static_cast<int>(holds_.size());
    FebHold condition{file.name(*e, name.empty() ? format("bc{}", number + 1) : name, hold_names_),
                      e,
                      type == "prescribed displacement",
                      {},
                      false,
                      {}};
    std::array<bool, 3> components{};
    const FebMap* map = nullptr;
    if (condition.prescribed) {
      const std::string dof = lower_case(file.text(*e, "dof"));
      map = map_of(*e, "value", file.xml.text(*e, "node_set").value_or(""));
      const FebValue value = value_of(*e, "value");
      condition.relative = file.boolean(*e, "relative", false);
      const int k = component_of(dof);
      if (k < 0) {
        file.xml.fault(*e, format("<dof> is {}", quote(dof)), "Write x, y or z.");
        continue;
      }
      components[static_cast<std::size_t>(k)] = true;
      condition.values[static_cast<std::size_t>(k)] = value;
    } else {
      components = {file.boolean(*e, "x_dof", false), file.boolean(*e, "y_dof", false),
                    file.boolean(*e, "z_dof", false)};
      if (std::none_of(components.begin(), components.end(), [](bool c) { return c; })) {
        file.xml.fault(*e, format("the <bc> {} fixes no component", quote(condition.name)),
                       "Set x_dof, y_dof or z_dof to 1.");
        continue;
      }
    }
    if (map != nullptr && nodes != nullptr) {
      hold_by(*map, *nodes, condition);
      continue;
    }
    holds_.push_back(std::move(condition));
    for (int k = 0; k < 3; ++k)
      if (nodes != nullptr && components[static_cast<std::size_t>(k)]) hold(*nodes, k, number);
  }
}

/// A condition for each value of a map, on the nodes that have it.
void FebSolids::hold_by(const FebMap& map, const std::vector<int>& nodes,
                        const FebHold& condition) {
  std::map<double, std::vector<int>> by_value;
  for (std::size_t k = 0; k < nodes.size(); ++k) by_value[map.values[k]].push_back(nodes[k]);
  if (!is_short(*condition.at, by_value.size())) return;
  for (const auto& [value, own] : by_value) {
    FebHold part = condition;
    for (FebValue& v : part.values) v.factor *= value;
    holds_.push_back(part);
    for (int k = 0; k < 3; ++k)
      if (part.values[static_cast<std::size_t>(k)].at != nullptr)
        hold(own, k, static_cast<int>(holds_.size()) - 1);
  }
}

void FebSolids::read_nodal_load(const Element& e) {
  FebFile& file = model_.file;
  const std::string type = file.type(e), name = file.xml.text(e, "name").value_or(type);
  if (type != "nodal_load" && type != "nodal_force") {
    if (!type.empty())
      file.refuse(e, format("a nodal load of type {} is not read", quote(type)),
                  "Use nodal_load or nodal_force.");
    return;
  }
  const std::vector<int>* nodes = named_nodes(e);
  static_cast<void>(file.boolean(e, "relative", false));
  std::array<FebValue, 3> force;
  if (type == "nodal_force") {
    force = file.vector_value(e, "value");
  } else {
    const std::string dof = lower_case(file.text(e, "dof"));
    const int k = component_of(dof);
    const FebValue scale = file.value(e, "scale");
    if (k < 0) {
      file.xml.fault(e, format("<dof> is {}", quote(dof)), "Write x, y or z.");
      return;
    }
    force[static_cast<std::size_t>(k)] = scale;
  }
  if (nodes == nullptr) return;
  const NodeBuilder make = file.make(e);
  std::set<int> left(nodes->begin(), nodes->end());
  if (left.size() != nodes->size()) {
    file.refuse(e, "a nodal load on a node twice, or on both nodes of a tied pair, is not read",
                "Load each of them once.");
    return;
  }
  for (const FebSolid& solid : solids_) {
    std::vector<int> own;
    for (const int n : *nodes)
      if (solid.place.contains(n) && left.erase(n) == 1) own.push_back(n);
    if (own.empty()) continue;
    SourceNode load = make.map();
    make.put(load, "type", make.text("nodal_force"));
    make.put(load, "solid", make.text(solid.name));
    make.put(load, "nodes", node_list(make, solid, own));
    make.put(load, "force", model_.vector(e, force));
    model_.add_load(e, name, std::move(load));
  }
  if (left.size() > kMostForces) {
    file.refuse(e, format("forces on {} nodes of rigid bodies are not read", left.size()),
                "Use a rigid_force.");
    return;
  }
  for (const int n : left) {
    const auto body = attached_.find(n);
    if (body == attached_.end()) continue;  // A node of nothing.
    SourceNode load = make.map();
    make.put(load, "type", make.text("force"));
    make.put(load, "body", make.text(body->second));
    make.put(load, "at", make.vector(model_.mesh.nodes[static_cast<std::size_t>(n)]));
    make.put(load, "force", model_.vector(e, force));
    model_.add_load(e, format("{}_{}", name, model_.mesh.labels[static_cast<std::size_t>(n)]),
                    std::move(load));
  }
}

bool FebSolids::select(const Element& e, const FebSolid& solid,
                       const std::vector<std::vector<int>>& facets, SourceNode& selection,
                       double& sign) {
  FebFile& file = model_.file;
  std::map<std::vector<int>, std::vector<int>> outside;  // Faces by their nodes in order.
  for (const solids::FaceBlock& block : solid.boundary.blocks) {
    const std::size_t size = block.shape().nodes.size();
    for (std::size_t f = 0; f < block.nodes.size(); f += size) {
      std::vector<int> face;
      for (std::size_t k = 0; k < size; ++k)
        face.push_back(solid.nodes[static_cast<std::size_t>(block.nodes[f + k])]);
      std::vector<int> key = in_order(face);
      outside.emplace(std::move(key), std::move(face));
    }
  }
  std::set<int> nodes;
  std::set<std::vector<int>> wanted;
  int inward = 0;
  for (const std::vector<int>& facet : facets) {
    const auto found = outside.find(in_order(facet));
    if (found == outside.end()) {
      file.refuse(
          e, format("a facet of the surface is no face of the boundary of {}", quote(solid.name)),
          "List faces of the boundary of one solid.");
      return false;
    }
    const double along =
        normal_of(model_.mesh.nodes, facet).dot(normal_of(model_.mesh.nodes, found->second));
    if (along < 0.0) ++inward;
    nodes.insert(facet.begin(), facet.end());
    wanted.insert(found->first);
  }
  if (inward != 0 && inward != static_cast<int>(facets.size())) {
    file.refuse(e, "some facets of the surface face inward and others outward",
                "Order their nodes alike.");
    return false;
  }
  sign = inward > 0 ? -1.0 : 1.0;
  const NodeBuilder make = file.make(e);
  const auto covered =
      static_cast<std::size_t>(std::count_if(outside.begin(), outside.end(), [&](const auto& face) {
        return std::all_of(face.first.begin(), face.first.end(),
                           [&](int n) { return nodes.contains(n); });
      }));
  if (covered == wanted.size()) {
    selection = node_list(make, solid, {nodes.begin(), nodes.end()});
    return true;
  }
  selection = make.list();  // Face by face, as the nodes of all have others between them.
  for (const std::vector<int>& face : wanted)
    selection.children.push_back(node_list(make, solid, face));
  return true;
}

void FebSolids::read_surface_load(const Element& e) {
  FebFile& file = model_.file;
  const std::string type = file.type(e);
  if (type != "pressure" && type != "traction") {
    if (!type.empty())
      file.refuse(e, format("a surface load of type {} is not read", quote(type)),
                  "Use pressure or traction.");
    return;
  }
  const std::string name = file.xml.required_text(e, "surface");
  const auto found = model_.mesh.surfaces.find(name);
  if (name.empty() || found == model_.mesh.surfaces.end()) {
    file.xml.fault(e, format("there is no surface {}", quote(name)),
                   "Give the name of a <Surface>.");
    return;
  }
  if (file.boolean(e, "shell_bottom", false))
    file.refuse(e, "<shell_bottom> is not read", "Mesh the part with solid elements.");
  const FebMap* map = type == "pressure" ? map_of(e, "pressure", name) : nullptr;
  if (map == nullptr) {
    put_on(e, type, 1.0, found->second);
    return;
  }
  std::map<double, std::vector<std::vector<int>>> by_value;
  for (std::size_t k = 0; k < found->second.size(); ++k)
    if (map->values[k] != 0.0) by_value[map->values[k]].push_back(found->second[k]);
  if (!is_short(e, by_value.size())) return;
  for (const auto& [value, facets] : by_value) put_on(e, type, value, facets);
}

/// Adds a load on facets to each of the solids that have them.
void FebSolids::put_on(const Element& e, const std::string& type, double factor,
                       const std::vector<std::vector<int>>& all) {
  FebFile& file = model_.file;
  std::map<const FebSolid*, std::vector<std::vector<int>>> facets;
  for (const std::vector<int>& facet : all) {
    const auto solid = std::find_if(solids_.begin(), solids_.end(), [&](const FebSolid& s) {
      return std::all_of(facet.begin(), facet.end(), [&](int n) { return s.place.contains(n); });
    });
    if (solid == solids_.end()) {
      file.refuse(e,
                  format("the surface {} is not that of a deformable solid",
                         quote(file.xml.text(e, "surface").value_or(""))),
                  "Use rigid loads on rigid bodies.");
      return;
    }
    facets[&*solid].push_back(facet);
  }
  for (const FebSolid& solid : solids_) {
    const auto own = facets.find(&solid);
    SourceNode selection;
    double sign = 1.0;
    if (own != facets.end() && select(e, solid, own->second, selection, sign))
      put_surface_load(e, type, solid, std::move(selection), sign * factor);
  }
}

void FebSolids::put_surface_load(const Element& e, const std::string& type, const FebSolid& solid,
                                 SourceNode selection, double sign) {
  FebFile& file = model_.file;
  const NodeBuilder make = file.make(e);
  const bool linear = file.boolean(e, "linear", false);
  SourceNode load = make.map();
  make.put(load, "type", make.text(type));
  make.put(load, "solid", make.text(solid.name));
  make.put(load, "surface", std::move(selection));
  if (type == "pressure") {
    file.ignored.skip(e, {"symmetric_stiffness"});
    make.put(load, "pressure", model_.curves.node(value_of(e, "pressure"), sign));
    make.put(load, "follower", make.boolean(!linear));
  } else {
    FebValue scale = file.value(e, "scale", 1.0);
    auto values = file.vector_value(e, "traction");
    for (FebValue& value : values) {
      if (value.controller)
        file.refuse(e, "the <traction> has a load controller", "Give it to <scale>.");
      value = {scale.factor * value.factor, scale.controller, scale.at};
    }
    make.put(load, "traction", model_.vector(e, values));
    if (!linear)
      file.approximated(e, "the traction is per undeformed area, where FEBio has the deformed one");
  }
  model_.add_load(e, file.xml.text(e, "name").value_or(type), std::move(load));
}

void FebSolids::add_body_force(const Element& e, const std::array<FebValue, 3>& values) {
  const NodeBuilder make = model_.file.make(e);
  for (const FebSolid& solid : solids_) {
    SourceNode load = make.map();
    make.put(load, "type", make.text("body_force"));
    make.put(load, "solid", make.text(solid.name));
    make.put(load, "acceleration", model_.vector(e, values, -1.0));
    model_.add_load(e, solid.name + "_weight", std::move(load));
  }
}

}  // namespace polhode::io
