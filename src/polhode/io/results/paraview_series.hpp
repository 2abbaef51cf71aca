// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace polhode {

/// Files of one kind over time, and the list of them that ParaView opens: <name>.pvd lists the
/// times, <name>/<number>.<extension> holds one of them.
///
/// Every file is whole before the .pvd names it, and the .pvd is replaced at once, so that a run
/// that was killed leaves readable files.
class ParaviewSeries {
 public:
  /// @param extension  Of the files, e.g. vtp.
  /// @param keep       Continue existing files: times up to that one stay listed.
  /// @throws FileError
  ParaviewSeries(std::string folder, std::string name, std::string extension,
                 std::optional<double> keep = std::nullopt);

  /// Adds the whole content of one file. @throws FileError
  void append(double t, const std::string& bytes);
  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  void close() { write_list(); }  ///< @throws FileError

 private:
  void write_list();
  [[nodiscard]] std::string file(std::size_t frame) const;

  std::string folder_, name_, extension_;
  std::vector<double> times_;
  double next_listing_ = 0.0;  ///< Seconds of the steady clock.
};

/// The parts of a VTK file in XML whose numbers stand behind the text, as they lie in memory.
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
  /// Names as field data that readers without texts take too, such as meshio: a number called
  /// "solid bush" for each, its index.
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

}  // namespace polhode
