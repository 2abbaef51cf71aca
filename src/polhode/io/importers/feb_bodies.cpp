// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;
using Freedom = FebFreedom::Kind;

/// Distance of two centres of mass that are the same, over the size of the body.
constexpr double kSamePoint = 1e-6;
/// Nodes up to which a body is drawn as their convex hull.
constexpr std::size_t kMostHullPoints = 20'000;

bool is_inertia(double mass, const Mat3& inertia) {
  try {
    geometry::check_mass_properties("", mass, inertia);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Tensor of a mass at a point: m (x² I - x xᵀ).
Mat3 point_inertia(double mass, const Vec3& x) {
  return mass * (x.squaredNorm() * Mat3::Identity() - x * x.transpose());
}

/// Mass properties of all parts of the mesh that have the material.
void integrate(FebModel& model, FebBody& body, double density) {
  std::vector<geometry::MassProperties> parts;
  for (const FebPart& part : model.mesh.parts) {
    if (part.material != body.material) continue;
    body.nodes.insert(body.nodes.end(), part.nodes.begin(), part.nodes.end());
    if (!part.is_solid()) {
      model.file.refuse(*part.at, format("{} elements of a rigid body have no volume", part.type),
                        "Mesh the part with solid elements.");
      continue;
    }
    if (const auto mass = feb_mass(model.file, model.mesh, part, density); mass && mass->mass > 0.0)
      parts.push_back(*mass);
  }
  std::sort(body.nodes.begin(), body.nodes.end());
  body.nodes.erase(std::unique(body.nodes.begin(), body.nodes.end()), body.nodes.end());
  if (!parts.empty()) body.mesh = geometry::composed(parts);
  if (density > 0.0) body.volume = body.mesh.mass / density;
}

void read_body(FebModel& model, const Element& e, std::set<std::string>& taken) {
  FebFile& file = model.file;
  FebBody body;
  body.at = &e;
  body.id = file.id(e).value_or(0);
  body.material = file.xml.text(e, "name").value_or("");
  if (body.material.empty()) body.material = format("body{}", body.id);
  for (const FebBody& other : model.bodies)
    if (other.material == body.material || other.id == body.id)
      file.xml.fault(e, format("the material {} stands twice", quote(body.material)),
                     "Give each its own name and id.");
  body.name = file.name(e, body.material, taken);
  const double density = file.number(e, "density").value_or(1.0);
  if (!(density >= 0.0))
    file.xml.fault(e, format("the density of {} is {}", quote(body.material), density),
                   "Give a value that is not negative.");
  const auto given = file.vector(e, "center_of_mass");
  const bool overrides = file.boolean(e, "override_com", true);
  for (const char* tag : {"E", "v"})
    if (const Element* unused = file.child(e, tag)) file.xml.skip(*unused);
  if (const auto parent = file.number(e, "parent_id"); parent && *parent > 0.0)
    body.parent = static_cast<std::int64_t>(*parent);
  integrate(model, body, std::max(0.0, density));
  body.com = given && overrides ? *given : body.mesh.com;
  body.inertia = body.mesh.inertia;
  if (!body.is_centred()) {
    // FEBio moves the tensor about the origin to the given point as if that were the centre.
    body.inertia +=
        point_inertia(body.mesh.mass, body.mesh.com) - point_inertia(body.mesh.mass, body.com);
    const bool sound = is_inertia(body.mesh.mass, body.inertia);
    file.approximated(
        e,
        format("the centre of mass of {} is ({:.6g}, {:.6g}, {:.6g}) in the file and ({:.6g}, "
               "{:.6g}, {:.6g}) by its mesh: as in FEBio its mass and freedoms are at the first, "
               "its weight acts at the second{}",
               quote(body.material), body.com.x(), body.com.y(), body.com.z(), body.mesh.com.x(),
               body.mesh.com.y(), body.mesh.com.z(),
               sound ? "" : ", and its inertia is that of the mesh, as FEBio's is none"));
    if (!sound) body.inertia = body.mesh.inertia;
  }
  model.bodies.push_back(std::move(body));
}

/// The convex hull of a body's nodes, to be drawn.
void put_shape(const FebModel& model, const FebBody& body, const NodeBuilder& make,
               SourceNode& node) {
  if (model.file.options.shapes == "none" || body.nodes.size() < 4 ||
      body.nodes.size() > kMostHullPoints)
    return;
  std::vector<Vec3> corners;
  for (const int n : body.nodes)
    corners.push_back(model.mesh.nodes[static_cast<std::size_t>(n)] - body.com);
  try {
    const geometry::TriangleSurface hull = geometry::convex_hull(body.name, corners);
    SourceNode points = make.list();
    for (const Vec3& x : hull.points) points.children.push_back(make.vector(x));
    SourceNode given = make.map(), shape = make.map();
    make.put(given, "points", std::move(points));
    make.put(shape, "hull", std::move(given));
    make.put(node, "shape", make.list({std::move(shape)}));
    make.put(node, "position_of", make.text("com"));
  } catch (const InputError&) {
    return;  // Flat: not drawn.
  }
}

/// Locks each body that has a parent to it.
void lock_to_parents(FebModel& model) {
  for (const FebBody& body : model.bodies) {
    if (!body.parent) continue;
    const auto parent = std::find_if(model.bodies.begin(), model.bodies.end(),
                                     [&](const FebBody& b) { return b.id == *body.parent; });
    if (parent == model.bodies.end() || &*parent == &body) {
      model.file.xml.fault(*body.at,
                           format("<parent_id> of {} is {}, which is no other rigid body",
                                  quote(body.material), *body.parent),
                           "Give the id of a material of type \"rigid body\".");
      continue;
    }
    const NodeBuilder make = model.file.make(*body.at);
    SourceNode joint = make.map();
    make.put(joint, "type", make.text("fixed"));
    make.put(joint, "bodies", make.list({make.text(parent->name), make.text(body.name)}));
    make.put(joint, "at", make.vector(body.com));
    model.add_joint(*body.at, body.name + "_parent", std::move(joint));
  }
}

}  // namespace

bool FebBody::is_fixed() const {
  return std::all_of(freedoms.begin(), freedoms.end(),
                     [](const FebFreedom& f) { return f.kind == Freedom::fixed; });
}

bool FebBody::can_move() const {
  return std::any_of(freedoms.begin(), freedoms.end(),
                     [](const FebFreedom& f) { return f.kind == Freedom::free; });
}

bool FebBody::is_centred() const {
  if (!(mesh.mass > 0.0)) return true;
  const double radius = std::sqrt(mesh.inertia.trace() / mesh.mass);
  return (com - mesh.com).norm() <= kSamePoint * radius;
}

void read_feb_materials(FebModel& model, const Element& section) {
  std::set<std::string> taken{"ground"};
  for (const Element* e : model.file.xml.children(section, "material")) {
    const std::string type = model.file.type(*e);
    if (type == "rigid body")
      read_body(model, *e, taken);
    else if (!type.empty())
      model.solids.read_material(*e, type);
  }
  lock_to_parents(model);
}

SourceNode write_feb_bodies(FebModel& model) {
  const NodeBuilder top = model.file.make(model.file.xml.root());
  SourceNode bodies = top.map();
  for (FebBody& body : model.bodies) {
    const NodeBuilder make = model.file.make(*body.at);
    SourceNode node = make.map();
    if (!body.is_fixed()) {
      double mass = body.mesh.mass;
      Mat3 inertia = body.inertia;
      if (!(mass > 0.0)) {
        mass = 1.0;
        inertia = Mat3::Identity();
        if (model.dynamic && body.can_move())
          model.file.xml.fault(*body.at, format("{} has no mass", quote(body.material)),
                               "Give it elements and a density, or fix all its freedoms.");
        else
          model.file.approximated(
              *body.at, format("{} has no mass: it takes 1 kg and 1 kg m^2, without weight",
                               quote(body.material)));
      }
      make.put(node, "mass", make.number(mass));
      make.put(node, "inertia", make.inertia(inertia));
    }
    make.put(node, "position", make.vector(body.com));
    put_feb_freedoms(model, body, make, node);
    const bool at_rest = !model.dynamic || body.is_fixed();
    if (body.velocity && !at_rest) make.put(node, "velocity", make.vector(*body.velocity));
    if (body.spin && !at_rest) make.put(node, "angular_velocity", make.vector(*body.spin));
    put_shape(model, body, make, node);
    model.solids.put_contact(body, make, node);
    make.put(bodies, body.name, std::move(node));
  }
  return bodies;
}

}  // namespace polhode::io
