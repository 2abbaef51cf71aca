// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/channels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/results/svg_panel.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

/// Numbers `first` to `first + labels.size() − 1` of each frame of a data set.
struct Slice {
  std::string path, head, unit;
  std::size_t first = 0;
  std::vector<std::string> labels;  ///< One that is empty: a number without components.
  /// Data set of the quaternions by which it is turned back, to the axes of a body; "": none.
  std::string turned_by{};
  std::size_t first_turn = 0;
};

/// Most coordinates of a joint.
constexpr std::int64_t kMostCoordinates = 6;
/// Names of channels end with it for the length of a vector, and begin with it for a probe.
constexpr std::string_view kSize = ".size", kProbes = "probes.";

std::vector<std::string> labels_of(std::size_t size) {
  if (size == 1) return {""};
  if (size == 3) return {"x", "y", "z"};
  if (size == 4) return {"w", "x", "y", "z"};
  if (size == 6) return {"xx", "yy", "zz", "xy", "yz", "xz"};
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < size; ++k) labels.push_back(format("{}", k));
  return labels;
}

/// Every channel of the results, in the order of the table.
std::vector<Slice> slices_of(const io::ResultsReader& results) {
  std::vector<Slice> list;
  const auto packed = [&](const char* group, const char* shown,
                          std::initializer_list<const char*> quantities) {
    const std::vector<std::string> names = results.names(std::string(group) + "/names");
    for (std::size_t k = 0; k < names.size(); ++k)
      for (const char* q : quantities) {
        const io::ResultsReader::DataSet* set = results.find(format("{}/{}", group, q));
        if (set == nullptr) continue;
        const std::size_t size = set->size() / names.size();
        list.push_back({set->path, format("{}.{}.{}", shown, names[k], q), set->unit, k * size,
                        labels_of(size)});
      }
  };
  packed(io::results::kPackedBodies, "bodies",
         {"position", "orientation", "velocity", "angular_velocity"});
  packed(io::results::kPackedJoints, "joints", {"force", "moment", "impulse", "angular_impulse"});
  const std::string joints = io::results::kPackedJoints, loads = io::results::kPackedLoads;
  const std::vector<std::string> joint_names = results.names(joints + "/names");
  const std::vector<std::int64_t> first = results.numbers(joints + "/first"),
                                  count = results.numbers(joints + "/count");
  if (first.size() != joint_names.size() || count.size() != joint_names.size())
    results.refuse("its lists of joints do not fit each other");
  for (std::size_t k = 0; k < joint_names.size(); ++k)
    for (const char* q : {"coordinates", "rates"})
      if (count[k] > 0 && count[k] <= kMostCoordinates) {
        std::vector<std::string> labels;
        for (std::int64_t c = 0; c < count[k]; ++c) labels.push_back(format("{}", c));
        if (labels.size() == 1) labels = {""};
        list.push_back({format("{}/{}", joints, q), format("joints.{}.{}", joint_names[k], q),
                        q[0] == 'c' ? "rad or m" : "rad/s or m/s",
                        static_cast<std::size_t>(first[k]), labels});
      }
  const std::vector<std::string> load_names = results.names(loads + "/names"),
                                 load_types = results.names(loads + "/types");
  const std::vector<std::int64_t> load_first = results.numbers(loads + "/first"),
                                  load_count = results.numbers(loads + "/count");
  if (load_types.size() != load_names.size() || load_first.size() != load_names.size() ||
      load_count.size() != load_names.size())
    results.refuse("its lists of loads do not fit each other");
  for (std::size_t k = 0; k < load_names.size(); ++k) {
    auto at = static_cast<std::size_t>(load_first[k]);
    for (const LoadChannel& c : load_kind(load_types[k]).channels) {
      const auto size = static_cast<std::size_t>(c.size);
      // Results of earlier versions may have fewer.
      if (at + size > static_cast<std::size_t>(load_first[k] + load_count[k])) break;
      list.push_back({loads + "/values", format("loads.{}.{}", load_names[k], c.name), c.unit, at,
                      labels_of(size)});
      at += size;
    }
  }
  packed(io::results::kPackedContacts, "contacts",
         {"gap", "normal_force", "force", "friction", "point", "points", "status", "impulse",
          "energy_lost"});
  for (const io::ResultsReader::DataSet& set : results.data_sets()) {
    if (set.path.rfind("/packed/", 0) == 0 || set.path == io::results::kTime) continue;
    if (set.path.find("/elements/") != std::string::npos ||
        set.path.find("/nodes/") != std::string::npos)
      continue;
    std::string head = set.path.substr(1);
    std::replace(head.begin(), head.end(), '/', '.');
    list.push_back({set.path, head, set.unit, 0, labels_of(set.size())});
  }
  return list;
}

/// Channels that are computed from others, found by their names alone: angular velocities along the
/// bodies' axes.
std::vector<Slice> derived_from(const std::vector<Slice>& slices) {
  std::vector<Slice> list;
  for (const Slice& turn : slices) {
    const std::string_view end = ".orientation";
    if (!turn.head.starts_with("bodies.") || !turn.head.ends_with(end)) continue;
    const std::string name =
        turn.head.substr(0, turn.head.size() - end.size()) + ".angular_velocity";
    const auto spin =
        std::find_if(slices.begin(), slices.end(), [&](const Slice& s) { return s.head == name; });
    if (spin == slices.end()) continue;
    list.push_back(*spin);
    list.back().head += "_body";
    list.back().turned_by = turn.path;
    list.back().first_turn = turn.first;
  }
  return list;
}

std::string full_name(const Slice& slice, std::size_t k) {
  return slice.labels[k].empty() ? slice.head : slice.head + "." + slice.labels[k];
}

/// Reader with a cache: many columns come from one data set.
class Columns {
 public:
  explicit Columns(const io::ResultsReader& results)
      : results_(results), slices_(slices_of(results)), derived_(derived_from(slices_)) {}

  std::vector<ChannelColumn> find(const std::string& name) {
    std::vector<ChannelColumn> found;
    for (const Slice& slice : derived_)
      for (std::size_t k = 0; k < slice.labels.size(); ++k)
        if (slice.head == name || full_name(slice, k) == name)
          found.push_back({full_name(slice, k), slice.unit, turned_column(slice, k)});
    for (const Slice& slice : slices_) {
      const bool whole = slice.head == name || slice.head.rfind(name + ".", 0) == 0;
      for (std::size_t k = 0; k < slice.labels.size(); ++k)
        if (whole || full_name(slice, k) == name)
          found.push_back({full_name(slice, k), slice.unit, column(slice, k)});
    }
    if (found.empty() && name.ends_with(kSize)) found = size_of(name);
    if (!found.empty()) return found;
    std::vector<std::string> names;
    for (const auto* list : {&slices_, &derived_})
      for (const Slice& slice : *list) names.push_back(slice.head);
    throw InputError("channel", format("there is no '{}'", name),
                     did_you_mean(name, names) +
                         "Channels are named like energy.kinetic, bodies.NAME.position.x, "
                         "joints.NAME.force.size or probes.NAME.COLUMN");
  }
  [[nodiscard]] const std::vector<Slice>& slices() const { return slices_; }

 private:
  /// Length of a vector, VECTOR.size.
  std::vector<ChannelColumn> size_of(const std::string& name) {
    const std::string vector = name.substr(0, name.size() - kSize.size());
    for (const auto* list : {&slices_, &derived_})
      for (const Slice& slice : *list)
        if (slice.head == vector && slice.labels == labels_of(3))
          return {with_sizes(find(vector)).back()};
    return {};
  }

  std::vector<double> column(const Slice& slice, std::size_t k) {
    auto [entry, fresh] = read_.try_emplace(slice.path);
    if (fresh) entry->second = results_.read(slice.path);
    const std::vector<double>& all = entry->second;
    const io::ResultsReader::DataSet* set = results_.find(slice.path);
    const std::size_t width = set == nullptr ? 0 : set->size();
    if (slice.first + k >= width) results_.refuse(format("'{}' is too short", slice.path));
    std::vector<double> values;
    for (std::size_t at = slice.first + k; at < all.size(); at += width) values.push_back(all[at]);
    return values;
  }

  /// Component of a vector turned to the axes of a body.
  std::vector<double> turned_column(const Slice& slice, std::size_t k) {
    Slice turn;
    turn.path = slice.turned_by;
    turn.first = slice.first_turn;
    std::array<std::vector<double>, 3> v;
    std::array<std::vector<double>, 4> q;
    for (std::size_t i = 0; i < 3; ++i) v[i] = column(slice, i);
    for (std::size_t i = 0; i < 4; ++i) q[i] = column(turn, i);
    std::vector<double> values;
    for (std::size_t f = 0; f < v[0].size() && f < q[0].size(); ++f)
      values.push_back((Quat(q[0][f], q[1][f], q[2][f], q[3][f]).conjugate() *
                        Vec3(v[0][f], v[1][f], v[2][f]))[static_cast<Eigen::Index>(k)]);
    return values;
  }

  const io::ResultsReader& results_;
  std::vector<Slice> slices_, derived_;
  std::map<std::string, std::vector<double>> read_;
};

/// Columns of a probe, all of them or one, with their full names.
ReportTable probe_columns(const ProbeTables& probes, const std::string& name) {
  const std::string tail = name.substr(kProbes.size());
  std::string probe;  // names may contain dots: the longest one that fits
  for (const std::string& n : probes.names())
    if ((tail == n || tail.starts_with(n + ".")) && n.size() > probe.size()) probe = n;
  if (probe.empty())
    throw InputError("channel", format("there is no '{}'", name),
                     probes.names().empty()
                         ? "There are no tables of probes beside the results: give the model "
                           "probes in output, and run it into a folder"
                         : did_you_mean(tail.substr(0, tail.find('.')), probes.names()) +
                               "Columns of probes are named probes.NAME.COLUMN");
  ReportTable table = probes.read(probe);
  const std::string column = tail == probe ? "" : tail.substr(probe.size() + 1);
  std::vector<ChannelColumn> wanted;
  std::vector<std::string> names;
  for (ChannelColumn& c : column.empty() ? table.columns : with_sizes(table.columns)) {
    names.push_back(c.name);
    if (!column.empty() && c.name != column) continue;
    c.name = format("{}{}.{}", kProbes, probe, c.name);
    wanted.push_back(std::move(c));
  }
  if (wanted.empty())
    throw InputError("channel", format("probe '{}' has no column '{}'", probe, column),
                     did_you_mean(column, names) + format("It has {}", name_list(names, 12)));
  table.columns = std::move(wanted);
  return table;
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

constexpr std::array<const char*, 8> kColours = {"#1f5fa8", "#c8641b", "#2d8a4e", "#8a5fb0",
                                                 "#b58a12", "#2a98a0", "#b8437f", "#6c7882"};

}  // namespace

std::vector<ChannelColumn> channel_columns(const io::ResultsReader& results,
                                           const std::string& name) {
  return Columns(results).find(name);
}

std::vector<ChannelColumn> all_columns(const io::ResultsReader& results) {
  Columns all(results);
  std::vector<ChannelColumn> columns;
  for (const Slice& slice : all.slices())
    for (ChannelColumn& c : all.find(slice.head)) columns.push_back(std::move(c));
  return columns;
}

ReportTable table_of(const io::ResultsReader& results, const ProbeTables& probes,
                     const std::vector<std::string>& names) {
  const std::vector<double> frames = results.read(io::results::kTime);
  if (names.empty()) return {"", frames, all_columns(results)};
  Columns all(results);
  ReportTable table;
  for (const std::string& name : names) {
    ReportTable part = name.starts_with(kProbes) ? probe_columns(probes, name)
                                                 : ReportTable{"", frames, all.find(name)};
    if (!table.columns.empty() && part.t != table.t)
      throw InputError("channel",
                       format("'{}' has other times than '{}'", name, table.columns.front().name),
                       "Write them into tables of their own, or give probes the 'every' of output");
    table.t = std::move(part.t);
    for (ChannelColumn& c : part.columns) table.columns.push_back(std::move(c));
  }
  return table;
}

std::vector<std::string> channel_names(const io::ResultsReader& results,
                                       const ProbeTables& probes) {
  std::vector<std::string> names;
  for (const Slice& slice : slices_of(results)) names.push_back(slice.head);
  for (const std::string& probe : probes.names())
    for (const ChannelColumn& c : probes.read(probe).columns)
      names.push_back(format("{}{}.{}", kProbes, probe, c.name));
  return names;
}

std::string channels_csv(const io::ResultsReader& results, const ProbeTables& probes,
                         const std::vector<std::string>& names) {
  const auto [none, t, columns] = table_of(results, probes, names);
  std::string text = "t [s]";
  for (const ChannelColumn& c : columns) text += "," + quoted(format("{} [{}]", c.name, c.unit));
  text += "\n";
  for (std::size_t f = 0; f < t.size(); ++f) {
    text += format("{}", t[f]);
    for (const ChannelColumn& c : columns) text += format(",{}", c.values[f]);
    text += "\n";
  }
  return text;
}

std::string panels_svg(const std::vector<CurvePanel>& panels, const std::string& time_label) {
  constexpr double kWidth = 720.0, kHeight = 190.0, kLeft = 84.0, kTop = 34.0, kStep = 250.0;
  std::string content;
  double y = kTop;
  for (const CurvePanel& curves : panels) {
    const std::string& name = curves.title;
    const std::vector<double>& t = curves.t;
    const double begin = t.empty() ? 0.0 : t.front(), end = t.empty() ? 1.0 : t.back();
    if (curves.columns.size() > kColours.size())
      throw InputError("channel", format("'{}' holds {} curves", name, curves.columns.size()),
                       "Name a part of it, at most eight curves go into a panel");
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::string units;
    for (const ChannelColumn& c : curves.columns) {
      for (double v : c.values)
        if (std::isfinite(v)) {
          low = std::min(low, v);
          high = std::max(high, v);
        }
      if (units.find(c.unit) == std::string::npos) units += (units.empty() ? "" : ", ") + c.unit;
    }
    if (!(high >= low)) low = 0.0, high = 1.0;
    const double room = high > low ? 0.06 * (high - low) : std::max(1e-12, 0.1 * std::abs(high));
    io::SvgPanel panel({kLeft, y, kWidth - kLeft - 170.0, kHeight}, begin,
                       end > begin ? end : begin + 1.0, low - room, high + room,
                       format("{} [{}]", name, units));
    for (std::size_t i = 0; i < curves.columns.size(); ++i) {
      panel.curve(t, curves.columns[i].values, kColours[i]);
      if (curves.columns[i].name == name) continue;  // the title says it
      const double line = y + 10.0 + 18.0 * static_cast<double>(i);
      content += format(
          "<line x1=\"{0}\" y1=\"{1}\" x2=\"{2}\" y2=\"{1}\" stroke=\"{3}\" stroke-width=\"2\"/>\n",
          kWidth - 160.0, line - 4.0, kWidth - 140.0, kColours[i]);
      const std::string& full = curves.columns[i].name;
      const bool begins = full.starts_with(name + ".");
      content += io::svg_text(kWidth - 134.0, line, begins ? full.substr(name.size() + 1) : full);
    }
    content += panel.text();
    content += io::svg_text(kLeft + 200.0, y + kHeight + 34.0, time_label);
    y += kStep;
  }
  return io::svg_page(kWidth, y, content);
}

std::string channels_svg(const io::ResultsReader& results, const ProbeTables& probes,
                         const std::vector<std::string>& names, const std::string& time_label) {
  Columns all(results);
  const std::vector<double> t = results.read(io::results::kTime);
  std::vector<CurvePanel> panels;
  for (const std::string& name : names) {
    if (!name.starts_with(kProbes)) {
      panels.push_back({name, t, all.find(name)});
      continue;
    }
    ReportTable probe = probe_columns(probes, name);
    panels.push_back({name, std::move(probe.t), std::move(probe.columns)});
  }
  return panels_svg(panels, time_label);
}

}  // namespace polhode
