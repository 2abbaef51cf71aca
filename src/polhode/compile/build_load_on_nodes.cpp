// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/build_load_on_nodes.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// An end of a load at the start.
struct LoadEnd {
  NodePoint point;
  Vec3 start = Vec3::Zero();  ///< World [m].
};

LoadEnd end_on_solid(const Model& model, const LoadSpec& load, std::size_t k,
                     const SystemMap& map) {
  const auto solid = static_cast<std::size_t>(load.end_solids[k]);
  const Vec3& X = k == 0 ? load.Z_a : load.Z_b;
  const MeshSpec& mesh = model.solids.at(solid).mesh;
  return {node_point(map.solids.at(solid), format("loads.{}.at", load.name), X),
          mesh.position + mesh.orientation.normalized() * X};
}

/// A node of its own, bonded to the body or fixed.
LoadEnd end_on_body(System& system, const Model& model, const LoadSpec& load, std::size_t k,
                    const SystemMap& map) {
  const int body = k == 0 ? load.a : load.b;
  NodeData node;
  node.body = kGround;
  node.position = node.Z = k == 0 ? load.Z_a : load.Z_b;
  if (body != kGround) {
    const BodySpec& spec = model.bodies.at(static_cast<std::size_t>(body));
    if (spec.point_mass && !spec.fixed && !node.Z.isZero(0.0))
      throw InputError(format("loads.{}", load.name),
                       format("exerts a moment on '{}', which is a point mass", spec.name),
                       "Attach it at the point mass itself, or give the body an inertia");
    node.position = spec.position + spec.orientation.normalized() * node.Z;
    node.body = map.body.at(static_cast<std::size_t>(body));
    if (node.body == kGround) node.Z = node.position;
  }
  const Vec3 start = node.position;
  return {{{system.add_node(node)}, {1.0}}, start};
}

}  // namespace

const PairOnNodes* add_load_on_nodes(System& system, const Model& model, const LoadSpec& load,
                                     const SystemMap& map) {
  const std::string where = format("loads.{}", load.name);
  const MakeOnNodes make = make_on_nodes(load.type);
  if (make == nullptr)
    throw InputError(where, format("a {} does not act on points of solids", load.type),
                     "Let it act on a body that the solid is bonded to");
  if (load.of_motion.index() != 0)
    throw InputError(where, "a load on a solid cannot be a function of the motion",
                     "Act on a body that the solid is bonded to");
  std::array<LoadEnd, 2> ends;
  for (std::size_t k = 0; k < 2; ++k)
    ends[k] = load.end_solids[k] >= 0 ? end_on_solid(model, load, k, map)
                                      : end_on_body(system, model, load, k, map);
  LoadDescription d{.name = load.name,
                    .bodies = {},
                    .values = load.parameters,
                    .function = load.value,
                    .drive = load.drive,
                    .at_rest = model.analysis.type != "dynamics",
                    .start_length = (ends[1].start - ends[0].start).norm()};
  d.laws = load.laws;
  d.words = load.words;
  std::unique_ptr<PairOnNodes> item = make(d, {std::move(ends[0].point), std::move(ends[1].point)});
  const PairOnNodes* made = item.get();
  system.add_elements(std::move(item));
  return made;
}

}  // namespace polhode
