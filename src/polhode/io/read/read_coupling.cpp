// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_coupling.hpp>
#include <polhode/joints/registry.hpp>

namespace polhode::io {

namespace {

/// A length if the coordinate is a displacement, else an angle.
Dimension dimension_of(const ReadContext& context, const CoordinateSpec& of) {
  bool turns = !of.coordinate.empty() && of.coordinate[0] == 'r';
  const auto found = context.joints.find(of.joint);
  if (of.coordinate.empty() && found != context.joints.end()) {
    const JointSpec& joint = context.model.joints[static_cast<std::size_t>(found->second)];
    if (joint.type.empty()) return dimensions::kNone;  // Its own error is already reported.
    const JointKind& kind = joint_kind(joint.type);
    turns = !kind.takes_free_list && kind.free.find('R') != std::string::npos;
    for (const std::string& free : joint.free) turns = turns || free[0] == 'r';
  }
  return turns ? dimensions::kAngle : dimensions::kLength;
}

}  // namespace

std::string read_joint_of_load(ReadContext& context, const Section& section, const char* key,
                               const SourceNode* value, int* a, int* b) {
  if (!value) return {};
  const auto name = read_text(context, *value, section.path(key));
  if (!name) return {};
  const auto found = context.joints.find(*name);
  if (found == context.joints.end()) {
    const std::vector<std::string> names = context.joint_names();
    context.fault(
        *value, section.path(key), "unknown joint " + quote(*name),
        did_you_mean(*name, names) +
            (names.empty() ? "The model has no joints." : "Joints: " + name_list(names) + "."));
    return {};
  }
  const JointSpec& joint = context.model.joints[static_cast<std::size_t>(found->second)];
  *a = joint.a;
  *b = joint.b;
  return *name;
}

void read_coupling(ReadContext& context, Section& section, LoadSpec& load) {
  const SourceNode* joints = section.find("joints");
  if (!joints) return;
  const auto count = joints->children.size();
  if (!joints->is_list() || count == 0) {
    section.fault("joints", "expects a list of joints", "Write [first, second, third].");
    return;
  }
  std::vector<CoordinateSpec> row(count);
  int a = kGround, b = kGround;
  for (std::size_t i = 0; i < count; ++i) {
    row[i].joint = read_joint_of_load(context, section, "joints", &joints->children[i],
                                      i == 0 ? &load.a : &a, i == 0 ? &load.b : &b);
    if (row[i].joint.empty()) return;
  }
  if (const SourceNode* names = section.find("coordinates")) {
    if (!names->is_list() || names->children.size() != count) {
      section.fault("coordinates", format("expects one for each of the {} joints", count),
                    "Write [rz, z], for example.");
      return;
    }
    const std::vector<std::string> known{"x", "y", "z", "rx", "ry", "rz"};
    for (std::size_t i = 0; i < count; ++i)
      if (const auto word =
              read_choice(context, names->children[i], section.path("coordinates"), known))
        row[i].coordinate = *word;
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (row[i].joint == row[k].joint && row[i].coordinate == row[k].coordinate) {
        section.fault("joints", format("name a coordinate of {} twice", quote(row[i].joint)),
                      "Name each once, with the sum of its factors.");
        return;
      }
  const Dimension of_first = dimension_of(context, row[0]);
  const SourceNode* factors = section.find("factors");
  const std::size_t given = !factors ? 0 : factors->is_list() ? factors->children.size() : 1;
  if (given + 1 != count) {
    section.fault(
        factors ? "factors" : "joints",
        format("needs {} factors for {} joints, but {} are given", count - 1, count, given),
        "Give one for each joint but the first: q_1 = f_1 q_2 + f_2 q_3 + ...");
    return;
  }
  for (std::size_t i = 1; i < count; ++i)
    if (const auto value = read_number(
            context, factors->is_list() ? factors->children[i - 1] : *factors,
            section.path("factors"),
            {.name = "factors", .dimension = of_first + -1.0 * dimension_of(context, row[i])}))
      row[i].factor = *value;
  if (const SourceNode* offset = section.find("offset"))
    if (const auto value = read_number(context, *offset, section.path("offset"),
                                       {.name = "offset", .dimension = of_first}))
      load.parameters["offset"] = *value;
  load.joint = row[0].joint;
  load.coordinate = row[0].coordinate;
  load.others.assign(row.begin() + 1, row.end());
}

}  // namespace polhode::io
