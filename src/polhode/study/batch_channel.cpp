// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/simulation/probe_columns.hpp>
#include <polhode/study/batch_channel.hpp>

namespace polhode {

namespace {

constexpr const char* kChannel = "the channel";

/// A quantity of several columns, which have this prefix or these names.
struct Quantity {
  const char *kind, *name;
  std::vector<std::string> columns;
};

std::vector<std::string> axes(const std::string& prefix) {
  return {prefix + "x", prefix + "y", prefix + "z"};
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> list = {
      {"body", "position", axes("")},          {"body", "velocity", axes("v")},
      {"body", "acceleration", axes("a")},     {"body", "orientation", {"qw", "qx", "qy", "qz"}},
      {"body", "angular_velocity", axes("w")}, {"body", "angular_acceleration", axes("alpha")},
      {"joint", "force", axes("f")},           {"joint", "moment", axes("m")},
  };
  return list;
}

/// Name and unit of a column "vx [m/s]".
std::pair<std::string, std::string> name_and_unit(const std::string& head) {
  const std::size_t at = head.rfind(" [");
  if (at == std::string::npos) return {head, "-"};
  return {head.substr(0, at), head.substr(at + 2, head.size() - at - 3)};
}

/// The columns of an object, and what can be asked of it.
class Columns {
 public:
  Columns(const Model& model, const ProbeSpec& spec) : kind_(spec.kind) {
    for (const std::string& head : probe_columns(model, spec)) {
      const auto [name, unit] = name_and_unit(head);
      names_.push_back(name);
      units_.push_back(unit);
    }
  }

  [[nodiscard]] const std::string& unit(std::size_t column) const { return units_[column]; }
  [[nodiscard]] std::vector<std::size_t> all() const {
    std::vector<std::size_t> list(names_.size());
    for (std::size_t i = 0; i < list.size(); ++i) list[i] = i;
    return list;
  }
  /// Columns of a quantity; empty if there is none of that name.
  [[nodiscard]] std::vector<std::size_t> of(const std::string& quantity) const {
    std::vector<std::size_t> list;
    const bool rates = quantity == "rates";
    if (kind_ == "joint" && (rates || quantity == "coordinates")) {
      for (std::size_t i = 0; i < names_.size(); ++i)
        if (const std::size_t rate = find("rate " + names_[i]); rate < names_.size())
          list.push_back(rates ? rate : i);
      return list;
    }
    for (const Quantity& q : quantities())
      if (kind_ == q.kind && quantity == q.name)
        for (const std::string& name : q.columns) list.push_back(find(name));
    return list;
  }
  [[nodiscard]] std::size_t find(const std::string& name) const {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  [[nodiscard]] std::size_t count() const { return names_.size(); }
  /// Names of quantities and columns.
  [[nodiscard]] std::vector<std::string> known() const {
    std::vector<std::string> list;
    for (const Quantity& q : quantities())
      if (kind_ == q.kind) list.emplace_back(q.name);
    if (kind_ == "joint") list.insert(list.end(), {"coordinates", "rates"});
    if (kind_ != "body") list.insert(list.end(), names_.begin(), names_.end());
    return list;
  }

 private:
  std::string kind_;
  std::vector<std::string> names_, units_;
};

/// Number of a component among `count`, or `count`.
std::size_t component(const std::string& name, std::size_t count) {
  if (name.size() != 1) return count;
  if (name[0] >= '0' && name[0] <= '9')
    return std::min(count, static_cast<std::size_t>(name[0] - '0'));
  const std::string letters = count == 4 ? "wxyz" : count == 3 ? "xyz" : "";
  return std::min(count, letters.find(name[0]));
}

template <class Specs>
std::vector<std::string> names_of(const Specs& specs) {
  std::vector<std::string> names;
  for (const auto& spec : specs) names.push_back(spec.name);
  return names;
}

/// The longest of the names with which the text begins, followed by a dot or its end; names may
/// have dots themselves.
std::string leading_name(const std::vector<std::string>& names, const std::string& text) {
  std::string best;
  for (const std::string& name : names)
    if (text.starts_with(name) && name.size() > best.size() &&
        (text.size() == name.size() || text[name.size()] == '.'))
      best = name;
  return best;
}

}  // namespace

BatchChannel batch_channel(const Model& model, const std::string& text) {
  static const std::array<std::array<const char*, 2>, 4> lists = {
      {{"bodies", "body"}, {"joints", "joint"}, {"loads", "load"}, {"probes", "probe"}}};
  const std::size_t dot = text.find('.');
  const std::string list = text.substr(0, dot);
  const auto kind =
      std::find_if(lists.begin(), lists.end(), [&](const auto& l) { return list == l[0]; });
  if (kind == lists.end() || dot == std::string::npos)
    throw InputError(kChannel, format("'{}' is not known", text),
                     "Write bodies.NAME.position, joints.NAME.coordinates, loads.NAME.COLUMN or "
                     "probes.NAME");
  const std::string rest = text.substr(dot + 1), what = (*kind)[1];
  const std::vector<std::string> names = what == "body"    ? names_of(model.bodies)
                                         : what == "joint" ? names_of(model.joints)
                                         : what == "load"  ? names_of(model.loads)
                                                           : names_of(model.output.probes);
  const std::string name = leading_name(names, rest);
  if (name.empty()) {
    const std::string asked = rest.substr(0, rest.find('.'));
    throw InputError(kChannel, format("'{}' names no {} of the model", text, what),
                     format("{}They are: {}", did_you_mean(asked, names), name_list(names)));
  }
  BatchChannel channel{.text = text, .unit = "-"};
  if (what == "probe") {
    channel.of = model.output.probes[static_cast<std::size_t>(model.probe_index(name))];
  } else {
    channel.of.kind = what;
    channel.of.target = name;
    if (what == "body") {
      channel.of.rotation = "quaternion";
      channel.of.angular = true;
    }
  }
  const Columns columns(model, channel.of);
  const std::string quantity = rest.size() > name.size() ? rest.substr(name.size() + 1) : "";
  const auto missing = [&] {
    const std::vector<std::string> known = columns.known();
    return InputError(kChannel, format("'{}': {} '{}' has no '{}'", text, what, name, quantity),
                      format("{}Name one of: {}", did_you_mean(quantity, known), name_list(known)));
  };
  if (quantity.empty() && what == "probe") channel.columns = columns.all();
  if (channel.columns.empty()) channel.columns = columns.of(quantity);
  if (channel.columns.empty() && columns.find(quantity) < columns.count()) {
    channel.columns = {columns.find(quantity)};
    channel.one = true;
  }
  if (channel.columns.empty()) {  // a number of a vector
    const std::size_t last = quantity.rfind('.');
    if (last == std::string::npos) throw missing();
    const std::vector<std::size_t> of = columns.of(quantity.substr(0, last));
    const std::size_t k = component(quantity.substr(last + 1), of.size());
    if (k >= of.size()) throw missing();
    channel.columns = {of[k]};
    channel.one = true;
  }
  channel.unit = columns.unit(channel.columns.front());
  return channel;
}

std::vector<std::string> usual_channels(const Model& model) {
  std::vector<std::string> list;
  for (const ProbeSpec& probe : model.output.probes) list.push_back("probes." + probe.name);
  if (!list.empty()) return list;
  for (const BodySpec& body : model.bodies)
    if (!body.fixed && body.node_of.empty())
      for (const char* quantity : {"position", "orientation"})
        list.push_back(format("bodies.{}.{}", body.name, quantity));
  return list;
}

}  // namespace polhode
