// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/feb.hpp>

#include <algorithm>
#include <charconv>
#include <map>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Reader of a whole file.
class FebReader {
 public:
  explicit FebReader(FebModel& model) : model_(model), file_(model.file) {}

  SourceNode read() {
    const Element& root = file_.xml.root();
    const NodeBuilder make = file_.make(root);
    SourceNode result = make.map();
    if (!check_version(root)) return result;
    model_.joints = make.map();
    model_.loads = make.map();
    refuse_options();
    if (const Element* module = file_.child(root, "Module")) read_module(*module);
    if (!read_feb_steps(model_)) return result;
    model_.curves.until = model_.duration;
    model_.curves.dynamic = model_.dynamic;
    using In = FebIn;
    const auto each = [&](const char* name, In in, const auto& use) {
      model_.each_section(name, in, use);
    };
    each("LoadData", In::values, [&](const Element& e) { model_.curves.read(e); });
    model_.mesh = read_feb_mesh(file_, file_.child(root, "Mesh"), file_.child(root, "MeshDomains"));
    if (const Element* materials = file_.child(root, "Material"))
      read_feb_materials(model_, *materials);
    check_feb_domains(model_, file_.child(root, "Material"));
    model_.solids.assemble();
    each("MeshData", In::file, [&](const Element& e) { model_.solids.read_mesh_data(e); });
    each("Boundary", In::values, [&](const Element& e) { model_.solids.read_boundary(e); });
    model_.solids.settle_boundary();
    model_.solids.add_beams();
    model_.solids.add_trusses();
    each("Rigid", In::step, [&](const Element& e) { read_feb_rigid(model_, e); });
    settle_feb_freedoms(model_);
    each("Loads", In::values, [&](const Element& e) { read_feb_loads(model_, e); });
    each("Discrete", In::step, [&](const Element& e) { model_.solids.read_discrete(e); });
    each("Initial", In::start, [&](const Element& e) { model_.solids.read_initial(e); });
    SourceNode probes = make.map();
    each("Output", In::values, [&](const Element& e) { read_feb_output(model_, e, probes); });
    each("Contact", In::step, [&](const Element& e) { model_.solids.read_contact(e); });
    refuse_others();
    make.put(result, "format", make.text("1"));
    if (!model_.gravity.isZero(0.0)) make.put(result, "gravity", make.vector(model_.gravity));
    make.put(result, "bodies", write_feb_bodies(model_));
    model_.solids.write(result);
    if (!model_.joints.keys.empty()) make.put(result, "joints", std::move(model_.joints));
    if (!model_.loads.keys.empty()) make.put(result, "loads", std::move(model_.loads));
    write_controllers(result);
    write_feb_steps(model_, result);
    write_feb_control(model_, std::move(probes), result);
    file_.ignored.add_unread();
    // Otherwise an error, or a note on what was left out, is about them.
    const Element* materials = file_.child(root, "Material");
    const bool given = materials != nullptr && materials->FirstChildElement("material") != nullptr;
    if (model_.bodies.empty() && model_.solids.empty() && (!given || !file_.has_faults()))
      file_.xml.fault(root, "the file has no rigid body and no solid",
                      given ? "All of them were left out." : "Add a material and a mesh.");
    return result;
  }

 private:
  bool check_version(const Element& root) {
    if (std::string_view(root.Name()) != "febio_spec") {
      file_.xml.fault(root, format("the file's tag is <{}>, not <febio_spec>", root.Name()),
                      "Give an FEBio file, which starts with <febio_spec version=\"4.0\">.");
      return false;
    }
    const std::string version = file_.xml.required_text(root, "version");
    if (version == "4.0") return true;
    if (!version.empty())
      file_.xml.fault(root, format("the version {} of FEBio's format is not read", quote(version)),
                      "Export it as 4.0; FEBio Studio converts older files.");
    return false;
  }

  /// Options of an import that have no meaning for an FEBio file.
  void refuse_options() {
    const ImportOptions& options = file_.options;
    const Element& root = file_.xml.root();
    if (!options.start.empty())
      file_.xml.fault(root, "an FEBio file starts where it is, and import.start is given",
                      "Leave it out.");
    if (options.base != "fixed")
      file_.xml.fault(root, "an FEBio file says itself which bodies move freely",
                      "Leave import.base out.");
  }

  void read_module(const Element& e) {
    const std::string type = file_.type(e);
    if (!type.empty() && type != "solid" && type != "explicit-solid")
      file_.xml.fault(e, format("the module {} is not read", quote(type)),
                      "Models of solids and rigid bodies are.");
    file_.ignored.skip(e, {"units"});
  }

  void write_controllers(SourceNode& result) {
    std::map<std::string, std::string> names;
    std::vector<std::string> order;
    for (const FebBody& body : model_.bodies) {
      names.emplace(body.material, body.name);
      order.push_back(body.name);
    }
    model_.curves.write_controllers(names, order, result);
  }

  void refuse_others() {
    for (const char* name : {"Constraints", "MeshAdaptor", "Code", "Include"})
      model_.each_section(name, FebIn::step, [&](const Element& e) {
        if (e.FirstChildElement() != nullptr || !XmlFile::content(e).value_or("").empty())
          file_.refuse(e, format("<{}> is not read", name), "Leave it out.");
      });
    const Element& root = file_.xml.root();
    file_.ignored.skip(root, {"Globals"});
  }

  FebModel& model_;
  FebFile& file_;
};

}  // namespace

FebBody* FebModel::body(const Element& parent, const char* tag) {
  const std::string name = file.text(parent, tag);
  std::vector<std::string> names;
  for (FebBody& b : bodies) {
    if (b.material == name) return &b;
    names.push_back(b.material);
  }
  std::int64_t id = 0;
  const char* end = name.data() + name.size();
  if (!name.empty() && std::from_chars(name.data(), end, id).ptr == end)
    for (FebBody& b : bodies)
      if (b.id == id) return &b;
  file.xml.fault(
      parent, format("<{}> of <{}> is {}, which is no rigid body", tag, parent.Name(), quote(name)),
      did_you_mean(name, names) + "Give the name of a material of type \"rigid body\".");
  return nullptr;
}

std::string FebModel::add_joint(const Element& e, const std::string& name, SourceNode node) {
  std::string chosen = file.name(e, name, joint_names);
  file.make(e).put(joints, chosen, std::move(node));
  return chosen;
}

std::string FebModel::add_load(const Element& e, const std::string& name, SourceNode node) {
  // Events name joints and loads alike.
  std::string chosen = file.name(e, name, steps.size() > 1 ? joint_names : load_names);
  file.make(e).put(loads, chosen, std::move(node));
  return chosen;
}

SourceNode FebModel::vector(const Element& at, const std::array<FebValue, 3>& values,
                            double factor) {
  SourceNode list = file.make(at).list();
  for (const FebValue& value : values) list.children.push_back(curves.node(value, factor));
  return list;
}

Imported import_feb(std::shared_ptr<const SourceText> source, const ImportOptions& options,
                    const std::string& folder) {
  static_cast<void>(folder);  // Nothing in the result is in another file.
  Imported result;
  result.format = "FEBio";
  result.source = source;
  Diagnostics diagnostics(*source);
  XmlFile xml(source, diagnostics);
  FebFile file(xml, result.notes, options);
  FebModel model(file);
  result.root = FebReader(model).read();
  diagnostics.throw_if_any();
  return result;
}

}  // namespace polhode::io
