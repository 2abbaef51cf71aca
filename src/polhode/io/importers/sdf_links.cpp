// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_links.hpp>

#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/shapes.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;
using geometry::MassProperties;

/// Density of a collision that gives none, with which SDFormat computes inertias [kg/m³].
constexpr double kStandardDensity = 1000.0;

class SdfLinkReader {
 public:
  SdfLinkReader(SdfFile& file, SdfFrames& frames, const SdfLink& from, RobotLink& link)
      : file_(file), xml_(file.xml), frames_(frames), from_(from), link_(link) {}

  void read() {
    const Element& e = *from_.at;
    for (const char* tag : {"visual", "collision"})
      for (const Element* shape : xml_.children(e, tag)) read_shape(*shape);
    read_inertial(xml_.child(e, "inertial"));
    link_.carried = file_.boolean(e, "gravity", true) ? 0.0 : 1.0;
    if (file_.boolean(e, "kinematic", false) && !from_.is_static)
      file_.refuse(e, format("the link {} is kinematic", quote(link_.name)),
                   "Make its model static, or prescribe its motion by a joint.");
    if (const Element* decay = xml_.child(e, "velocity_decay")) {
      if (file_.not_negative(*decay, "linear") > 0.0 || file_.not_negative(*decay, "angular") > 0.0)
        file_.refuse(*decay,
                     format("<velocity_decay> of {} has no physical unit", quote(link_.name)),
                     "Leave it out, and add a damper or drag.");
    }
    file_.ignored.attributes(e, {"name", "type"});
    file_.ignored.skip(
        e, {"self_collide", "enable_wind", "must_be_base_link", "sensor", "light", "battery",
            "audio_sink", "audio_source", "projector", "particle_emitter", "plugin"});
  }

 private:
  void read_inertial(const Element* e) {
    if (e == nullptr) {
      if (from_.is_static) return;
      link_.mass = {1.0, Vec3::Zero(), Mat3::Identity()};
      link_.has_inertial = true;
      file_.approximated(*from_.at,
                         format("the link {} has no <inertial>: 1 kg and 1 kg m^2, which are the "
                                "standard values",
                                quote(link_.name)));
      return;
    }
    link_.has_inertial = true;
    if (const Element* added = xml_.child(*e, "fluid_added_mass")) {
      xml_.skip(*added);
      file_.refuse(*added, format("the link {} has a <fluid_added_mass>", quote(link_.name)),
                   "Leave it out.");
    }
    if (file_.flag(*e, "auto", false)) {
      read_automatic(*e);
      return;
    }
    file_.ignored.skip(*e, {"density", "auto_inertia_params"});
    const SdfPose given = file_.pose(*e);
    if (!given.relative_to.empty())
      xml_.fault(*e,
                 format("the pose of the mass of {} is relative to {}, not to its link",
                        quote(link_.name), quote(given.relative_to)),
                 "Leave relative_to out, and give the pose in the link's frame.");
    const Pose& pose = given.pose;
    link_.mass.com = pose.p;
    link_.mass.mass = file_.number(*e, "mass").value_or(1.0);
    if (link_.mass.mass < 0.0)
      xml_.fault(*e, format("the mass of {} is {}", quote(link_.name), link_.mass.mass),
                 "Give a mass that is not negative.");
    Mat3 J = Mat3::Identity();
    if (const Element* inertia = xml_.child(*e, "inertia")) {
      const auto entry = [&](const char* tag, double standard) {
        return file_.number(*inertia, tag).value_or(standard);
      };
      J(0, 0) = entry("ixx", 1.0);
      J(1, 1) = entry("iyy", 1.0);
      J(2, 2) = entry("izz", 1.0);
      J(0, 1) = J(1, 0) = entry("ixy", 0.0);
      J(0, 2) = J(2, 0) = entry("ixz", 0.0);
      J(1, 2) = J(2, 1) = entry("iyz", 0.0);
    } else if (!from_.is_static) {
      file_.approximated(*e, format("<inertial> of {} has no <inertia>: 1 kg m^2, which is the "
                                    "standard value",
                                    quote(link_.name)));
    }
    const Mat3 turned = pose.R * J * pose.R.transpose();
    link_.mass.inertia = pose.R.isIdentity(0.0) ? J : Mat3(0.5 * (turned + turned.transpose()));
  }

  /// Mass properties by the shapes of collisions and their densities.
  void read_automatic(const Element& e) {
    const double standard = file_.number(e, "density").value_or(kStandardDensity);
    file_.ignored.skip(e, {"mass", "pose", "inertia", "auto_inertia_params"});
    std::vector<MassProperties> parts;
    for (const Element* collision : xml_.children(*from_.at, "collision")) {
      const auto shape = std::find_if(link_.collision.begin(), link_.collision.end(),
                                      [&](const RobotShape& s) { return s.at == collision; });
      const geometry::ShapeKind* kind =
          shape == link_.collision.end() ? nullptr : geometry::find_shape_kind(shape->kind);
      const double density = file_.number(*collision, "density").value_or(standard);
      if (kind == nullptr || shape->kind == "mesh" || !(density > 0.0)) {
        file_.refuse(
            *collision,
            format("the mass of {} cannot be computed from this collision", quote(link_.name)),
            "Give <mass> and <inertia> instead of auto=\"true\".");
        continue;
      }
      try {
        const MassProperties own =
            geometry::shape_mass_properties("collision", *kind, shape->sizes, density);
        parts.push_back(geometry::placed(own, shape->pose.p, shape->pose.R));
      } catch (const InputError& error) {  // Numbers that overflow.
        xml_.fault(*collision, "the mass cannot be computed: " + error.what_is_wrong(),
                   "Give another size, or a density that is finite.");
      }
    }
    if (!parts.empty())
      link_.mass = geometry::composed(parts);
    else if (!from_.is_static)
      file_.refuse(e, format("the link {} has no collision that gives its mass", quote(link_.name)),
                   "Give <mass> and <inertia> instead of auto=\"true\".");
  }

  void read_shape(const Element& e) {
    const bool collision = std::string_view(e.Name()) == "collision";
    RobotShape shape;
    shape.at = &e;
    const SdfPose pose = file_.pose(e);
    shape.pose = pose.pose;
    if (!pose.relative_to.empty()) {
      const int base = frames_.required(e, frames_[from_.frame].scope, pose.relative_to);
      if (base >= 0) shape.pose = frames_.between(from_.frame, base) * shape.pose;
    }
    file_.ignored.attributes(e, {"name"});
    if (collision) static_cast<void>(xml_.child(e, "density"));
    file_.ignored.skip(
        e, {"material", "surface", "laser_retro", "max_contacts", "transparency", "cast_shadows",
            "meta", "visibility_flags", "plugin", "auto_inertia_params"});
    const Element* geometry = xml_.child(e, "geometry");
    if (geometry == nullptr) {
      xml_.fault(e, format("<{}> has no <geometry>", e.Name()), "Add it, or leave the tag out.");
      return;
    }
    if (read_geometry(*geometry, shape, collision))
      (collision ? link_.collision : link_.visual).push_back(std::move(shape));
  }

  /// Number that must be there and positive; 0 after an error.
  double length(const Element& e, const char* tag) {
    const auto value = file_.number(e, tag);
    if (value && *value > 0.0) return *value;
    if (value || xml_.child(e, tag) == nullptr)
      xml_.fault(e,
                 format("<{}> of <{}> must be above 0, but is {}", tag, e.Name(),
                        value ? format("{}", *value) : "missing"),
                 "Give a length [m].");
    return 0.0;
  }

  /// Three lengths that must be there and positive, times a factor; none after an error.
  std::vector<double> lengths(const Element& e, const char* tag, double factor) {
    const auto size = file_.vector(e, tag);
    if (size && size->minCoeff() > 0.0)
      return {factor * size->x(), factor * size->y(), factor * size->z()};
    if (size || xml_.child(e, tag) == nullptr)
      xml_.fault(e, format("<{}> of <{}> must be three numbers above 0", tag, e.Name()),
                 "Give lengths [m].");
    return {};
  }

  bool read_geometry(const Element& e, RobotShape& shape, bool collision) {
    if (const Element* box = xml_.child(e, "box")) {
      shape.kind = "box";
      shape.sizes = lengths(*box, "size", 1.0);
    } else if (const Element* ball = xml_.child(e, "sphere")) {
      shape.kind = "sphere";
      shape.sizes = {2.0 * length(*ball, "radius")};
    } else if (const Element* bar = xml_.child(e, "cylinder")) {
      shape.kind = "cylinder";
      shape.sizes = {2.0 * length(*bar, "radius"), length(*bar, "length")};
    } else if (const Element* pill = xml_.child(e, "capsule")) {
      shape.kind = "capsule";  // The length in SDFormat is without the hemispheres.
      const double radius = length(*pill, "radius");
      shape.sizes = {2.0 * radius, length(*pill, "length") + 2.0 * radius};
    } else if (const Element* egg = xml_.child(e, "ellipsoid")) {
      shape.kind = "ellipsoid";
      shape.sizes = lengths(*egg, "radii", 2.0);
    } else if (const Element* plane = xml_.child(e, "plane")) {
      shape.kind = "plane";
      const Vec3 normal = file_.vector(*plane, "normal").value_or(Vec3::UnitZ());
      static_cast<void>(xml_.child(*plane, "size"));  // Drawn size only.
      if (const double largest = normal.cwiseAbs().maxCoeff(); largest > 0.0)
        shape.pose.R = shape.pose.R * axes_along((normal / largest).normalized());
      else
        xml_.fault(*plane, "the normal of <plane> has no length", "Write 0 0 1, for example.");
      return true;
    } else if (const Element* mesh = xml_.child(e, "mesh")) {
      return read_mesh(*mesh, shape, collision);
    } else {
      for (const Element* other = e.FirstChildElement(); other != nullptr;
           other = other->NextSiblingElement()) {
        xml_.skip(*other);
        file_.ignored.add(*other, format("<{}> in <geometry>", other->Name()), "is not read");
      }
      return false;
    }
    return std::all_of(shape.sizes.begin(), shape.sizes.end(), [](double s) { return s > 0.0; }) &&
           !shape.sizes.empty();
  }

  bool read_mesh(const Element& e, RobotShape& shape, bool collision) {
    shape.kind = "mesh";
    shape.file = file_.required_text(e, "uri");
    shape.scale = file_.vector(e, "scale").value_or(Vec3::Ones());
    file_.ignored.attributes(e, {"optimization"});
    if (const Element* part = xml_.child(e, "submesh")) {
      xml_.skip(*part);
      if (collision && file_.options.shapes == "collision")
        file_.refuse(*part, format("a <submesh> of {} is not read", quote(shape.file)),
                     "Save it as a mesh of its own.");
      else
        file_.ignored.add(*part, "a mesh with a <submesh>", "is not read");
      return false;
    }
    shape.folder = from_.folder;  // Which may be that of an included file.
    return !shape.file.empty();
  }

  SdfFile& file_;
  XmlFile& xml_;
  SdfFrames& frames_;
  const SdfLink& from_;
  RobotLink& link_;
};

}  // namespace

void read_sdf_link(SdfFile& file, SdfFrames& frames, const SdfLink& from, RobotLink& link) {
  SdfLinkReader(file, frames, from, link).read();
}

}  // namespace polhode::io
