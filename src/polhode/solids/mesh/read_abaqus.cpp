// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/mesh_builder.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::solids {
namespace {

/// Shape of an Abaqus element, by its name including the number of its nodes.
const CellShape* abaqus_shape(std::string_view type) {
  static const std::map<std::string, const char*, std::less<>> solids{
      {"C3D4", "tet4"},     {"C3D10", "tet10"}, {"C3D6", "wedge6"},
      {"C3D15", "wedge15"}, {"C3D8", "hex8"},   {"C3D20", "hex20"},
      {"C3D27", "hex27"},   {"T3D2", "line2"},  {"B31", "line2"}};
  static const std::array<const char*, 10> kFaces{"CPS", "CPE",   "CPEG", "CAX", "S",
                                                  "M3D", "SFM3D", "STRI", "DS",  "R3D"};
  std::size_t end = type.size();
  while (end > 0 && !(type[end - 1] >= '0' && type[end - 1] <= '9')) --end;
  const std::string_view stem = type.substr(0, end);
  if (const auto found = solids.find(stem); found != solids.end())
    return &cell_shape(found->second);
  std::size_t digits = end;
  while (digits > 0 && type[digits - 1] >= '0' && type[digits - 1] <= '9') --digits;
  // S4R5 contains two numbers, R3D4 and SFM3D4 have one in the family's name.
  for (const char* family : kFaces) {
    if (!type.starts_with(family)) continue;
    const std::string_view rest = type.substr(std::string_view(family).size());
    if (rest.empty()) continue;
    if (rest[0] == '3') return &cell_shape("tri3");
    if (rest[0] == '4') return &cell_shape("quad4");
    if (rest[0] == '6') return &cell_shape("tri6");
    if (rest[0] == '8') return &cell_shape("quad8");
    if (rest[0] == '9') return &cell_shape("quad9");
  }
  return nullptr;
}

/// Abaqus position of our node i; empty: the same.
std::vector<int> abaqus_order(const CellShape& shape) {
  if (shape.name != "hex27") return {};
  // After the edges: the middle of the cell, then of the faces -z, +z, -y, +x, +y, -x.
  std::vector<int> order(27);
  for (int i = 0; i < 20; ++i) order[static_cast<std::size_t>(i)] = i;
  const std::array<int, 7> rest{26, 24, 23, 25, 21, 22, 20};
  std::copy(rest.begin(), rest.end(), order.begin() + 20);
  return order;
}

/// Local corners of face S1, S2, … of a solid.
std::span<const int> abaqus_face(const CellShape& shape, std::int64_t face) {
  static const std::vector<std::vector<int>> kHex{{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                  {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
  static const std::vector<std::vector<int>> kTet{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  static const std::vector<std::vector<int>> kWedge{
      {0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
  const auto& faces = shape.name.starts_with("hex")   ? kHex
                      : shape.name.starts_with("tet") ? kTet
                                                      : kWedge;
  if (shape.dimension != 3 || face < 1 || face > static_cast<std::int64_t>(faces.size())) return {};
  return faces[static_cast<std::size_t>(face - 1)];
}

/// Keywords that would change the mesh, but are not supported.
const std::set<std::string, std::less<>> kRefused{"INCLUDE", "NGEN",     "NFILL",   "NCOPY",
                                                  "NMAP",    "ELGEN",    "ELCOPY",  "SYSTEM",
                                                  "IMPORT",  "MANIFEST", "SUBMODEL"};
/// Keywords of structure without information on the mesh.
const std::set<std::string, std::less<>> kSilent{"HEADING",  "PREPRINT",     "END PART",
                                                 "ASSEMBLY", "END ASSEMBLY", "END INSTANCE"};

class AbaqusReader {
 public:
  AbaqusReader(const std::string& name, std::string_view bytes)
      : in_(name, bytes), mesh_(in_, false) {}

  Mesh read() {
    next_line();
    while (!done_) {
      if (line_.front() != '*')
        refuse(format("a keyword is expected here, but {} is found", quote(line_)),
               "Begin keywords with '*'");
      read_keyword();
    }
    if (!ignored_.empty()) {
      const std::vector<std::string> names(ignored_.begin(), ignored_.end());
      mesh_.note(format("ignored, as it does not define the mesh: {}", name_list(names)));
    }
    if (!faces_seen_.empty())
      mesh_.note(format("elements of type {} are taken as faces of surfaces",
                        name_list({faces_seen_.begin(), faces_seen_.end()})));
    return mesh_.finish();
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& hint) const {
    throw InputError(in_.text_place(line_at_), what, hint);
  }

  /// Moves to the next line that is neither empty nor a comment.
  void next_line() {
    while (in_.left() > 0) {
      line_ = in_.line();
      line_at_ = in_.token();
      if (!line_.empty() && !line_.starts_with("**")) return;
    }
    line_ = {};
    done_ = true;
  }
  [[nodiscard]] bool at_data() const { return !done_ && line_.front() != '*'; }

  static std::vector<std::string_view> fields(std::string_view line) {
    std::vector<std::string_view> all;
    while (true) {
      const std::size_t comma = line.find(',');
      all.push_back(trimmed(line.substr(0, comma)));
      if (comma == std::string_view::npos) break;
      line.remove_prefix(comma + 1);
    }
    if (all.size() > 1 && all.back().empty()) all.pop_back();  // a trailing comma
    return all;
  }

  /// Splits "*ELEMENT, TYPE=C3D8, ELSET=all" and its continuation lines after a comma.
  void split_keyword() {
    std::string text(line_.substr(1));
    keyword_at_ = line_at_;
    next_line();
    while (text.ends_with(',') && at_data()) {
      text += line_;
      next_line();
    }
    parameters_.clear();
    bool first = true;
    for (std::string_view field : fields(text)) {
      if (first) {
        keyword_ = upper_case(field);
        first = false;
        continue;
      }
      const std::size_t equals = field.find('=');
      std::string_view value =
          equals == std::string_view::npos ? "" : trimmed(field.substr(equals + 1));
      if (value.size() > 1 && value.front() == '"' && value.back() == '"')
        value = value.substr(1, value.size() - 2);
      parameters_[upper_case(trimmed(field.substr(0, equals)))] = value;
    }
  }

  void read_keyword() {
    split_keyword();
    if (kRefused.count(keyword_) > 0)
      throw InputError(in_.text_place(keyword_at_),
                       format("*{} is not supported, and the mesh depends on it", keyword_),
                       "Write the nodes and elements out in one file");
    if (keyword_ == "NODE")
      read_nodes();
    else if (keyword_ == "ELEMENT")
      read_elements();
    else if (keyword_ == "NSET")
      read_node_set();
    else if (keyword_ == "ELSET")
      read_element_set();
    else if (keyword_ == "SURFACE")
      read_surface_lines();
    else if (keyword_ == "PART")
      read_part();
    else if (keyword_ == "INSTANCE")
      read_instance();
    else if (kSilent.count(keyword_) == 0)
      ignored_.insert("*" + keyword_);
    while (at_data()) next_line();
  }

  [[nodiscard]] std::optional<std::string> parameter(std::string_view name) const {
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? std::nullopt : std::optional(found->second);
  }
  std::string required(std::string_view name) const {
    const auto found = parameter(name);
    if (!found || found->empty())
      throw InputError(in_.text_place(keyword_at_), format("*{} needs {}=…", keyword_, name),
                       "Name it in the keyword's line");
    return *found;
  }
  /// Name under which a set first appeared: it is not case sensitive.
  std::string set_name(const std::string& given) {
    return names_.try_emplace(upper_case(given), given).first->second;
  }

  std::int64_t integer(std::string_view text, std::string_view what) const {
    std::int64_t value = 0;
    if (!parse_integer(text, value))
      refuse(format("{} is expected here, but {} is no whole number", what, quote(text)),
             kExportMeshAgain);
    return value;
  }
  double number(std::string_view text) const {
    double value = 0.0;
    if (!text.empty() && !parse_number(text, value))
      refuse(format("a coordinate is expected here, but {} is no finite number", quote(text)),
             kExportMeshAgain);
    return value;
  }

  void read_part() {
    if (++parts_ > 1)
      throw InputError(in_.text_place(keyword_at_), "the file has more than one part",
                       "Write it without parts and assemblies, or one part by itself");
  }

  void read_instance() {
    if (++instances_ > 1)
      throw InputError(in_.text_place(keyword_at_), "the file has more than one instance",
                       "Write it without parts and assemblies, or one part by itself");
    if (at_data())
      refuse("the instance is moved, which is not supported",
             "Leave the translation out and place the mesh in the model");
  }

  void read_nodes() {
    if (const auto system = parameter("SYSTEM"); system && upper_case(*system) != "R")
      throw InputError(in_.text_place(keyword_at_),
                       format("coordinates of system {} are not supported", quote(*system)),
                       "Write Cartesian coordinates");
    const auto set = parameter("NSET");
    for (; at_data(); next_line()) {
      const auto all = fields(line_);
      if (all.size() < 2) refuse("a node has a number and three coordinates", kExportMeshAgain);
      const std::int64_t label = integer(all[0], "the number of a node");
      Vec3 X = Vec3::Zero();
      for (std::size_t k = 1; k < std::min<std::size_t>(all.size(), 4); ++k)
        X[static_cast<Eigen::Index>(k - 1)] = number(all[k]);
      mesh_.add_node(label, X, line_at_);
      if (set) put_node(label, *set);
    }
  }

  void read_elements() {
    const std::string type = upper_case(required("TYPE"));
    const CellShape* shape = abaqus_shape(type);
    if (!shape)
      throw InputError(
          in_.text_place(keyword_at_), format("elements of type {} are not supported", quote(type)),
          "Types: C3D4, C3D10, C3D6, C3D15, C3D8, C3D20, C3D27 with any letters behind, T3D2, "
          "B31; CPS, CPE, S, M3D and SFM3D of 3, 4, 6, 8 or 9 nodes as surfaces");
    if (shape->dimension == 2) faces_seen_.insert(type);
    const auto set = parameter("ELSET");
    const std::vector<int> order = abaqus_order(*shape);
    const std::size_t n = shape->nodes.size();
    std::vector<std::int64_t> numbers, nodes(n);
    while (at_data()) {
      const std::size_t at = line_at_;
      numbers.clear();
      while (numbers.size() < n + 1 && at_data()) {
        for (std::string_view field : fields(line_))
          numbers.push_back(integer(field, "the number of a node"));
        next_line();
      }
      if (numbers.size() != n + 1)
        throw InputError(in_.text_place(at),
                         format("an element of type {} has {} nodes, but {} are given", type, n,
                                numbers.size() - 1),
                         kExportMeshAgain);
      for (std::size_t i = 0; i < n; ++i)
        nodes[i] = numbers[1 + (order.empty() ? i : static_cast<std::size_t>(order[i]))];
      const int cell = mesh_.add_cell(*shape, numbers[0], nodes, at);
      if (!elements_.try_emplace(numbers[0], cell).second)
        throw InputError(in_.text_place(at), format("element {} is given twice", numbers[0]),
                         "Give each element a number of its own");
      if (set) put_cell(cell, *set);
    }
  }

  /// Members of a set in their order, each once.
  template <class T>
  struct Members {
    std::vector<T> list;
    std::unordered_set<T> known;
  };

  void put_node(std::int64_t label, const std::string& set) {
    count_work();
    const std::string name = set_name(set);
    Members<std::int64_t>& members = node_sets_[name];
    if (!members.known.insert(label).second) return;
    mesh_.put_node(label, name, line_at_);
    members.list.push_back(label);
  }
  void put_cell(int cell, const std::string& set) {
    count_work();
    const std::string name = set_name(set);
    Members<int>& members = element_sets_[name];
    if (!members.known.insert(cell).second) return;
    mesh_.put(cell, name);
    members.list.push_back(cell);
  }
  /// Limits nested sets of sets, which could otherwise take hours for a small file.
  void count_work() {
    if (++work_ > 100'000 + 200 * in_.bytes().size())
      refuse("the sets contain one another too many times", "Write the sets without nesting");
  }

  /// Calls use() with each number of the data lines; with GENERATE, lines are first, last, step. A
  /// word that is not a number is a set: use_set().
  template <class Use, class UseSet>
  void each_member(const Use& use, const UseSet& use_set) {
    const bool generate = parameters_.count("GENERATE") > 0;
    for (; at_data(); next_line()) {
      const auto all = fields(line_);
      if (!generate) {
        for (std::string_view field : all) {
          std::int64_t label = 0;
          if (parse_integer(field, label))
            use(label);
          else
            use_set(std::string(field));
        }
        continue;
      }
      const std::int64_t first = integer(all[0], "the first number");
      const std::int64_t last = all.size() > 1 ? integer(all[1], "the last number") : first;
      const std::int64_t step = all.size() > 2 ? integer(all[2], "the step") : 1;
      const std::int64_t most =
          1 + static_cast<std::int64_t>(
                  std::max(mesh_.node_count(), static_cast<std::size_t>(mesh_.cell_count())));
      if (first < 0 || step < 1 || last < first || (last - first) / step > most)
        refuse(format("the numbers {} to {} by {} cannot be generated", first, last, step),
               "Give first, last and step, of numbers that exist");
      for (std::int64_t label = first; label <= last; label += step) use(label);
    }
  }

  void read_node_set() {
    const std::string name = required("NSET");
    if (const auto of = parameter("ELSET"))
      refuse_keyword(format("*NSET with ELSET={} is not supported", quote(*of)),
                     "Select by the element set itself");
    each_member([&](std::int64_t label) { put_node(label, name); },
                [&](const std::string& other) {
                  const auto found = node_sets_.find(set_name(other));
                  if (found == node_sets_.end()) refuse_set("nodes", other, node_sets_);
                  const std::vector<std::int64_t> members = found->second.list;
                  for (std::int64_t label : members) put_node(label, name);
                });
  }

  void read_element_set() {
    const std::string name = required("ELSET");
    each_member([&](std::int64_t label) { put_cell(cell_of(label), name); },
                [&](const std::string& other) {
                  const std::vector<int> members = cells_of_set(other);
                  for (int cell : members) put_cell(cell, name);
                });
  }

  int cell_of(std::int64_t label) const {
    const auto found = elements_.find(label);
    if (found == elements_.end())
      refuse(format("element {} does not exist", label), "Name elements that are defined above");
    return found->second;
  }
  const std::vector<int>& cells_of_set(const std::string& name) {
    const auto found = element_sets_.find(set_name(name));
    if (found == element_sets_.end()) refuse_set("elements", name, element_sets_);
    return found->second.list;
  }
  template <class Sets>
  [[noreturn]] void refuse_set(const char* things, const std::string& name,
                               const Sets& sets) const {
    std::vector<std::string> names;
    names.reserve(sets.size());
    for (const auto& [key, members] : sets) names.push_back(key);
    refuse(format("there is no set of {} {} above", things, quote(name)),
           did_you_mean(name, names) +
               (names.empty() ? "There are none" : "Sets: " + name_list(names)));
  }
  [[noreturn]] void refuse_keyword(const std::string& what, const std::string& hint) const {
    throw InputError(in_.text_place(keyword_at_), what, hint);
  }

  void read_surface_lines() {
    const std::string name = required("NAME");
    const std::string type = upper_case(parameter("TYPE").value_or("ELEMENT"));
    if (type == "NODE") {
      each_member([&](std::int64_t label) { put_node(label, name); },
                  [&](const std::string& other) {
                    const auto found = node_sets_.find(set_name(other));
                    if (found == node_sets_.end()) refuse_set("nodes", other, node_sets_);
                    const std::vector<std::int64_t> members = found->second.list;
                    for (std::int64_t label : members) put_node(label, name);
                  });
      return;
    }
    if (type != "ELEMENT")
      refuse_keyword(format("surfaces of type {} are not supported", quote(type)),
                     "Use TYPE=ELEMENT or TYPE=NODE");
    for (; at_data(); next_line()) {
      const auto all = fields(line_);
      std::vector<int> cells;
      std::int64_t label = 0;
      if (parse_integer(all[0], label))
        cells = {cell_of(label)};
      else
        cells = cells_of_set(std::string(all[0]));
      if (all.size() < 2 || all[1].empty()) {
        mesh_.put_free_faces(cells, set_name(name));
        continue;
      }
      std::int64_t face = 0;
      const std::string side = upper_case(all[1]);
      const bool known = side.size() > 1 && side[0] == 'S' &&
                         parse_integer(std::string_view(side).substr(1), face);
      for (int cell : cells) {
        const std::span<const int> corners =
            known ? abaqus_face(mesh_.shape(cell), face) : std::span<const int>{};
        if (corners.empty())
          refuse(format("{} is no face of element {} ({})", quote(all[1]), mesh_.label(cell),
                        mesh_.shape(cell).name),
                 "Faces of solids are S1, S2, …");
        mesh_.put_face(cell, corners, set_name(name));
      }
    }
  }

  MeshCursor in_;
  MeshBuilder mesh_;
  std::string_view line_;
  std::size_t line_at_ = 0;
  bool done_ = false;
  std::string keyword_;
  std::size_t keyword_at_ = 0;
  std::map<std::string, std::string, std::less<>> parameters_;
  std::map<std::string, std::string> names_;
  std::map<std::string, Members<std::int64_t>> node_sets_;
  std::map<std::string, Members<int>> element_sets_;
  std::size_t work_ = 0;
  std::unordered_map<std::int64_t, int> elements_;
  std::set<std::string> ignored_, faces_seen_;
  int parts_ = 0;
  int instances_ = 0;
};

}  // namespace

Mesh parse_abaqus(const std::string& name, std::string_view bytes) {
  return AbaqusReader(name, bytes).read();
}

}  // namespace polhode::solids
