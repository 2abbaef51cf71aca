// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_contacts.hpp>

#include <algorithm>

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
      if (!bodies_.frames().contains(exclusion.links[k]))
        return file_.xml.fault(e, format("there is no body {}", quote(exclusion.links[k])),
                               "Name a body.");
    }
    robot_.contacts.exclusions.push_back(exclusion);
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
      const auto geom = bodies_.touching().find(geoms[k]);
      if (geom == bodies_.touching().end())
        return file_.xml.fault(tag.e, format("there is no geom {}", quote(geoms[k])),
                               "Name a geom.");
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

 private:
  MjcfFile& file_;
  const MjcfBodies& bodies_;
  Robot& robot_;
};

}  // namespace

void read_contacts(MjcfFile& file, const MjcfBodies& bodies, const ImportOptions& options,
                   Robot& robot) {
  robot.contacts.wanted = options.contacts;
  MjcfContactReader reader(file, bodies, robot);
  for (const XmlFile::Element* section : file.sections("contact")) {
    for (const XmlFile::Element* e : file.xml.children(*section, "exclude")) {
      if (options.contacts) reader.read_exclusion(*e);
      file.xml.skip(*e);
    }
    for (const XmlFile::Element* e : file.xml.children(*section, "pair")) {
      if (options.contacts) reader.read_pair({file, *e, {"pair"}, ""});
      file.xml.skip(*e);
    }
    if (!options.contacts)
      file.ignored.add(*section, "<contact>", "acts where the model has 'contacts'");
  }
  if (options.contacts)
    file.ignored.add(file.xml.root(), "friction of geoms",
                     "is that of 'contacts' in the model, except in pairs");
}

}  // namespace polhode::io
