// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/base/format.hpp>
#include <polhode/io/read_context.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {
namespace {

/// A world point at the start, seen from a body's centre of mass in its axes.
Vec3 seen_from(const ReadContext& context, int body, const Vec3& point) {
  if (body == kGround) return point;
  const BodySpec& b = context.model.bodies[static_cast<std::size_t>(body)];
  return b.orientation.conjugate() * (point - b.position);
}

/// A point in the user's body coordinates, seen from the centre of mass.
Vec3 from_com(const ReadContext& context, int body, const Vec3& point) {
  if (body == kGround) return point;
  return point - context.model.bodies[static_cast<std::size_t>(body)].com;
}

/// Whether a joint leaves one rotation free, and that about its z.
bool turns_about_z(const JointSpec& joint) {
  if (joint.type.empty()) return true;  // Its own fault is told already.
  const auto has = [&](const std::string& freedom) {
    return std::find(joint.free.begin(), joint.free.end(), freedom) != joint.free.end();
  };
  const JointKind& kind = joint_kind(joint.type);
  if (kind.takes_free_list) return has("rz") && !has("rx") && !has("ry");
  const std::string& free = kind.free;
  const auto leaves = [&](const char* freedom) { return free.find(freedom) != std::string::npos; };
  return leaves("Rz") && !leaves("Rx") && !leaves("Ry");
}

class LoadReader {
 public:
  LoadReader(ReadContext& context, const SourceNode& node, LoadSpec& load, const FieldTable& table)
      : context_(context),
        load_(load),
        table_(table),
        section_(context, node, load.place, "loads." + load.name, table) {}

  void read() {
    if (table_.find("solid")) {
      read_on_solid();
    } else {
      read_on_bodies(load_kind(load_.type));
    }
    for (const Field& field : table_.fields)
      if (field.kind == FieldKind::kNumber)
        if (const auto value = section_.number(field.name)) load_.parameters[field.name] = *value;
  }

 private:
  /// A force or moment on one body.
  void read_wrench(const LoadKind& kind) {
    if (const auto body = section_.body("body")) {
      load_.b = *body;
      if (*body == kGround)
        section_.fault("body", "a load on the ground moves nothing", "Name a body.");
    }
    if (const auto vector = section_.time_vector(kind.vector)) load_.vector = *vector;
    load_.body_fixed = section_.boolean("body_fixed").value_or(false);
    if (kind.turns) return;  // The same wherever it acts.
    if (section_.refuse_both("at", "at_body", "Give one of them.")) return;
    if (const auto point = section_.vector("at")) load_.Z_b = seen_from(context_, load_.b, *point);
    if (const auto point = section_.vector("at_body"))
      load_.Z_b = from_com(context_, load_.b, *point);
  }

  void read_on_bodies(const LoadKind& kind) {
    switch (kind.place) {
      case LoadPlace::body:
        read_wrench(kind);
        break;
      case LoadPlace::points:
        read_spring();
        break;
      case LoadPlace::joint:
        if (kind.drives.empty())
          read_torsional_spring();
        else
          read_motor(kind);
        break;
    }
  }

  /// A load on nodes or faces of a deformable solid.
  void read_on_solid() {
    if (const SourceNode* value = section_.find("solid"))
      if (const auto solid = read_solid_name(context_, *value, section_.path("solid")))
        load_.solid = *solid;
    for (const char* key : {"surface", "nodes"}) {
      if (!table_.find(key) || !section_.has(key)) continue;
      if (auto selection = read_selections(context_, *section_.find(key), section_.path(key)))
        load_.selection = std::move(*selection);
    }
    if (table_.find("pressure")) load_.value = section_.time_number("pressure");
    if (table_.find("follower")) load_.follower = section_.boolean("follower").value_or(true);
    if (table_.find("keeps"))
      if (const auto keeps = section_.choice("keeps")) load_.keeps = *keeps;
    for (const char* key : {"traction", "acceleration", "force"})
      if (table_.find(key))
        if (const auto vector = section_.time_vector(key)) load_.vector = *vector;
  }

  void read_spring() {
    if (const auto bodies = section_.body_pair("bodies")) {
      load_.a = (*bodies)[0];
      load_.b = (*bodies)[1];
    }
    if (section_.refuse_both("at", "at_body", "Give one of them.")) return;
    if (section_.misses("at") && section_.misses("at_body"))
      section_.fault("'at' is missing", "Give at (world) or at_body (a point on each body).");
    if (const auto points = section_.vector_pair("at")) {
      load_.Z_a = seen_from(context_, load_.a, (*points)[0]);
      load_.Z_b = seen_from(context_, load_.b, (*points)[1]);
    }
    if (const auto points = section_.vector_pair("at_body")) {
      load_.Z_a = from_com(context_, load_.a, (*points)[0]);
      load_.Z_b = from_com(context_, load_.b, (*points)[1]);
    }
    require_effect();
  }

  void read_torsional_spring() {
    require_effect();
    const JointSpec* joint = read_joint();
    if (joint && !turns_about_z(*joint))
      section_.fault("joint",
                     format("the {} joint {} has no angle about its axis alone", joint->type,
                            quote(joint->name)),
                     "Name a joint that turns about its axis, such as a revolute one.");
  }

  void read_motor(const LoadKind& kind) {
    read_joint();
    if (const auto coordinate = section_.choice("coordinate")) load_.coordinate = *coordinate;
    std::string keys;
    for (const DriveParameter& d : kind.drives) {
      keys += (keys.empty() ? "" : ", ") + d.name;
      if (!section_.has(d.name)) continue;
      if (!load_.drive.empty()) {
        section_.fault(d.name, format("is given beside '{}'", load_.drive),
                       "Give one of them: a motor follows one function of time.");
        return;
      }
      load_.drive = d.name;
      load_.value = section_.time_number(d.name);
    }
    if (load_.drive.empty())
      section_.fault("has nothing to follow", format("Give one of: {}.", keys));
  }

  /// The joint that is named, noted in the load; null if there is none.
  const JointSpec* read_joint() {
    const SourceNode* value = section_.find("joint");
    if (!value) return nullptr;
    const std::string path = section_.path("joint");
    const auto name = read_text(context_, *value, path);
    if (!name) return nullptr;
    const auto found = context_.joints.find(*name);
    if (found == context_.joints.end()) {
      const std::vector<std::string> names = context_.joint_names();
      section_.fault(
          "joint", "unknown joint " + quote(*name),
          did_you_mean(*name, names) +
              (names.empty() ? "The model has no joints." : "Joints: " + name_list(names) + "."));
      return nullptr;
    }
    const JointSpec& joint = context_.model.joints[static_cast<std::size_t>(found->second)];
    load_.joint = *name;
    load_.a = joint.a;
    load_.b = joint.b;
    return &joint;
  }

  void require_effect() {
    if (section_.misses("stiffness") && section_.misses("damping"))
      section_.fault("has neither stiffness nor damping", "Give one of them, or both.");
  }

  ReadContext& context_;
  LoadSpec& load_;
  const FieldTable& table_;
  Section section_;
};

}  // namespace

void read_loads(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "loads")) continue;
    LoadSpec load;
    load.name = key.name;
    load.place = context.tree.place_of(key, node.children[k]);
    if (const FieldTable* table = read_kind(context, node.children[k], load.place,
                                            "loads." + key.name, load_tables(), load.type))
      LoadReader(context, node.children[k], load, *table).read();
    context.loads.emplace(load.name, static_cast<int>(context.model.loads.size()));
    context.model.loads.push_back(std::move(load));
  }
}

}  // namespace polhode
