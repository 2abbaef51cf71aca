// SPDX-License-Identifier: Apache-2.0
#include <iterator>

#include <polhode/model/part_placement.hpp>

namespace polhode {

namespace {

template <class Specs>
void move_behind(Specs& whole, Specs&& part) {
  whole.insert(whole.end(), std::make_move_iterator(part.begin()),
               std::make_move_iterator(part.end()));
}

}  // namespace

void append_part(Model& whole, Model part, const std::string& prefix) {
  const int bodies = static_cast<int>(whole.bodies.size());
  const int solids = static_cast<int>(whole.solids.size());
  const auto shift = [bodies](int& body) {
    if (body != kGround) body += bodies;
  };
  const auto rename = [&](auto& specs) {
    for (auto& spec : specs) spec.name = prefix + spec.name;
  };
  rename(part.bodies);
  for (BodySpec& body : part.bodies)
    if (!body.node_of.empty()) body.node_of = prefix + body.node_of;
  rename(part.joints);
  rename(part.loads);
  rename(part.materials);
  rename(part.solids);
  rename(part.beams);
  rename(part.cables);
  for (JointSpec& joint : part.joints) {
    shift(joint.a);
    shift(joint.b);
  }
  for (LoadSpec& load : part.loads) {
    shift(load.a);
    shift(load.b);
    if (!load.joint.empty()) load.joint = prefix + load.joint;
    if (!load.joint_2.empty()) load.joint_2 = prefix + load.joint_2;
    for (CoordinateSpec& other : load.others) other.joint = prefix + other.joint;
    if (load.solid >= 0) load.solid += solids;
    for (int& solid : load.end_solids)
      if (solid >= 0) solid += solids;
  }
  for (SolidSpec& solid : part.solids) {
    solid.material = prefix + solid.material;
    for (RegionSpec& region : solid.regions) region.material = prefix + region.material;
    for (BondSpec& bond : solid.bonded) shift(bond.body);
  }
  for (BeamSpec& beam : part.beams) {
    beam.first_node += bodies;
    for (BeamBondSpec& bond : beam.bonds) shift(bond.body);
  }
  for (CableLineSpec& cable : part.cables) {
    for (AttachmentSpec& point : cable.through) shift(point.body);
    for (ObstacleSpec& obstacle : cable.around) shift(obstacle.at.body);
    for (CableLineSpec::Piece& piece : cable.pieces) {
      shift(piece.a.body);
      shift(piece.b.body);
    }
  }
  move_behind(whole.bodies, std::move(part.bodies));
  move_behind(whole.joints, std::move(part.joints));
  move_behind(whole.loads, std::move(part.loads));
  move_behind(whole.materials, std::move(part.materials));
  move_behind(whole.solids, std::move(part.solids));
  move_behind(whole.beams, std::move(part.beams));
  move_behind(whole.cables, std::move(part.cables));
}

}  // namespace polhode
