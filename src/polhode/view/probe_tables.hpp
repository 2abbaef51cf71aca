// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode {

/// One number of a channel over all frames.
struct ChannelColumn {
  std::string name;  ///< bodies.crank.position.x
  std::string unit;
  std::vector<double> values;
};

/// Columns over time with a name, such as those of a probe.
struct ReportTable {
  std::string name;
  std::vector<double> t;
  std::vector<ChannelColumn> columns;
};

/// Tables of the probes of a run, probes/NAME.csv beside its results file, read when they are asked
/// for.
class ProbeTables {
 public:
  ProbeTables() = default;
  /// @param results  Path of the results file.
  explicit ProbeTables(const std::string& results);

  /// Names of the probes, in order.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// A table; a last line that is cut short is left out. @throws FileError
  [[nodiscard]] ReportTable read(const std::string& name) const;

 private:
  std::string folder_;
  std::vector<std::string> names_;
};

/// Sizes of the vectors among columns, which have names that end with x, y and z: one column each,
/// behind its components.
[[nodiscard]] std::vector<ChannelColumn> with_sizes(const std::vector<ChannelColumn>& columns);

}  // namespace polhode
