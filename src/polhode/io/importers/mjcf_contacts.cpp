// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_contacts.hpp>

#include <algorithm>
#include <map>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

class MjcfContactReader {
 public:
  MjcfContactReader(MjcfFile& file, const MjcfBodies& bodies, Robot& robot)
      : file_(file), bodies_(bodies), robot_(robot) {}

  void read_exclusion(const XmlFile::Element& e) {
    RobotExclusion exclusion;
    exclusion.at = &e;
    for (int k = 0; k < 2; ++k) {
      exclusion.links[k] = file_.xml.required_text(e, k == 0 ? "body1" : "body2");
      if (exclusion.links[k].empty()) return;
      if (!has_body(e, exclusion.links[k])) return;
    }
    robot_.contacts.exclusions.push_back(exclusion);
  }

  /// Errors about names of bodies and geoms, where contacts are not read.
  void check(const XmlFile::Element& e) {
    for (const char* body : {"body1", "body2"})
      if (const auto name = file_.xml.text(e, body)) has_body(e, *name);
    for (const char* geom : {"geom1", "geom2"})
      if (const auto name = file_.xml.text(e, geom)) has_geom(e, *name);
  }

  void read_pair(const MjcfTag& tag) {
    RobotContactPair pair;
    pair.at = &tag.e;
    double friction[3] = {0.0, 0.0, 0.0};
    double dimensions = 1.0;
    std::string geoms[2];
    for (int k = 0; k < 2; ++k) {
      geoms[k] = file_.xml.required_text(tag.e, k == 0 ? "geom1" : "geom2");
      if (geoms[k].empty()) return;
      if (!has_geom(tag.e, geoms[k])) return;
      const auto geom = bodies_.touching().find(geoms[k]);
      pair.links[k] = geom->second.link;
      for (int i = 0; i < 3; ++i)
        friction[i] = std::max(friction[i], geom->second.friction[static_cast<std::size_t>(i)]);
      dimensions = std::max(dimensions, geom->second.dimensions);
    }
    pair.name = tag.text("name", geoms[0] + "_" + geoms[1]);
    if (const std::vector<double> given = tag.numbers("friction", 1, 5); !given.empty()) {
      const auto entry = [&](std::size_t k, double standard) {
        return k < given.size() ? given[k] : standard;
      };
      friction[0] = given[0];
      friction[1] = entry(2, 0.005);
      friction[2] = entry(3, 0.0001);
      if (entry(1, given[0]) != given[0] || entry(4, friction[2]) != friction[2])
        file_.ignored.add(tag.e, "friction of a pair that differs by direction",
                          "is that of the first direction");
    }
    dimensions = tag.number("condim", dimensions);
    pair.friction = dimensions >= 3.0 ? friction[0] : 0.0;
    pair.torsion = dimensions >= 4.0 ? friction[1] : 0.0;
    pair.rolling = dimensions >= 6.0 ? friction[2] : 0.0;
    const int number = static_cast<int>(robot_.contacts.pairs.size());
    std::size_t others = 0;
    for (RobotLink& link : robot_.links)
      for (auto* shapes : {&link.visual, &link.collision})
        for (RobotShape& shape : *shapes) {
          if (!shape.name.empty() && (shape.name == geoms[0] || shape.name == geoms[1]))
            shape.contact_pairs.push_back(number);
          else if (shapes == &link.collision &&
                   (link.name == pair.links[0] || link.name == pair.links[1]))
            ++others;
        }
    if (others > 0)
      file_.notes.push_back({ImportNote::Kind::approximated, file_.xml.place(tag.e),
                             format("the friction of the pair {} is that of all shapes of its "
                                    "bodies",
                                    quote(pair.name))});
    robot_.contacts.pairs.push_back(std::move(pair));
  }

  /// Bodies welded to each other, and those welded to a body and to its parent, do not touch,
  /// except in pairs; joints between two bodies are known to the model.
  void exclude_relatives() {
    const auto& links = robot_.links;
    for (const RobotJoint& joint : robot_.joints) above_[joint.child] = &joint;
    for (const RobotLink& link : links) known_[link.name] = link.name_in_file;
    for (std::size_t i = 1; i < links.size(); ++i)
      for (std::size_t j = 1; j < i; ++j) {
        const RobotLink &a = links[i], &b = links[j];
        if (!has_shape(a) || !has_shape(b)) continue;
        const std::string one = weld(a.name), other = weld(b.name);
        const bool related = one == other || (parent(one) == other && other != links[0].name) ||
                             (parent(other) == one && one != links[0].name);
        if (related && !is_joined(a.name, b.name) && !is_pair(a.name, b.name))
          robot_.contacts.exclusions.push_back({a.at, {b.name, a.name}, true});
      }
  }

 private:
  /// Whether there is a body of a name; otherwise an error.
  bool has_body(const XmlFile::Element& e, const std::string& name) {
    if (bodies_.frames().contains(name)) return true;
    file_.xml.fault(e, format("there is no body {}", quote(name)), nearest(name, bodies_.frames()));
    return false;
  }
  bool has_geom(const XmlFile::Element& e, const std::string& name) {
    if (bodies_.touching().contains(name)) return true;
    file_.xml.fault(e, format("there is no geom {}", quote(name)),
                    nearest(name, bodies_.touching()));
    return false;
  }
  template <class Map>
  static std::string nearest(const std::string& name, const Map& known) {
    std::vector<std::string> names;
    for (const auto& entry : known) names.push_back(entry.first);
    return did_you_mean(name, names) + "There are: " + name_list(names, 12) + ".";
  }
  static bool has_shape(const RobotLink& link) {
    return !link.visual.empty() || !link.collision.empty();
  }
  /// The first of the links to which one is welded.
  [[nodiscard]] std::string weld(std::string link) const {
    for (auto at = above_.find(link); at != above_.end() && at->second->type == "fixed";
         at = above_.find(link))
      link = at->second->parent;
    return link;
  }
  /// That of the body above; "" above the world.
  [[nodiscard]] std::string parent(const std::string& link) const {
    auto at = above_.find(link);
    while (at != above_.end() && !known_.at(at->second->parent))
      at = above_.find(at->second->parent);
    return at == above_.end() ? "" : weld(at->second->parent);
  }
  [[nodiscard]] bool is_joined(const std::string& a, const std::string& b) const {
    const auto below = [&](const std::string& child, const std::string& upper) {
      const auto at = above_.find(child);
      return at != above_.end() && at->second->parent == upper;
    };
    return below(a, b) || below(b, a);
  }
  [[nodiscard]] bool is_pair(const std::string& a, const std::string& b) const {
    return std::any_of(robot_.contacts.pairs.begin(), robot_.contacts.pairs.end(),
                       [&](const RobotContactPair& pair) {
                         return (pair.links[0] == a && pair.links[1] == b) ||
                                (pair.links[0] == b && pair.links[1] == a);
                       });
  }

  MjcfFile& file_;
  const MjcfBodies& bodies_;
  std::map<std::string, const RobotJoint*> above_;  ///< By its child.
  std::map<std::string, bool> known_;               ///< Whether a link has a body in the file.
  Robot& robot_;
};

}  // namespace

void read_contacts(MjcfFile& file, const MjcfBodies& bodies, const ImportOptions& options,
                   Robot& robot) {
  robot.contacts.wanted = options.contacts;
  robot.contacts.off = !file.flags.contact;
  const auto say = [&](bool is, const char* what) {
    if (is && options.contacts)
      file.notes.push_back({ImportNote::Kind::approximated, file.xml.place(file.xml.root()), what});
  };
  say(!file.flags.contact, "<option> switches contacts off, and those of the model act");
  say(!file.flags.parents_do_not_touch,
      "bodies do not touch their parents, also where <option> lets them");
  MjcfContactReader reader(file, bodies, robot);
  for (const XmlFile::Element* section : file.sections("contact")) {
    for (const XmlFile::Element* e : file.xml.children(*section, "exclude")) {
      if (options.contacts)
        reader.read_exclusion(*e);
      else
        reader.check(*e);
      file.skip(*e);
    }
    for (const XmlFile::Element* e : file.xml.children(*section, "pair")) {
      if (options.contacts)
        reader.read_pair({file, *e, {"pair"}, ""});
      else
        reader.check(*e);
      file.skip(*e);
    }
    if (!options.contacts)
      file.ignored.add(*section, "<contact>", "acts where the model has 'contacts'");
  }
  if (options.contacts) reader.exclude_relatives();
  robot.contacts.friction = options.contacts && !options.contact_friction;
  if (options.contacts && options.contact_friction)
    file.ignored.add(file.xml.root(), "friction of geoms",
                     "is that of 'contacts' in the model, except in pairs");
}

}  // namespace polhode::io
