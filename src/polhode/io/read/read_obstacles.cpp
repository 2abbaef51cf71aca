// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

namespace {

/// An obstacle of a cable, from its section.
class ObstacleReader {
 public:
  ObstacleReader(ReadContext& context, const SourceNode& node, const std::string& path,
                 ObstacleSpec& obstacle)
      : context_(context),
        obstacle_(obstacle),
        section_(context, node, obstacle.place, path, obstacle_fields()) {}

  void read(std::size_t points) {
    const auto type = section_.choice("type");
    if (type) read_sizes(*type);
    const auto body = section_.body("body");
    obstacle_.at.body = body.value_or(kGround);
    obstacle_.at.Z = section_.vector("at").value_or(Vec3::Zero());
    if (obstacle_.at.body != kGround)
      obstacle_.at.Z -= context_.model.bodies[static_cast<std::size_t>(obstacle_.at.body)].com;
    obstacle_.side = section_.direction("side");
    if (obstacle_.side && type == "cylinder" &&
        obstacle_.axes.col(2).cross(*obstacle_.side).norm() < kAlongAxis)
      section_.fault("side", "is along the axis of the cylinder",
                     "Give a direction across it, or leave it out.");
    if (points > 2 && section_.misses("after"))
      section_.fault("'after' is missing",
                     format("Give the number of the point before it, 1 to {}.", points - 1));
    obstacle_.after = section_.integer("after").value_or(1) - 1;
  }

 private:
  void refuse(const std::string& type, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
      if (section_.has(key))
        section_.fault(key, format("does not belong to a {}", type), "Leave it out.");
  }

  void read_sizes(const std::string& type) {
    if (type == "ellipsoid") {
      refuse(type, {"radius", "axis"});
      if (section_.misses("semi_axes"))
        section_.fault("'semi_axes' is missing", "Give three lengths above zero.");
      const auto sizes = section_.vector("semi_axes");
      obstacle_.semi_axes = sizes.value_or(Vec3::Ones());
      if (sizes && !(sizes->minCoeff() > 0.0))
        section_.fault("semi_axes", "has a length that is not above zero",
                       "Give three lengths above zero.");
      if (const SourceNode* node = section_.find("orientation"))
        if (const auto q = read_orientation(context_, *node, section_.path("orientation")))
          obstacle_.axes = q->toRotationMatrix();
      return;
    }
    refuse(type, {"semi_axes", "orientation"});
    if (section_.misses("radius")) section_.fault("'radius' is missing", "Give its radius.");
    const double radius = section_.number("radius").value_or(1.0);
    obstacle_.semi_axes = Vec3::Constant(radius);
    if (type == "sphere") return refuse(type, {"axis"});
    obstacle_.semi_axes.z() = std::numeric_limits<double>::infinity();
    obstacle_.axes =
        Quat::FromTwoVectors(Vec3::UnitZ(), section_.direction("axis").value_or(Vec3::UnitZ()))
            .toRotationMatrix();
  }

  /// Sine of the angle to the axis below which a direction is along it.
  static constexpr double kAlongAxis = 1e-9;
  ReadContext& context_;
  ObstacleSpec& obstacle_;
  Section section_;
};

}  // namespace

void read_obstacles(ReadContext& context, Section& section, CableLineSpec& cable) {
  const SourceNode* node = section.find("around");
  if (!node || node->kind == SourceNode::Kind::kEmpty) return;
  const std::string path = section.path("around");
  if (!node->is_map()) {
    context.fault(*node, path,
                  "expects a map from names to obstacles, but is " + node->description(),
                  "Write {bone: {type: cylinder, body: arm, radius: 2 cm}}, for example.");
    return;
  }
  for (std::size_t k = 0; k < node->keys.size(); ++k) {
    const SourceNode::Key& key = node->keys[k];
    const SourceNode& value = node->children[k];
    if (!check_name(context, key, value, path)) continue;
    ObstacleSpec obstacle;
    obstacle.name = key.name;
    obstacle.place = context.tree.place_of(key, value);
    ObstacleReader reader(context, value, path + "." + key.name, obstacle);
    if (!value.is_map()) continue;
    reader.read(cable.through.size());
    cable.around.push_back(std::move(obstacle));
  }
}

}  // namespace polhode::io
