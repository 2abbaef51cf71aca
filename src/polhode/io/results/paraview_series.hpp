// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace polhode::io {

/// Series of files over time, and their list for ParaView: <name>.pvd lists the times,
/// <name>/<number>.<extension> contains one of them.
///
/// Every file is complete before the .pvd names it, and the .pvd is replaced atomically, so that a
/// killed run leaves readable files.
class ParaviewSeries {
 public:
  /// @param extension  Of the files, e.g. vtp.
  /// @param keep       Continue existing files: times up to that one stay listed.
  /// @throws FileError
  ParaviewSeries(std::string folder, std::string name, std::string extension,
                 std::optional<double> keep = std::nullopt);

  /// Adds one complete file. @throws FileError
  void append(double t, const std::string& bytes);
  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  /// Time of the last file; nothing if there is none.
  [[nodiscard]] std::optional<double> last_time() const {
    return times_.empty() ? std::nullopt : std::optional(times_.back());
  }
  void sync();  ///< Waits until the disk has all files and their list. @throws FileError
  void close() { write_list(false); }  ///< @throws FileError

 private:
  void write_list(bool durable);
  [[nodiscard]] std::string file(std::size_t frame) const;

  std::string folder_, name_, extension_;
  std::vector<double> times_;
  std::size_t synced_ = 0;     ///< Files that the disk has.
  double next_listing_ = 0.0;  ///< Seconds of the steady clock.
};

/// A VTK file in XML with appended raw numbers.
class VtkFile {
 public:
  /// @param type  PolyData or UnstructuredGrid.
  explicit VtkFile(std::string type) : type_(std::move(type)) {}

  void text(const std::string& xml) { xml_ += xml; }
  template <class T>
  void array(const char* name, int components, const std::vector<T>& values) {
    entry(type_name(T{}), name, components);
    const std::uint64_t length = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
    bytes_.append(reinterpret_cast<const char*>(values.data()), length);
  }
  /// Names as field data: character codes, each text ended by 0.
  void names(const char* name, const std::vector<std::string>& values);
  /// Names as field data for readers without texts, such as meshio: a number called "solid bush"
  /// for each, its index.
  void indices(const char* kind, const std::vector<std::string>& names);
  /// The whole file.
  [[nodiscard]] std::string bytes() const;

 private:
  static const char* type_name(float) { return "Float32"; }
  static const char* type_name(std::int32_t) { return "Int32"; }
  static const char* type_name(std::int64_t) { return "Int64"; }
  static const char* type_name(std::uint8_t) { return "UInt8"; }
  void entry(const char* type, const char* name, int components);

  std::string type_, xml_, bytes_;
};

}  // namespace polhode::io
