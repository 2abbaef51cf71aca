// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;
using Freedom = FebFreedom::Kind;

/// Number of a freedom by its name: x and Rx are the same; -1 if there is none.
int freedom_of(const std::string& name) {
  static const std::vector<std::string> names{"x", "y", "z", "ru", "rv", "rw"};
  std::string word = lower_case(name);
  if (word == "rx" || word == "ry" || word == "rz") word.erase(0, 1);
  if (word == "u" || word == "v" || word == "w") word = "r" + word;
  const auto found = std::find(names.begin(), names.end(), word);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Reader of constraints, starts and loads of rigid bodies.
class RigidReader {
 public:
  explicit RigidReader(FebModel& model) : model_(model), file_(model.file) {}

  void read_constraint(const Element& e) {
    const std::string type = file_.type(e);
    FebBody* body = model_.body(e, "rb");
    if (type == "rigid_fixed") {
      static const char* const tags[] = {"Rx_dof", "Ry_dof", "Rz_dof",
                                         "Ru_dof", "Rv_dof", "Rw_dof"};
      for (std::size_t k = 0; k < 6; ++k)
        if (file_.boolean(e, tags[k], false) && body != nullptr &&
            freedoms(*body)[k].kind == Freedom::free)
          freedoms(*body)[k] = {Freedom::fixed, {}, &e, false, {}};
    } else if (type == "rigid_displacement" || type == "rigid_rotation") {
      const int k = dof(e, type == "rigid_rotation");
      const FebValue value = file_.value(e, "value");
      const bool relative = file_.boolean(e, "relative", false);
      if (k >= 0 && body != nullptr) prescribe(e, *body, k, value, relative);
    } else if (type == "rigid_rotation_vector" || type == "rigid_euler_angles" ||
               type == "rigid_euler_vector") {
      const bool euler = type != "rigid_rotation_vector";
      static const char* const vectors[] = {"vx", "vy", "vz"};
      static const char* const angles[] = {"Ex", "Ey", "Ez"};
      if (euler) file_.ignored.skip(e, {"convention"});
      for (int k = 0; k < 3; ++k) {
        const FebValue value = file_.value(e, euler ? angles[k] : vectors[k]);
        if (body != nullptr) prescribe(e, *body, 3 + k, value, false);
      }
      if (body == nullptr) return;
      if (body->turned && euler != body->euler)
        file_.refuse(e, format("{} turns by angles and by vectors", quote(body->material)),
                     "Use rigid_euler_angles or rigid_rotation_vector alone.");
      body->turned = true;
      body->euler = euler;
    } else if (!type.empty()) {
      unknown(e, type);
    }
  }

  void read_start(const Element& e) {
    const std::string type = file_.type(e);
    FebBody* body = model_.body(e, "rb");
    if (type == "initial_rigid_velocity" || type == "initial_rigid_angular_velocity") {
      const auto value = file_.vector(e, "value");
      if (value && body != nullptr)
        (type == "initial_rigid_velocity" ? body->velocity : body->spin) = *value;
      if (!model_.dynamic)
        file_.ignored.add(e, format("a start of type {}", type), "has no influence on statics");
    } else if (!type.empty()) {
      unknown(e, type);
    }
  }

  void read_load(const Element& e) {
    const std::string type = file_.type(e);
    const std::string name = file_.xml.text(e, "name").value_or(type);
    static_cast<void>(file_.boolean(e, "relative", false));
    if (type == "rigid_force" || type == "rigid_moment")
      return read_component(e, name, type == "rigid_moment");
    if (type == "rigid_follower_force" || type == "rigid_follower_moment")
      return read_follower(e, name, type == "rigid_follower_moment");
    if (type == "rigid_axial_force") return read_axial(e, name);
    if (type == "rigid_cable") return read_cable(e, name);
    if (!type.empty()) unknown(e, type);
  }

  void not_in_step(const Element& e) {
    file_.refuse(e, format("<{}> of one step of several is not read", e.Name()),
                 "Put it outside the steps, or in the first one.");
  }

 private:
  /// Freedoms of a body in the step that is read, or in all.
  std::array<FebFreedom, 6>& freedoms(FebBody& body) {
    return model_.step == nullptr ? body.freedoms : body.in_step[model_.step_number()];
  }

  void unknown(const Element& e, const std::string& type) {
    file_.refuse(e, format("<{}> of type {} is not read", e.Name(), quote(type)),
                 "Leave it out, and add to the model what it means.");
  }

  /// Freedom of a tag: 0 to 5; -1 after an error.
  int dof(const Element& e, bool turn) {
    const std::string name = file_.text(e, "dof");
    const int k = freedom_of(name);
    if (k >= 0 && (k >= 3) == turn) return k;
    file_.xml.fault(e, format("<dof> of <{}> is {}", e.Name(), quote(name)),
                    turn ? "Write Ru, Rv or Rw." : "Write Rx, Ry or Rz.");
    return -1;
  }

  void prescribe(const Element& e, FebBody& body, int k, const FebValue& value, bool relative) {
    FebFreedom& freedom = freedoms(body)[static_cast<std::size_t>(k)];
    if (freedom.kind == Freedom::prescribed)
      file_.xml.fault(e, format("a freedom of {} is prescribed twice", quote(body.material)),
                      "Keep one of them.");
    // FEBio lets what is prescribed override what is fixed.
    freedom = {Freedom::prescribed, value, &e, relative, {}};
  }

  /// A ramp over the analysis, or the step, up to a value, as an expression.
  SourceNode ramp(const Element& e, double value) const {
    const NodeBuilder make = file_.make(e);
    SourceNode table = make.map(), points = make.list();
    const double begin = model_.step == nullptr ? 0.0 : model_.step->begin;
    const double end = model_.step == nullptr ? model_.duration : model_.step->end;
    points.children.push_back(make.list({make.number(begin), make.number(0.0)}));
    points.children.push_back(make.list({make.number(end), make.number(value)}));
    make.put(table, "table", std::move(points));
    return table;
  }

  void read_component(const Element& e, const std::string& name, bool turn) {
    const FebBody* body = model_.body(e, "rb");
    const int k = dof(e, turn);
    const FebValue value = file_.value(e, "value");
    const std::string kind = lower_case(file_.text(e, "load_type"));
    const bool follows = kind == "1" || kind == "follow" || kind == "follower";
    const bool target = kind == "2" || kind == "target";
    if (!kind.empty() && kind != "0" && kind != "load" && kind != "direct" && !follows && !target)
      file_.xml.fault(e, format("<load_type> is {}", quote(kind)), "Write 0, 1 or 2.");
    if (body == nullptr || k < 0) return;
    const NodeBuilder make = file_.make(e);
    SourceNode load = make.map(), components = make.list();
    for (int j = 0; j < 3; ++j)
      components.children.push_back(k % 3 != j ? make.number(0.0)
                                    : target   ? ramp(e, value.factor)
                                               : model_.curves.node(value));
    make.put(load, "type", make.text(turn ? "moment" : "force"));
    make.put(load, "body", make.text(body->name));
    make.put(load, turn ? "moment" : "force", std::move(components));
    if (follows) make.put(load, "body_fixed", make.boolean(true));
    put_load(e, name, *body, std::move(load));
  }

  void read_follower(const Element& e, const std::string& name, bool turn) {
    const FebBody* body = model_.body(e, "rb");
    const auto values = file_.vector_value(e, turn ? "moment" : "force");
    const Vec3 at = file_.vector(e, "insertion").value_or(Vec3::Zero());
    if (body == nullptr) return;
    const NodeBuilder make = file_.make(e);
    SourceNode load = make.map();
    make.put(load, "type", make.text(turn ? "moment" : "force"));
    make.put(load, "body", make.text(body->name));
    if (!turn) {
      const bool relative = file_.boolean(e, "relative", false);
      make.put(load, "at", make.vector(relative ? Vec3(body->com + at) : at));
    }
    make.put(load, turn ? "moment" : "force", model_.vector(e, values));
    make.put(load, "body_fixed", make.boolean(true));
    put_load(e, name, *body, std::move(load));
  }

  void put_load(const Element& e, const std::string& name, const FebBody& body, SourceNode load) {
    if (body.is_fixed())
      file_.ignored.add(e, format("<{}> on a fixed body", e.Name()), "moves nothing");
    else
      model_.add_load(e, name, std::move(load));
  }

  void read_axial(const Element& e, const std::string& name) {
    const FebBody *a = model_.body(e, "rbA"), *b = model_.body(e, "rbB");
    const Vec3 ra = file_.vector(e, "ra").value_or(Vec3::Zero());
    const Vec3 rb = file_.vector(e, "rb").value_or(Vec3::Zero());
    const bool relative = file_.boolean(e, "relative", false);
    const FebValue force = file_.value(e, "force");
    if (a == nullptr || b == nullptr) return;
    const NodeBuilder make = file_.make(e);
    SourceNode load = make.map();
    make.put(load, "type", make.text("axial_force"));
    make.put(load, "bodies", make.list({make.text(a->name), make.text(b->name)}));
    make.put(load, "at",
             make.list({make.vector(relative ? Vec3(a->com + ra) : ra),
                        make.vector(relative ? Vec3(b->com + rb) : rb)}));
    make.put(load, "pull", model_.curves.node(force));
    model_.add_load(e, name, std::move(load));
  }

  /// A cable of one tension through points of bodies, which a force of that size pulls at the last.
  void read_cable(const Element& e, const std::string& name) {
    struct Point {
      const FebBody* body;
      Vec3 at;
    };
    const FebValue force = file_.value(e, "force");
    const Vec3 along = file_.direction(e, "force_direction", -Vec3::UnitZ());
    const bool relative = file_.boolean(e, "relative", true);
    std::vector<Point> points;
    for (const char* tag : {"rigid_cable_point", "point"})
      for (const Element* p : file_.xml.children(e, tag)) {
        const FebBody* body = model_.body(*p, "rigid_body_id");
        const Vec3 at = file_.vector(*p, "position").value_or(Vec3::Zero());
        if (body == nullptr) return;
        points.push_back({body, relative ? Vec3(body->com + at) : at});
      }
    if (points.empty()) {
      file_.xml.fault(e, "the rigid_cable has no points", "Give <rigid_cable_point>.");
      return;
    }
    const NodeBuilder make = file_.make(e);
    SourceNode end = make.map();
    make.put(end, "type", make.text("force"));
    make.put(end, "body", make.text(points.back().body->name));
    make.put(end, "at", make.vector(points.back().at));
    SourceNode components = make.list();
    for (int k = 0; k < 3; ++k) components.children.push_back(model_.curves.node(force, along[k]));
    make.put(end, "force", std::move(components));
    put_load(e, name + "_end", *points.back().body, std::move(end));
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Point &a = points[k], &b = points[k + 1];
      if (a.body == b.body || (a.body->is_fixed() && b.body->is_fixed())) continue;
      SourceNode span = make.map();
      make.put(span, "type", make.text("axial_force"));
      make.put(span, "bodies", make.list({make.text(a.body->name), make.text(b.body->name)}));
      make.put(span, "at", make.list({make.vector(a.at), make.vector(b.at)}));
      make.put(span, "pull", model_.curves.node(force));
      model_.add_load(e, format("{}_{}", name, k + 1), std::move(span));
    }
    if (std::any_of(points.begin(), points.end(),
                    [](const Point& p) { return !p.body->is_fixed(); }))
      file_.approximated(e,
                         "the forces of the cable act at points that turn with their bodies, where "
                         "FEBio's moments have the arms of the start");
  }

  FebModel& model_;
  FebFile& file_;
};

}  // namespace

void read_feb_rigid(FebModel& model, const Element& section) {
  RigidReader reader(model);
  const bool later = model.step != nullptr && model.step != &model.steps.front();
  for (const Element* e : model.file.xml.children(section, "rigid_bc")) reader.read_constraint(*e);
  for (const Element* e : model.file.xml.children(section, "rigid_ic"))
    later ? reader.not_in_step(*e) : reader.read_start(*e);
  for (const Element* e : model.file.xml.children(section, "rigid_load")) reader.read_load(*e);
  for (const Element* e : model.file.xml.children(section, "rigid_connector"))
    read_feb_connector(model, *e);
  for (const char* tag : {"rigid_bc", "rigid_ic"})
    for (const Element* e : model.file.xml.children(section, tag))
      model.file.ignored.attributes(*e, {"name"});
}

}  // namespace polhode::io
