// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <polhode/io/results/hdf5_id.hpp>
#include <polhode/io/text/output_file.hpp>

namespace polhode {

/// Values at the points or cells of a grid: `width` numbers each, frame after frame. They are read
/// when they are written, so that only one field at a time is in memory.
struct VtkHdfField {
  std::string name, unit;
  std::size_t width = 1;
  std::function<std::vector<double>()> values{};
};

/// A grid with constant cells and moving points.
struct VtkHdfGrid {
  std::string name;
  std::size_t points = 0;
  std::function<std::vector<double>()> positions{};  ///< x, y, z of each point [m], each frame.
  std::vector<std::int64_t> connectivity, offsets{0};
  std::vector<std::uint8_t> types;  ///< VTK's number of each cell's shape.
  std::vector<VtkHdfField> point_data, cell_data;
  std::vector<std::pair<std::string, std::vector<double>>> fixed_cell_data;

  void add_cell(const std::vector<std::int64_t>& corners, std::uint8_t type) {
    connectivity.insert(connectivity.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

/// A file of the type "PartitionedDataSetCollection" that is being written; it gets its name when
/// it is complete.
class VtkHdfFile {
 public:
  /// @param times  Of the frames [s]. @throws FileError
  VtkHdfFile(std::string path, std::vector<double> times);
  ~VtkHdfFile();
  VtkHdfFile(const VtkHdfFile&) = delete;
  /// Adds a grid. A name that exists already gets an underscore appended. @throws FileError
  void add(const VtkHdfGrid& grid);
  [[nodiscard]] std::size_t grids() const { return names_.size(); }
  void close();  ///< @throws FileError

 private:
  void add_fields(hid_t grid, hid_t steps, const char* group,
                  const std::vector<VtkHdfField>& fields, std::size_t entries);

  std::string path_;
  io::UnfinishedFile unfinished_;
  std::vector<double> times_;
  io::hdf5::Id file_, root_, assembly_;
  std::set<std::string> names_;
};

}  // namespace polhode
