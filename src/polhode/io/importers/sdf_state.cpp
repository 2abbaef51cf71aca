// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/sdf_state.hpp>

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

/// Differences of poses of a state that are none: those of numbers with six digits [m, rad].
constexpr double kSameState = 1e-5;
/// Displacements in a model, and velocities, that are left out: those of a robot that rests on soft
/// contacts and joints [m, rad, m/s, rad/s].
constexpr double kAtRest = 1e-3;

double distance(const Pose& a, const Pose& b) {
  return std::max((a.p - b.p).norm(), (a.R - b.R).norm());
}

/// Model of the world that a link is in; "" for one of the world itself.
std::string outermost(const std::string& link) {
  const std::size_t end = link.find("::");
  return end == std::string::npos ? "" : link.substr(0, end);
}

}  // namespace

void SdfState::read(const Element& world) {
  XmlFile& xml = file_.xml;
  for (const Element* state : xml.children(world, "state")) {
    for (const Element* e : xml.children(*state, "model")) read_model(*e);
    for (const char* tag : {"insertions", "deletions"})
      if (const Element* e = xml.child(*state, tag); e != nullptr && !e->NoChildren())
        file_.refuse(*e, format("<{}> of a <state> is not read", tag),
                     "Add the models to the world, or remove them from it.");
    xml.skip(*state);
  }
}

void SdfState::read_model(const Element& e) {
  const std::string name = file_.xml.required_text(e, "name");
  if (!name.empty() && !models_.emplace(name, &e).second)
    file_.xml.fault(e, format("the <state> places the model {} twice", quote(name)),
                    "Keep one of the two.");
  const auto scale = file_.vector(e, "scale");
  if (scale && *scale != Vec3::Ones())
    file_.refuse(e, format("the <state> scales the model {}", quote(name)),
                 "Give the sizes in the model.");
}

void SdfState::place(const std::string& model, SdfFrame& frame) {
  const auto found = models_.find(model);
  if (found == models_.end() || file_.xml.child(*found->second, "pose") == nullptr) return;
  SdfPose pose = file_.pose(*found->second);
  const std::string& base = frame.pose.relative_to;
  const bool in_world = (base.empty() || base == "world") && frame.placement.empty();
  if (in_world && pose.relative_to.empty() && distance(pose.pose, frame.pose.pose) < kSameState)
    return;  // The model's own pose may have more digits.
  if (pose.relative_to.empty()) pose.relative_to = "world";
  frame.pose = pose;
  frame.placement.clear();
  moved_.insert(model);
  file_.approximated(*found->second,
                     format("the model {} starts where the <state> has it", quote(model)));
}

void SdfState::check(SdfFrames& frames) {
  for (const auto& [name, e] : models_) check_model(*e, name, frames);
}

void SdfState::check_model(const Element& e, const std::string& name, SdfFrames& frames) {
  XmlFile& xml = file_.xml;
  const int model = frames.required(e, 0, name);
  if (model < 0) return;
  const auto links = xml.children(e, "link");
  for (const Element* at : links) {
    const std::string link = name + "::" + xml.required_text(*at, "name");
    const int frame = frames.required(*at, 0, link);
    if (frame < 0) continue;
    if (xml.child(*at, "pose") != nullptr) {
      const SdfPose pose = file_.pose(*at);
      if (pose.relative_to.empty() && distance(pose.pose, frames.in_world(frame)) > kAtRest)
        file_.refuse(*at, format("the <state> moves the link {} in its model", quote(link)),
                     "Remove it from the <state>, and give import.start of the joints.");
    }
    if (moves(*at, "velocity"))
      file_.refuse(*at, format("the link {} moves in the <state>", quote(link)),
                   "Remove its velocity, and give one in an overlay.");
  }
  for (const Element* joint : xml.children(e, "joint"))
    if (links.empty() && (moves(*joint, "angle") || moves(*joint, "position")))
      file_.refuse(*joint, format("the <state> moves a joint of {}", quote(name)),
                   "Remove it from the <state>, and give import.start of the joint.");
  for (const Element* inner : xml.children(e, "model"))
    check_model(*inner, name + "::" + xml.required_text(*inner, "name"), frames);
}

bool SdfState::moves(const Element& parent, const char* tag) {
  for (const Element* e : file_.xml.children(parent, tag))
    if (const auto values = file_.xml.content_numbers(*e, 1, 6))
      for (const double v : *values)
        if (std::abs(v) > kAtRest) return true;
  return false;
}

void SdfState::check(const std::vector<RobotJoint>& joints) {
  if (moved_.empty()) return;
  for (const RobotJoint& joint : joints) {
    const std::string a = outermost(joint.parent), b = outermost(joint.child);
    if (a != b && (moved_.contains(a) || moved_.contains(b)))
      file_.refuse(*joint.at,
                   format("the joint {} holds a model that the <state> moves", quote(joint.name)),
                   "Remove the model from the <state>, and give import.start of the joint.");
  }
}

}  // namespace polhode::io
