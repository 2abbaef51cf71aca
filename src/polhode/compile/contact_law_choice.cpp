// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/compile/contact_law_choice.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Number of bodies that move and touch, up to which rows cost no more than the barrier; and of
/// those with edges. Bodies that lie flat on each other have many rows, whose cost is their cube,
/// and where roundings of parallel edges overlap, not all steps end.
constexpr int kMostBodiesOfRows = 12, kMostWithEdges = 1;

bool is_sampled(const ShapeSpec& shape) {
  return shape.type == "mesh" || shape.type == "height_field" || shape.type == "tube";
}

bool has_edges(const ShapeSpec& shape) { return shape.type == "box" || shape.type == "hull"; }

/// Whether a shape has a rim: by rows and at coarse steps a disc that falls flat with e = 0 rises
/// again.
bool has_rim(const ShapeSpec& shape) { return shape.type == "cylinder" || shape.type == "cone"; }

bool gives_way(const std::optional<JointLimitsSpec>& limits) {
  return limits && (limits->band || limits->stiffness);
}

}  // namespace

ContactLawChoice choose_contact_law(const Model& model) {
  const AnalysisSpec& a = model.analysis;
  const auto barrier = [](std::string reason) { return ContactLawChoice{"barrier", reason}; };
  if (a.type != "dynamics") return barrier(format("as the analysis is one of {}", a.type));
  if (a.rho_inf != 1.0) return barrier("as rho_inf is below 1");
  if (a.momentum_rate != "momentum") return barrier("as momentum_rate is not momentum");
  if (!model.solids.empty()) return barrier("as there are deformable solids");
  if (!model.cables.empty()) return barrier("as there are cables");
  for (const JointSpec& joint : model.joints)
    if (gives_way(joint.limits) || gives_way(joint.angle_limits))
      return barrier(format("as the stop of joint '{}' gives way", joint.name));
  int moving = 0, with_edges = 0;
  for (const BodySpec& body : model.bodies) {
    bool touches = false, edges = false, rim = false;
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      if (!contact_side(body, s).touches) continue;
      touches = true;
      edges = edges || has_edges(body.shapes[s]);
      rim = rim || has_rim(body.shapes[s]);
      if (is_sampled(body.shapes[s]))
        return barrier(format("as body '{}' has a {}", body.name, body.shapes[s].type));
    }
    if (body.fixed) continue;
    if (rim)
      return barrier(format("as body '{}' has a rim, which may come to lie flat", body.name));
    if (touches) ++moving;
    if (edges) ++with_edges;
  }
  if (with_edges > kMostWithEdges) return barrier("as two bodies with edges may touch");
  if (moving > kMostBodiesOfRows)
    return barrier(format("as more than {} bodies may touch", kMostBodiesOfRows));
  return {"rigid", ""};
}

}  // namespace polhode
