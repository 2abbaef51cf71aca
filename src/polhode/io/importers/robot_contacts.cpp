// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_contacts.hpp>

#include <algorithm>
#include <set>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

bool bits_meet(const std::pair<int, int>& a, const std::pair<int, int>& b) {
  return (a.first & b.second) != 0 || (b.first & a.second) != 0;
}

std::string group_of(const std::pair<int, int>& bits) {
  return format("contact_{}_{}", bits.first, bits.second);
}

std::string material_of(double friction) { return allowed_name(format("friction_{}", friction)); }

std::string group_of_pair(int pair) { return format("pair_{}", pair + 1); }

}  // namespace

ContactWriter::ContactWriter(const Robot& robot, const RobotTree& tree,
                             const std::vector<std::string>& link_names, XmlFile& xml,
                             std::vector<ImportNote>& notes)
    : robot_(robot), tree_(tree), link_names_(link_names), xml_(xml), notes_(notes) {
  std::set<std::pair<int, int>> kinds;
  for (const RobotLink& link : robot.links)
    for (const auto* shapes : {&link.visual, &link.collision})
      for (const RobotShape& shape : *shapes) {
        kinds.insert(shape.contact_bits);
        by_groups_ = by_groups_ || !shape.contact_pairs.empty();
        if (shape.contact_bits != std::pair(0, 0)) frictions_.insert(shape.friction);
      }
  kinds_.assign(kinds.begin(), kinds.end());
  for (const auto& a : kinds_)
    for (const auto& b : kinds_) by_groups_ = by_groups_ || !bits_meet(a, b);
}

void ContactWriter::put_shape(const RobotShape& shape, const NodeBuilder& make,
                              SourceNode& node) const {
  if (!robot_.contacts.wanted) return;
  SourceNode contact = make.map();
  if (by_groups_) put_groups(shape, make, contact);
  if (robot_.contacts.friction && frictions_.size() > 1 && contact.find("touches") == nullptr)
    make.put(contact, "material", make.text(material_of(shape.friction)));
  if (!contact.keys.empty()) make.put(node, "contact", std::move(contact));
}

void ContactWriter::put_groups(const RobotShape& shape, const NodeBuilder& make,
                               SourceNode& contact) const {
  std::vector<SourceNode> groups, meets;
  for (const auto& other : kinds_)
    if (bits_meet(shape.contact_bits, other)) meets.push_back(make.text(group_of(other)));
  if (meets.empty() && shape.contact_pairs.empty()) {
    make.put(contact, "touches", make.boolean(false));
  } else {
    if (!meets.empty()) groups.push_back(make.text(group_of(shape.contact_bits)));
    for (const int pair : shape.contact_pairs) {
      groups.push_back(make.text(group_of_pair(pair)));
      meets.push_back(make.text(group_of_pair(pair)));
    }
    make.put(contact, "groups", make.list(std::move(groups)));
    make.put(contact, "meets", make.list(std::move(meets)));
  }
}

std::string ContactWriter::body_with_shape(const std::string& link, const XmlFile::Element& at,
                                           const SourceNode& bodies, const std::string& what) {
  const auto own = static_cast<std::size_t>(tree_.link_index.at(link));
  const std::string& name = link_names_[static_cast<std::size_t>(tree_.body[own])];
  const SourceNode* body = bodies.find(name);
  if (body != nullptr && body->find("shape") != nullptr) return name;
  if (what.empty()) return "";
  notes_.push_back({ImportNote::Kind::ignored, xml_.place(at),
                    format("{} is of {}, which has no shape", what, quote(link))});
  return "";
}

bool ContactWriter::are_fixed(const std::string (&links)[2]) const {
  return std::all_of(std::begin(links), std::end(links), [&](const std::string& link) {
    return tree_.grounded[static_cast<std::size_t>(tree_.link_index.at(link))];
  });
}

SourceNode ContactWriter::section(const SourceNode& bodies) {
  const NodeBuilder make{xml_.line(xml_.root())};
  SourceNode contacts = make.map(), pairs = make.map(), excluded = make.list();
  const auto names_of = [&](const std::string(&links)[2], const XmlFile::Element& at,
                            const std::string& what) {
    std::vector<std::string> names;
    if (are_fixed(links)) return names;
    for (const std::string& link : links) {
      names.push_back(body_with_shape(link, at, bodies, what));
      if (names.back().empty()) break;
    }
    names.resize(2);
    if (names[0].empty() || names[1].empty() || names[0] == names[1]) names.clear();
    return names;
  };
  std::set<std::pair<std::string, std::string>> listed;
  for (const RobotExclusion& e : robot_.contacts.exclusions) {
    const auto names = names_of(e.links, *e.at, e.by_tree ? "" : "an excluded contact");
    const NodeBuilder here{xml_.line(*e.at)};
    if (!names.empty() && listed.insert(std::minmax(names[0], names[1])).second)
      excluded.children.push_back(here.list({here.text(names[0]), here.text(names[1])}));
  }
  std::set<std::pair<std::string, std::string>> seen;
  for (const RobotContactPair& pair : robot_.contacts.pairs) {
    const auto names = names_of(pair.links, *pair.at, format("the pair {}", quote(pair.name)));
    if (names.empty()) continue;
    if (!seen.insert(std::minmax(names[0], names[1])).second) {
      notes_.push_back({ImportNote::Kind::ignored, xml_.place(*pair.at),
                        format("the friction of the pair {} is that of an earlier pair of these "
                               "bodies",
                               quote(pair.name))});
      continue;
    }
    const NodeBuilder here{xml_.line(*pair.at)};
    SourceNode law = here.map();
    here.put(law, "between", here.list({here.text(names[0]), here.text(names[1])}));
    here.put(law, "friction", here.number(pair.friction));
    if (pair.torsion > 0.0) here.put(law, "torsional_friction", here.number(pair.torsion));
    if (pair.rolling > 0.0) here.put(law, "rolling_friction", here.number(pair.rolling));
    std::string name = allowed_name(pair.name);
    while (pairs.find(name) != nullptr) name += "_2";
    make.put(pairs, name, std::move(law));
  }
  if (robot_.contacts.friction && frictions_.size() == 1) {
    SourceNode standard = make.map();
    make.put(standard, "friction", make.number(*frictions_.begin()));
    make.put(contacts, "default", std::move(standard));
  } else if (robot_.contacts.friction && !frictions_.empty()) {
    SourceNode materials = make.map(), combine = make.map();
    for (const double friction : frictions_) {
      SourceNode material = make.map();
      make.put(material, "friction", make.number(friction));
      make.put(materials, material_of(friction), std::move(material));
    }
    make.put(contacts, "materials", std::move(materials));
    make.put(combine, "friction", make.text("maximum"));
    make.put(contacts, "combine", std::move(combine));
  }
  if (!excluded.children.empty()) make.put(contacts, "exclude", std::move(excluded));
  if (!pairs.keys.empty()) make.put(contacts, "pairs", std::move(pairs));
  return contacts;
}

void note_idle_shapes(const Robot& robot, const RobotTree& tree, const XmlFile& xml,
                      std::vector<ImportNote>& notes) {
  if (robot.contacts.wanted || robot.contacts.off) return;
  std::size_t shapes = 0;
  std::set<int> bodies;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    shapes += robot.links[i].collision.size();
    if (!robot.links[i].collision.empty()) bodies.insert(tree.body[i]);
  }
  if (bodies.size() < 2) return;
  notes.push_back({ImportNote::Kind::approximated, xml.place(xml.root()),
                   format("{} shapes of {} bodies touch nothing: write a model file with import: "
                          "{{file: ..., shapes: collision}} and contacts: {{}} for them to touch",
                          shapes, bodies.size())});
}

}  // namespace polhode::io
