// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace polhode::io {

/// Reader of a results file, also of a running, killed or truncated run.
///
/// A truncated file, after an interrupted copy or on a full disk, is read up to its last complete
/// frame: a sparse copy of the full length is opened instead, and frames with chunks beyond the cut
/// are left out. Numbers and lists are compared with their checksums, if the file has them.
class ResultsReader {
 public:
  /// A quantity with one entry per frame.
  struct DataSet {
    std::string path;
    std::vector<std::size_t> dims;  ///< Shape of one frame's entry; empty: a number.
    std::string unit;
    [[nodiscard]] std::size_t size() const;  ///< Numbers in one frame's entry.
  };

  /// @throws FileError if the file cannot be read or is no results file of a known version.
  explicit ResultsReader(const std::string& path);
  ~ResultsReader();
  ResultsReader(ResultsReader&&) noexcept;

  [[nodiscard]] std::size_t frames() const;  ///< Complete ones.
  [[nodiscard]] bool cut_short() const;      ///< The file is truncated.
  /// Warning about a truncated file; empty for others.
  [[nodiscard]] std::string cut_text() const;
  /// Path of the file that was opened: the given one, or a temporary copy of the full length that
  /// is removed with this reader.
  [[nodiscard]] const std::string& opened_path() const;
  /// All stored quantities, in the order of their paths, without named views.
  [[nodiscard]] const std::vector<DataSet>& data_sets() const;
  [[nodiscard]] const DataSet* find(const std::string& path) const;
  [[nodiscard]] bool has(const std::string& path) const;
  /// Refuses a file whose lists do not fit each other. @throws FileError
  [[noreturn]] void refuse(const std::string& what) const;

  /// Reads frames 0, every, 2 every, ... of a quantity, consecutively. @throws FileError
  [[nodiscard]] std::vector<double> read(const std::string& path, std::size_t every = 1) const;
  /// A constant list of names; empty if there is none. @throws FileError
  [[nodiscard]] std::vector<std::string> names(const std::string& path) const;
  [[nodiscard]] std::vector<std::int64_t> numbers(const std::string& path) const;
  /// A constant list of vectors, consecutively.
  [[nodiscard]] std::vector<double> vectors(const std::string& path) const;
  /// Text of an attribute; empty if there is none.
  [[nodiscard]] std::string attribute(const std::string& group, const std::string& name) const;
  /// Names of the groups in a group.
  [[nodiscard]] std::vector<std::string> groups(const std::string& path) const;

 private:
  struct Impl;
  struct Once {};
  ResultsReader(const std::string& path, Once attempt);
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode::io
