// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/io/results/hdf5_file.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/results/write_results.hpp>

namespace polhode::io {

/// Path of a data set in a group.
[[nodiscard]] inline std::string join(const std::string& group, const std::string& name) {
  return group + "/" + name;
}

/// A per-body or per-joint quantity: its name in the file, entries of one body, unit.
struct StoredQuantity {
  const char* name;
  std::size_t size;
  const char* unit;
};
/// Plan of a results file: stored channels, and their named views.
struct FilePlan {
  std::vector<Channel> channels;
  std::vector<ChannelView> views;

  void add(const std::string& group, const StoredQuantity& q, std::vector<std::size_t> dims,
           bool integer = false) {
    channels.push_back({join(group, q.name), std::move(dims), q.unit, integer});
  }
  /// Adds quantities of `rows` objects each.
  void add_all(const std::string& group, std::span<const StoredQuantity> quantities,
               std::size_t rows) {
    for (const StoredQuantity& q : quantities) {
      std::vector<std::size_t> dims{rows};
      if (q.size > 1) dims.push_back(q.size);
      add(group, q, std::move(dims));
    }
  }
  void view(const char* group, const std::string& owner, const StoredQuantity& q, std::size_t first,
            std::size_t count, bool squeeze) {
    views.push_back(
        {format("{}/{}/{}", group, owner, q.name), channels.size() - 1, first, count, squeeze});
  }
};

/// Path of a part of a solid in the file.
[[nodiscard]] inline std::string part(const std::string& solid, const std::string& name) {
  return format("{}/{}/{}", results::kSolids, solid, name);
}

/// Channels in the order in which list_numbers() lists the numbers.
[[nodiscard]] FilePlan plan_results(const ResultsLayout& layout);

/// Appends the numbers of a frame, channel after channel.
void list_numbers(const ResultsFrame& frame, std::vector<double>& numbers);

/// Constant parts of results: names, numbers and meshes, by path.
struct FixedData {
  std::vector<std::pair<std::string, std::vector<std::string>>> names;
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> numbers;
  std::vector<std::pair<std::string, std::vector<Vec3>>> vectors;  ///< [m]
};
[[nodiscard]] FixedData fixed_data(const ResultsLayout& layout);

}  // namespace polhode::io
