// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/probe_tables.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <polhode/io/text/file_error.hpp>

namespace polhode {

namespace {

namespace fs = std::filesystem;

/// Cells of a line of a table that a run wrote; quotes around a cell are left out.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"') {
      cells.back() += line[++k];
    } else if (line[k] == '"') {
      quoted = !quoted;
    } else if (line[k] == ',' && !quoted) {
      cells.emplace_back();
    } else if (line[k] != '\r') {
      cells.back() += line[k];
    }
  }
  return cells;
}

}  // namespace

ProbeTables::ProbeTables(const std::string& results) {
  const fs::path folder = fs::absolute(results).parent_path() / "probes";
  folder_ = folder.string();
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".csv") names_.push_back(entry.path().stem().string());
  std::sort(names_.begin(), names_.end());
}

ReportTable ProbeTables::read(const std::string& name) const {
  ReportTable table{name, {}, {}};
  std::istringstream lines(io::read_file((fs::path(folder_) / (name + ".csv")).string()));
  std::string line;
  std::getline(lines, line);
  for (const std::string& head : cells_of(line)) {
    const std::size_t unit = head.rfind(" [");
    const bool has_unit = unit != std::string::npos && head.ends_with(']');
    table.columns.push_back({has_unit ? head.substr(0, unit) : head,
                             has_unit ? head.substr(unit + 2, head.size() - unit - 3) : "",
                             {}});
  }
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != table.columns.size()) continue;
    for (std::size_t k = 0; k < cells.size(); ++k)
      table.columns[k].values.push_back(std::strtod(cells[k].c_str(), nullptr));
  }
  table.t = table.columns.front().values;
  table.columns.erase(table.columns.begin());
  return table;
}

std::vector<ChannelColumn> with_sizes(const std::vector<ChannelColumn>& columns) {
  std::vector<ChannelColumn> all;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    all.push_back(columns[k]);
    if (k < 2 || !columns[k].name.ends_with('z')) continue;
    const ChannelColumn &x = columns[k - 2], &y = columns[k - 1], &z = columns[k];
    std::string head = z.name.substr(0, z.name.size() - 1);
    if (x.name != head + "x" || y.name != head + "y" || x.unit != z.unit || y.unit != z.unit)
      continue;
    while (head.ends_with('.') || head.ends_with(' ')) head.pop_back();
    ChannelColumn size{head.empty() ? "distance" : head + ".size", z.unit, {}};
    for (std::size_t i = 0; i < z.values.size(); ++i)
      size.values.push_back(std::hypot(x.values[i], y.values[i], z.values[i]));
    all.push_back(std::move(size));
  }
  return all;
}

}  // namespace polhode
