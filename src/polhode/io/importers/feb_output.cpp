// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Probes that one request may become.
constexpr std::size_t kMostProbes = 200;

/// Whether a request has a variable whose name begins so.
bool asks_for(const std::string& data, const std::vector<std::string>& names) {
  std::size_t at = 0;
  while (at <= data.size()) {
    const std::size_t end = std::min(data.find(';', at), data.size());
    std::string name = data.substr(at, end - at);
    std::erase(name, ' ');
    for (const std::string& wanted : names)
      if (name == wanted) return true;
    at = end + 1;
  }
  return false;
}

/// Reader of requests for data of the log file.
class LogReader {
 public:
  LogReader(FebModel& model, SourceNode& probes)
      : model_(model), file_(model.file), probes_(probes) {}

  void read(const Element& logfile) {
    for (const Element* e : file_.children(logfile)) {
      const std::string kind = e->Name();
      const std::string data = file_.xml.text(*e, "data").value_or("");
      file_.ignored.attributes(*e, {"name", "file", "delim", "format"});
      if (kind == "rigid_body_data")
        read_bodies(*e, data);
      else if (kind == "rigid_connector_data")
        read_connectors(*e);
      else if (kind == "node_data")
        read_nodes(*e);
      else {
        file_.xml.skip(*e);
        if (kind == "element_data") {
          model_.frames = true;
          file_.approximated(*e, "<element_data> of the log file is in the frames of results.h5");
        } else {
          file_.ignored.add(*e, format("<{}> of the log file", kind),
                            "is not recorded: results.h5 has stresses, strains and contacts");
        }
      }
    }
  }

 private:
  void add(const Element& e, const std::string& name, SourceNode probe) {
    file_.make(e).put(probes_, file_.name(e, allowed_name(name), names_), std::move(probe));
    if (!said_)
      file_.approximated(e,
                         "requests for the log file become probes, which are tables as .csv files");
    said_ = true;
  }

  void read_bodies(const Element& e, const std::string& data) {
    const std::vector<std::int64_t> ids = file_.integers(e);
    for (const FebBody& body : model_.bodies) {
      if (!ids.empty() && std::find(ids.begin(), ids.end(), body.id) == ids.end()) continue;
      const NodeBuilder make = file_.make(e);
      SourceNode probe = make.map();
      make.put(probe, "body", make.text(body.name));
      if (asks_for(data, {"qx", "qy", "qz", "qw"}))
        make.put(probe, "rotation", make.text("quaternion"));
      else if (asks_for(data, {"thx", "thy", "thz"}))
        make.put(probe, "rotation", make.text("vector"));
      else if (asks_for(data, {"EulerX", "EulerY", "EulerZ"}))
        make.put(probe, "rotation", make.text("XYZ"));
      if (asks_for(data, {"omx", "omy", "omz", "alx", "aly", "alz"}))
        make.put(probe, "angular", make.boolean(true));
      add(e, body.name, std::move(probe));
      if (!asks_for(data, {"Fx", "Fy", "Fz", "Mx", "My", "Mz"})) continue;
      model_.frames = true;
      if (!model_.solids.is_bonded_to(body.name))
        file_.ignored.add(
            e, "the force on a rigid body",
            "is that of its joints, such as <body>.hold and <body>.motion, in results.h5");
    }
  }

  void read_connectors(const Element& e) {
    model_.frames = true;
    const std::vector<std::int64_t> ids = file_.integers(e);
    for (std::size_t k = 0; k < model_.connectors.size(); ++k) {
      const auto& [kind, name] = model_.connectors[k];
      if (name.empty()) continue;
      if (!ids.empty() &&
          std::find(ids.begin(), ids.end(), static_cast<std::int64_t>(k + 1)) == ids.end())
        continue;
      const NodeBuilder make = file_.make(e);
      SourceNode probe = make.map();
      make.put(probe, kind, make.text(name));
      add(e, name, std::move(probe));
    }
  }

  void read_nodes(const Element& e) {
    std::vector<int> nodes;
    if (e.Attribute("node_set") != nullptr) {
      const std::vector<int>* set = model_.solids.named_nodes(e);
      if (set != nullptr) nodes = *set;
    } else {
      for (const std::int64_t id : file_.integers(e)) {
        const auto found = model_.mesh.place.find(id);
        if (found != model_.mesh.place.end())
          nodes.push_back(found->second);
        else
          file_.xml.fault(e, format("there is no node {}", id), "Give it in <Nodes>.");
      }
    }
    if (nodes.empty() || nodes.size() > kMostProbes) {
      file_.xml.skip(e);
      file_.ignored.add(e,
                        format("<node_data> of {} nodes",
                               nodes.empty() ? std::string("all") : format("{}", nodes.size())),
                        "is not recorded by probes: results.h5 has all nodes");
      return;
    }
    for (const int n : nodes) {
      const NodeBuilder make = file_.make(e);
      SourceNode probe = make.map();
      if (!model_.solids.put_node(n, make, probe)) continue;
      add(e, format("node_{}", model_.mesh.labels[static_cast<std::size_t>(n)]), std::move(probe));
    }
  }

  FebModel& model_;
  FebFile& file_;
  SourceNode& probes_;
  std::set<std::string> names_;
  bool said_ = false;
};

}  // namespace

bool FebSolids::is_bonded_to(const std::string& body) const {
  return std::any_of(attached_.begin(), attached_.end(), [&](const auto& node) {
    return node.second == body && std::any_of(solids_.begin(), solids_.end(), [&](const auto& s) {
             return s.place.contains(node.first);
           });
  });
}

bool FebSolids::put_node(int node, const NodeBuilder& make, SourceNode& probe) const {
  for (const FebSolid& solid : solids_) {
    const auto found = solid.place.find(node);
    if (found == solid.place.end()) continue;
    make.put(probe, "solid", make.text(solid.name));
    make.put(probe, "node", make.text(format("{}", found->second)));
    return true;
  }
  const auto body = attached_.find(node);
  if (body == attached_.end()) return false;
  if (body->second.find('.') != std::string::npos) {  // A node of a beam.
    make.put(probe, "body", make.text(body->second));
    return true;
  }
  for (const FebBody& b : model_.bodies) {
    if (b.name != body->second) continue;
    make.put(probe, "body", make.text(b.name));
    make.put(probe, "point",
             make.vector(model_.mesh.nodes[static_cast<std::size_t>(node)] - b.com));
  }
  return true;
}

void read_feb_output(FebModel& model, const Element& section, SourceNode& probes) {
  LogReader reader(model, probes);
  for (const Element* e : model.file.xml.children(section, "logfile")) {
    model.file.ignored.attributes(*e, {"file"});
    reader.read(*e);
  }
  model.file.ignored.skip(section, {"plotfile"});
}

}  // namespace polhode::io
