// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Lengths of a table by which it is continued beyond its ends.
constexpr double kBeyond = 1e3;

/// A law of springs between nodes.
struct SpringLaw {
  SourceNode load;  ///< Without bodies and points.
  bool sound = false;
};

/// Force over the elongation of a nonlinear spring; nothing after an error.
std::optional<SourceNode> force_table(FebFile& file, const Element& e) {
  const NodeBuilder make = file.make(e);
  const Element* force = file.child(e, "force");
  const std::string type = force == nullptr ? "" : file.type(*force);
  const std::string rule = force == nullptr ? "" : lower_case(file.text(*force, "interpolate"));
  const std::string extend = force == nullptr ? "" : lower_case(file.text(*force, "extend"));
  if (type != "point" || (!rule.empty() && rule != "linear" && rule != "0")) {
    file.refuse(e, "a nonlinear spring has no <force> of type \"point\" with straight lines",
                "Give points of elongation and force.");
    return std::nullopt;
  }
  std::vector<std::array<double, 2>> points;
  if (const Element* list = file.child(*force, "points"))
    for (const Element* p : file.children(*list))
      if (const auto two = file.numbers(*p, 2, 2)) points.push_back({(*two)[0], (*two)[1]});
  const bool rising =
      std::adjacent_find(points.begin(), points.end(),
                         [](const auto& a, const auto& b) { return a[0] >= b[0]; }) == points.end();
  if (points.size() < 2 || !rising) {
    file.xml.fault(e, "the force of a spring has no two points with increasing elongations",
                   "Give at least two.");
    return std::nullopt;
  }
  if (extend == "extrapolate" || extend == "1") {
    const double length = kBeyond * (points.back()[0] - points.front()[0]);
    const auto slope = [&](std::size_t k) {
      return (points[k + 1][1] - points[k][1]) / (points[k + 1][0] - points[k][0]);
    };
    const double first = slope(0), last = slope(points.size() - 2);
    points.insert(points.begin(), {points[0][0] - length, points[0][1] - first * length});
    points.push_back({points.back()[0] + length, points.back()[1] + last * length});
  } else if (!extend.empty() && extend != "constant" && extend != "0") {
    file.refuse(e, format("the <extend> {} of a spring is not read", quote(extend)),
                "Give points over the whole range.");
    return std::nullopt;
  }
  SourceNode table = make.map(), rows = make.list();
  for (const auto& p : points)
    rows.children.push_back(make.list({make.number(p[0]), make.number(p[1])}));
  make.put(table, "table", std::move(rows));
  return table;
}

SpringLaw read_law(FebFile& file, const Element& e) {
  const NodeBuilder make = file.make(e);
  SpringLaw law{make.map(), false};
  const std::string type = file.type(e);
  make.put(law.load, "type", make.text("spring_damper"));
  const std::string measure = lower_case(file.text(e, "measure"));
  const double scale = file.number(e, "scale").value_or(1.0);
  if (!measure.empty() && measure != "0" && measure != "elongation") {
    file.refuse(e, format("the measure {} of springs is not read", quote(measure)),
                "Use elongation.");
  } else if (type == "linear spring" || type == "tension-only linear spring") {
    const double E = scale * file.number(e, "E").value_or(0.0);
    if (E < 0.0) file.xml.fault(e, format("<E> is {}", E), "Give a value that is not negative.");
    make.put(law.load, "stiffness", make.number(std::max(0.0, E)));
    if (type == "tension-only linear spring") make.put(law.load, "acts", make.text("tension"));
    law.sound = true;
  } else if (type == "nonlinear spring") {
    if (scale != 1.0)
      file.refuse(e, "<scale> of a nonlinear spring is not read", "Scale its points.");
    if (auto table = force_table(file, e)) {
      make.put(law.load, "spring_force", std::move(*table));
      law.sound = true;
    }
  } else if (!type.empty()) {
    file.refuse(e, format("springs of type {} are not read", quote(type)),
                "Use a linear, tension-only linear or nonlinear spring.");
  }
  return law;
}

}  // namespace

std::string FebSolids::holder(int node) const {
  if (const auto body = attached_.find(node); body != attached_.end()) return body->second;
  for (const FebSolid& solid : solids_)
    if (solid.place.contains(node)) return solid.name;
  const auto held = held_.find(node);
  const bool still =
      held != held_.end() && std::all_of(held->second.begin(), held->second.end(), [&](int h) {
        return h >= 0 && !holds_[static_cast<std::size_t>(h)].prescribed;
      });
  return still ? "ground" : "";
}

bool FebSolids::is_solid(const std::string& name) const {
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const FebSolid& solid) { return solid.name == name; });
}

bool FebSolids::put_ends(const Element& e, const std::string& what, const std::array<int, 2>& ends,
                         SourceNode& load) {
  FebFile& file = model_.file;
  const NodeBuilder make = file.make(e);
  SourceNode names = make.list(), points = make.list();
  for (const int node : ends) {
    const std::string on = holder(node);
    if (on.empty()) {
      file.refuse(e, format("{} has an end that is on no rigid body and no solid", what),
                  "Attach the node to one of them, or fix it.");
      return false;
    }
    if (is_solid(on) && model_.step != nullptr) {
      file.refuse(e, format("{} has an end on a solid, and is in one step of several", what),
                  "Put it outside the steps, or end it on a rigid body.");
      return false;
    }
    names.children.push_back(make.text(on));
    points.children.push_back(make.vector(model_.mesh.nodes[static_cast<std::size_t>(node)]));
  }
  make.put(load, "bodies", std::move(names));
  make.put(load, "at", std::move(points));
  return true;
}

void FebSolids::add_trusses() {
  FebFile& file = model_.file;
  for (const FebPart& part : model_.mesh.parts) {
    const auto truss = trusses_.find(part.material);
    if (truss == trusses_.end()) continue;
    if (part.size != 2) {
      file.refuse(*part.at, format("{} elements are no linear trusses", part.type),
                  "Use line2 elements.");
      continue;
    }
    if (!(part.area > 0.0)) {
      file.xml.fault(*part.at, format("the trusses {} have no cross section", quote(part.name)),
                     "Give <cross_sectional_area> in their domain.");
      continue;
    }
    const NodeBuilder make = file.make(*part.at);
    for (std::size_t k = 0; k + 1 < part.nodes.size(); k += 2) {
      const std::array<int, 2> ends{part.nodes[k], part.nodes[k + 1]};
      const double length = (model_.mesh.nodes[static_cast<std::size_t>(ends[1])] -
                             model_.mesh.nodes[static_cast<std::size_t>(ends[0])])
                                .norm();
      if (!(length > 0.0)) {
        file.xml.fault(*part.at, format("a truss of {} has no length", quote(part.name)),
                       "Give two nodes apart.");
        break;
      }
      // The Kirchhoff stress is E ln(l/L): with the volume A L its energy is half of E A L ln².
      SourceNode load = make.map();
      make.put(load, "type", make.text("potential"));
      if (!put_ends(*part.at, format("a truss of {}", quote(part.name)), ends, load)) break;
      if (const std::string a = holder(ends[0]); a == holder(ends[1]) && !is_solid(a)) continue;
      const double stiffness = truss->second.modulus * part.area * length;
      make.put(load, "energy",
               make.text(format("{}*log(l/{})^2", make.number(0.5 * stiffness).text,
                                make.number(length).text)));
      model_.add_load(
          *part.at,
          part.nodes.size() == 2 ? part.name : format("{}_{}", part.name, part.ids[k / 2]),
          std::move(load));
    }
    if (model_.dynamic && truss->second.density > 0.0)
      file.approximated(*part.at,
                        format("the trusses {} have no mass in the model", quote(part.name)));
  }
}

void FebSolids::read_discrete(const Element& section) {
  FebFile& file = model_.file;
  std::map<std::string, SpringLaw> laws;
  for (const Element* e : file.xml.children(section, "discrete_material")) {
    const auto id = file.id(*e);
    const std::string name = file.xml.text(*e, "name").value_or("");
    SpringLaw law = read_law(file, *e);
    if (!id) continue;
    if (!name.empty()) laws.insert_or_assign(name, law);
    if (!laws.try_emplace(format("{}", *id), std::move(law)).second)
      file.xml.fault(*e, format("the law {} of springs stands twice", *id), "Renumber one.");
  }
  for (const Element* e : file.xml.children(section, "discrete")) {
    const std::string law_name = file.xml.required_text(*e, "dmat");
    const std::string set_name = file.xml.required_text(*e, "discrete_set");
    const auto law = laws.find(law_name);
    const auto set = model_.mesh.discrete_sets.find(set_name);
    if (law == laws.end() || set == model_.mesh.discrete_sets.end()) {
      file.xml.fault(*e,
                     law == laws.end()
                         ? format("there is no <discrete_material> {}", quote(law_name))
                         : format("there is no <DiscreteSet> {}", quote(set_name)),
                     "Give its name.");
      continue;
    }
    if (!law->second.sound) continue;
    for (std::size_t k = 0; k < set->second.size(); ++k) {
      const std::array<int, 2>& ends = set->second[k];
      if (const std::string a = holder(ends[0]);
          !a.empty() && a == holder(ends[1]) && !is_solid(a)) {
        file.ignored.add(*e, "a spring within one rigid body", "moves nothing");
        continue;
      }
      SourceNode load = law->second.load;
      if (!put_ends(*e, format("a spring of {}", quote(set_name)), ends, load)) break;
      model_.add_load(*e, set->second.size() == 1 ? set_name : format("{}_{}", set_name, k + 1),
                      std::move(load));
    }
  }
}

void FebSolids::read_initial(const Element& section) {
  FebFile& file = model_.file;
  for (const Element* e : file.xml.children(section, "ic")) {
    const std::string type = file.type(*e);
    file.ignored.attributes(*e, {"name"});
    if (type != "velocity" && type != "initial velocity") {
      static_cast<void>(file.xml.text(*e, "node_set"));
      if (!type.empty())
        file.refuse(*e, format("<ic> of type {} is not read", quote(type)), "Use velocity.");
      continue;
    }
    const std::vector<int>* nodes = named_nodes(*e);
    const auto velocity = file.vector(*e, "value");
    if (nodes == nullptr || !velocity) continue;
    const std::set<int> given(nodes->begin(), nodes->end());
    for (FebSolid& solid : solids_) {
      const auto in = std::count_if(solid.nodes.begin(), solid.nodes.end(),
                                    [&](int n) { return given.contains(n); });
      const auto other = std::count_if(solid.nodes.begin(), solid.nodes.end(), [&](int n) {
        return !given.contains(n) && !attached_.contains(n);
      });
      if (in > 0 && other > 0)
        file.refuse(*e, format("a part of {} alone has a velocity", quote(solid.name)),
                    "Give one for the whole solid.");
      else if (in > 0)
        solid.velocity = *velocity;
    }
  }
}

}  // namespace polhode::io
