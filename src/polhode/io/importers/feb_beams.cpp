// SPDX-License-Identifier: Apache-2.0
// Linear beams of an FEBio file: chains of its elements become beams.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Lines of a part by the nodes at their ends.
using Lines = std::map<int, std::vector<int>>;

/// Takes a chain of lines from a node on, up to one at which it may not go on.
/// @param ends  Nodes at which chains end.
std::vector<int> take_chain(Lines& lines, const std::set<int>& ends, int from) {
  std::vector<int> chain{from};
  do {
    std::vector<int>& next = lines[chain.back()];
    if (next.empty()) break;
    const int to = next.back();
    next.pop_back();
    std::vector<int>& back = lines[to];
    back.erase(std::find(back.begin(), back.end(), chain.back()));
    chain.push_back(to);
  } while (!ends.contains(chain.back()));
  return chain;
}

}  // namespace

void FebSolids::read_beam_material(const Element& e, const std::string& name) {
  FebFile& file = model_.file;
  std::map<std::string, double> given;
  for (const char* key : {"E", "G", "A", "A1", "A2", "I1", "I2"}) {
    const auto value = file.number(e, key);
    given[key] = value.value_or(1.0);
    if (!value || !(*value > 0.0))
      file.xml.fault(e, format("the linear beam {} has no <{}> above zero", quote(name), key),
                     "Give E, G, A, A1, A2, I1 and I2.");
  }
  const double density = file.number(e, "density").value_or(1.0);
  const double J = file.number(e, "J").value_or(given["I1"] + given["I2"]);
  if (given["I1"] != given["I2"] || given["A1"] != given["A2"])
    file.refuse(e, format("the section of {} differs in its two directions", quote(name)),
                "Its axes are not in the file: give I1 = I2 and A1 = A2, or add the beam to the "
                "model with its direction up.");
  if (!(density > 0.0 && J > 0.0))
    file.xml.fault(e, format("the linear beam {} has no density or torsion constant", quote(name)),
                   "Give values above zero.");
  const NodeBuilder make = file.make(e);
  const double E = given["E"], G = given["G"], I = given["I1"];
  SourceNode section = make.map();
  make.put(section, "type", make.text("general"));
  make.put(section, "EA", make.number(E * given["A"]));
  make.put(section, "GA_y", make.number(G * given["A1"]));
  make.put(section, "GA_z", make.number(G * given["A2"]));
  make.put(section, "GJ", make.number(G * J));
  make.put(section, "EI_y", make.number(E * I));
  make.put(section, "EI_z", make.number(E * I));
  make.put(section, "mass_per_length", make.number(density * given["A"]));
  make.put(section, "inertia_per_length", make.vector(density * Vec3(2.0 * I, I, I)));
  if (sections_.kind != SourceNode::Kind::kMap) sections_ = make.map();
  const std::string chosen = file.name(e, name, section_names_);
  make.put(sections_, chosen, std::move(section));
  beam_sections_[name] = chosen;
}

void FebSolids::add_beams() {
  for (const FebPart& part : model_.mesh.parts) {
    const auto section = beam_sections_.find(part.material);
    if (section == beam_sections_.end()) continue;
    if (part.size != 2) {
      model_.file.refuse(*part.at, format("{} elements are no linear beams", part.type),
                         "Use line2 elements.");
      continue;
    }
    Lines lines;
    for (std::size_t k = 0; k + 1 < part.nodes.size(); k += 2) {
      lines[part.nodes[k]].push_back(part.nodes[k + 1]);
      lines[part.nodes[k + 1]].push_back(part.nodes[k]);
    }
    std::set<int> ends;
    for (const auto& [node, others] : lines)
      if (others.size() != 2 || attached_.contains(node) || held_.contains(node) ||
          clamped_.contains(node) || on_solid(node))
        ends.insert(node);
    if (ends.empty() && !lines.empty()) ends.insert(lines.begin()->first);  // A ring.
    for (const int end : ends)
      while (!lines[end].empty()) add_beam(part, section->second, take_chain(lines, ends, end));
  }
}

bool FebSolids::on_solid(int node) const {
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const FebSolid& solid) { return solid.place.contains(node); });
}

void FebSolids::add_beam(const FebPart& part, const std::string& section,
                         const std::vector<int>& chain) {
  const NodeBuilder make = model_.file.make(*part.at);
  const std::string name = model_.file.name(*part.at, part.name, solid_names_);
  SourceNode beam = make.map(), points = make.list();
  for (const int n : chain)
    points.children.push_back(make.vector(model_.mesh.nodes[static_cast<std::size_t>(n)]));
  make.put(beam, "points", std::move(points));
  make.put(beam, "elements", make.number(static_cast<double>(chain.size() - 1)));
  make.put(beam, "section", make.text(section));
  make.put(beam, "residual_bending_flexibility", make.boolean(false));
  if (beams_.kind != SourceNode::Kind::kMap) beams_ = make.map();
  make.put(beams_, name, std::move(beam));
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const std::string node = k == 0                  ? name + ".start"
                             : k + 1 == chain.size() ? name + ".end"
                                                     : format("{}.{}", name, k);
    hold_beam_node(part, chain[k], node);
  }
}

void FebSolids::hold_beam_node(const FebPart& part, int n, const std::string& name) {
  const Vec3& place = model_.mesh.nodes[static_cast<std::size_t>(n)];
  const auto connect = [&](const char* type, const std::string& to) {
    const NodeBuilder make = model_.file.make(*part.at);
    SourceNode joint = make.map();
    make.put(joint, "type", make.text(type));
    make.put(joint, "bodies", make.list({make.text(to), make.text(name)}));
    make.put(joint, "at", make.vector(place));
    std::string label = name + "_to_" + to;
    std::replace(label.begin(), label.end(), '.', '_');
    model_.add_joint(*part.at, label, std::move(joint));
  };
  if (const auto [at, is_new] = attached_.try_emplace(n, name); !is_new)
    return connect("fixed", at->second);
  const auto held = held_.find(n);
  const bool clamped = clamped_.contains(n);
  if (held == held_.end() && !clamped) return;
  const bool fixed =
      held != held_.end() && std::all_of(held->second.begin(), held->second.end(), [&](int h) {
        return h >= 0 && !holds_[static_cast<std::size_t>(h)].prescribed;
      });
  if (fixed) return connect(clamped ? "fixed" : "spherical", "ground");
  model_.file.refuse(*part.at,
                     format("the node {} of a beam is held in some directions, or prescribed",
                            model_.mesh.labels[static_cast<std::size_t>(n)]),
                     "Fix all three displacements of it, or attach it to a rigid body.");
}

}  // namespace polhode::io
