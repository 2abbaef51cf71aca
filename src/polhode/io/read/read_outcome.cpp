// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_outcome.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

std::string without_spaces(const std::string& cell) {
  const std::size_t first = cell.find_first_not_of(" \t\r\"");
  if (first == std::string::npos) return {};
  return cell.substr(first, cell.find_last_not_of(" \t\r\"") - first + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(without_spaces(cell));
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

/// Name of a column, without its unit in brackets.
std::string column_name(const std::string& cell) {
  const std::string name = without_spaces(cell.substr(0, cell.find('[')));
  return name == "t" ? "time" : name;
}

/// Number of a cell. @returns false for text.
bool read_cell(const std::string& cell, double& number) {
  char* end = nullptr;
  number = std::strtod(cell.c_str(), &end);
  return !cell.empty() && *end == '\0' && std::isfinite(number);
}

}  // namespace

Outcome read_outcome(const std::string& text) {
  static const std::string start = "misfit:";
  if (!text.starts_with(start)) return parse_outcome(text);
  const std::string file = text.substr(start.size());
  Outcome outcome{.text = text, .channel = {}, .at = Outcome::At::misfit};
  const auto refuse = [&](int line, const std::string& what, const std::string& hint) {
    throw InputError("the outcome", format("'{}': {}:{}: {}", text, file, line, what), hint);
  };
  std::stringstream lines(read_file(file));
  std::vector<std::string> names;
  std::size_t time = 0;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (without_spaces(line).empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = cells_of(line);
    if (names.empty()) {
      for (const std::string& cell : cells) names.push_back(column_name(cell));
      time =
          static_cast<std::size_t>(std::find(names.begin(), names.end(), "time") - names.begin());
      if (time == names.size())
        refuse(number, "no column is named 't [s]' or 'time'", "Name the times so in the header");
      continue;
    }
    if (cells.size() != names.size())
      refuse(number, format("has {} cells, the header {}", cells.size(), names.size()),
             "Write a cell for each column");
    double t = 0.0, value = 0.0;
    if (!read_cell(cells[time], t) || t < 0.0)
      refuse(number, format("'{}' is no time", cells[time]), "Write a time in seconds");
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k == time || cells[k].empty()) continue;
      if (!read_cell(cells[k], value))
        refuse(number, format("'{}' is no number", cells[k]),
               "Write a number, or nothing where there is none");
      outcome.measured.push_back({names[k], t, value});
    }
  }
  if (outcome.measured.empty())
    refuse(number, "holds no measured values", "Write a header, and a row for each time");
  return outcome;
}

}  // namespace polhode::io
