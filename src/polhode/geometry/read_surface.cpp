// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/input_file.hpp>
#include <polhode/geometry/read_collada.hpp>
#include <polhode/geometry/read_surface.hpp>

namespace polhode::geometry {
namespace {

constexpr const char* kExportAgain = "Export the file again from the program that made it";

/// Words of a text file, with the current line.
class Words {
 public:
  Words(const std::string& name, std::string_view text) : name_(name), text_(text) {}

  /// Moves to the next line that is not empty; false at the end of the file.
  bool next_line() {
    while (begin_ < text_.size()) {
      std::size_t end = text_.find_first_of("\r\n", begin_);
      if (end == std::string_view::npos) end = text_.size();
      line_ = text_.substr(begin_, end - begin_);
      begin_ = end + 1;
      if (end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n') ++begin_;
      ++number_;
      if (line_.find_first_not_of(" \t") != std::string_view::npos) return true;
    }
    line_ = {};
    return false;
  }

  /// Next word of the current line; empty at its end.
  std::string_view word() {
    const std::size_t begin = line_.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    line_.remove_prefix(begin);
    const std::string_view found = line_.substr(0, line_.find_first_of(" \t"));
    line_.remove_prefix(found.size());
    return found;
  }

  /// Next word, in lower case.
  std::string keyword() {
    std::string lower(word());
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
  }

  Vec3 point() {
    Vec3 x;
    for (double& coordinate : x) {
      std::string_view digits = word();
      if (digits.empty()) refuse("a point has three coordinates, but fewer are given");
      const std::string_view given = digits;
      if (digits.front() == '+') digits.remove_prefix(1);
      const auto [end, error] =
          std::from_chars(digits.data(), digits.data() + digits.size(), coordinate);
      if (error != std::errc() || end != digits.data() + digits.size() ||
          !std::isfinite(coordinate))
        refuse(format("'{}' is not a finite number", given.substr(0, 40)));
    }
    return x;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(format("{}:{}", name_, number_), what, kExportAgain);
  }

 private:
  const std::string& name_;
  std::string_view text_;
  std::string_view line_;
  std::size_t begin_ = 0;
  int number_ = 0;
};

// STL.

constexpr std::size_t kHeader = 80;    // bytes of text before the count of triangles
constexpr std::size_t kTriangle = 50;  // normal, three corners, two spare bytes
constexpr std::size_t kPreamble = kHeader + 4;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

TriangleSurface parse_binary_stl(const std::string& name, std::string_view bytes) {
  const std::size_t count = little_endian(bytes, kHeader);
  const std::size_t present = (bytes.size() - kPreamble) / kTriangle;
  if (present < count)
    throw InputError(
        name,
        format(
            "the file is cut short: it declares {} triangles, but ends after {} ({} of {} bytes)",
            count, present, bytes.size(), kPreamble + kTriangle * count),
        kExportAgain);
  TriangleSurface surface;
  surface.points.reserve(3 * count);
  surface.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int first = static_cast<int>(surface.points.size());
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t at = kPreamble + kTriangle * i + 12 * (1 + corner);
      Vec3 x;
      for (std::size_t k = 0; k < 3; ++k)
        x[static_cast<Eigen::Index>(k)] = std::bit_cast<float>(little_endian(bytes, at + 4 * k));
      if (!x.allFinite())
        throw InputError(
            format("{}: triangle {}", name, i + 1),
            format("corner {} has a coordinate that is not a finite number", corner + 1),
            kExportAgain);
      surface.points.push_back(x);
    }
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

TriangleSurface parse_text_stl(const std::string& name, std::string_view text) {
  TriangleSurface surface;
  Words words(name, text);
  bool in_solid = false;
  int corners = -1;  // of the current facet; −1 outside of one
  while (words.next_line()) {
    const std::string keyword = words.keyword();
    if (keyword == "solid") {
      if (in_solid) words.refuse("'solid' begins before the last solid has ended");
      in_solid = true;
    } else if (keyword == "facet") {
      if (!in_solid || corners >= 0) words.refuse("'facet' is out of place");
      corners = 0;
    } else if (keyword == "vertex") {
      if (corners < 0 || corners > 2)
        words.refuse(corners < 0 ? "'vertex' is outside of a facet"
                                 : "a facet has more than three corners");
      surface.points.push_back(words.point());
      ++corners;
    } else if (keyword == "endfacet") {
      if (corners != 3)
        words.refuse(format("a facet has three corners, but {} are given", std::max(corners, 0)));
      const int last = static_cast<int>(surface.points.size());
      surface.triangles.push_back({last - 3, last - 2, last - 1});
      corners = -1;
    } else if (keyword == "endsolid") {
      if (!in_solid || corners >= 0) words.refuse("'endsolid' is out of place");
      in_solid = false;
    } else if (keyword != "outer" && keyword != "endloop") {
      words.refuse(format("'{}' is not a word of an STL file", keyword.substr(0, 40)));
    }
  }
  if (in_solid)
    words.refuse(format("the file is cut short: it ends after {} triangles without 'endsolid'",
                        surface.triangles.size()));
  return surface;
}

TriangleSurface parse_stl(const std::string& name, std::string_view bytes) {
  // Some programs begin a binary file with "solid" too, so the size is checked first.
  const bool has_count = bytes.size() >= kPreamble;
  if (has_count &&
      bytes.size() == kPreamble + kTriangle * std::size_t(little_endian(bytes, kHeader)))
    return parse_binary_stl(name, bytes);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  const bool text = begin != std::string_view::npos && bytes.substr(begin, 5) == "solid" &&
                    bytes.substr(0, 1024).find('\0') == std::string_view::npos;
  if (text) return parse_text_stl(name, bytes);
  if (!has_count)
    throw InputError(name,
                     format("the file has {} bytes and is no STL file: the text form begins with "
                            "'solid', the binary form has at least {} bytes",
                            bytes.size(), kPreamble),
                     kExportAgain);
  return parse_binary_stl(name, bytes);
}

// OBJ.

/// Index of a corner "7", "7/1", "7//3" or "-1", counted from 0.
int obj_corner(const Words& words, std::string_view corner, std::size_t points) {
  const std::string_view digits = corner.substr(0, corner.find('/'));
  long long index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size() || index == 0)
    words.refuse(format("'{}' is not the number of a point", corner.substr(0, 40)));
  const long long count = static_cast<long long>(points);
  const long long from_zero = index > 0 ? index - 1 : count + index;
  if (from_zero < 0 || from_zero >= count)
    words.refuse(format("point {} is used, but {} points are defined above", index, count));
  return static_cast<int>(from_zero);
}

TriangleSurface parse_obj(const std::string& name, std::string_view text) {
  if (text.find('\0') != std::string_view::npos)
    throw InputError(name, "the file is not text, so it is no OBJ file", kExportAgain);
  TriangleSurface surface;
  Words words(name, text);
  while (words.next_line()) {
    const std::string_view keyword = words.word();
    if (keyword == "v") {
      surface.points.push_back(words.point());
    } else if (keyword == "f") {
      std::vector<int> polygon;
      for (std::string_view corner = words.word(); !corner.empty() && corner.front() != '#';
           corner = words.word()) {
        if (corner == "\\") {  // continuation line
          if (!words.next_line()) words.refuse("the file is cut short: it ends within a face");
          continue;
        }
        polygon.push_back(obj_corner(words, corner, surface.points.size()));
      }
      if (polygon.size() < 3)
        words.refuse(format("a face has at least three corners, but {} are given", polygon.size()));
      for (std::size_t i = 2; i < polygon.size(); ++i)
        surface.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
    }
    // Normals, texture, groups, materials and lines are ignored.
  }
  return surface;
}

// MSH of MuJoCo: counts of points, normals, texture coordinates and triangles; then these.

constexpr std::size_t kCounts = 16;  // bytes

TriangleSurface parse_msh(const std::string& name, std::string_view bytes) {
  if (bytes.starts_with("$MeshFormat"))
    throw InputError(name, "the file is a mesh of Gmsh, and no surface of MuJoCo's format",
                     "Give it as the mesh of a solid, or export it as STL");
  std::array<std::size_t, 4> count{};
  for (std::size_t k = 0; k < 4 && bytes.size() >= kCounts; ++k)
    count[k] = little_endian(bytes, 4 * k);
  const auto [points, normals, coordinates, triangles] = count;
  const std::size_t size = kCounts + 12 * (points + normals + triangles) + 8 * coordinates;
  if (bytes.size() < kCounts || bytes.size() != size)
    throw InputError(name,
                     bytes.size() < kCounts
                         ? format("the file has {} bytes and is no MSH file", bytes.size())
                         : format("the file has {} bytes, but declares {} points and {} triangles, "
                                  "which are {} bytes",
                                  bytes.size(), points, triangles, size),
                     kExportAgain);
  TriangleSurface surface;
  surface.points.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    Vec3 x;
    for (std::size_t k = 0; k < 3; ++k)
      x[static_cast<Eigen::Index>(k)] =
          std::bit_cast<float>(little_endian(bytes, kCounts + 12 * i + 4 * k));
    if (!x.allFinite())
      throw InputError(format("{}: point {}", name, i + 1),
                       "has a coordinate that is not a finite number", kExportAgain);
    surface.points.push_back(x);
  }
  const std::size_t first = size - 12 * triangles;
  for (std::size_t i = 0; i < triangles; ++i) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t point = little_endian(bytes, first + 12 * i + 4 * k);
      if (point >= points)
        throw InputError(format("{}: triangle {}", name, i + 1),
                         format("point {} is used, but there are {} points", point, points),
                         kExportAgain);
      corners[k] = static_cast<int>(point);
    }
    surface.triangles.push_back(corners);
  }
  return surface;
}

std::string ending_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string ending = dot == std::string::npos ? "" : name.substr(dot);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

TriangleSurface parse_surface(const std::string& name, std::string_view bytes) {
  const std::string ending = ending_of(name);
  if (ending != ".stl" && ending != ".obj" && ending != ".msh" && ending != ".dae")
    throw InputError(name, format("a surface cannot be read from a file ending in '{}'", ending),
                     "Use .stl (text or binary), .obj, .dae, or .msh of MuJoCo");
  if (bytes.size() > std::size_t(std::numeric_limits<int>::max()))
    throw InputError(name, format("the file has {} bytes, which is too large", bytes.size()),
                     "Reduce the number of triangles");
  TriangleSurface surface = ending == ".stl"   ? parse_stl(name, bytes)
                            : ending == ".obj" ? parse_obj(name, bytes)
                            : ending == ".dae" ? parse_collada(name, bytes)
                                               : parse_msh(name, bytes);
  if (surface.triangles.empty()) throw InputError(name, "the file has no triangles", kExportAgain);
  join_equal_points(surface);
  return surface;
}

TriangleSurface read_surface(const std::string& path) {
  std::error_code no_matter;
  if (std::filesystem::is_directory(path, no_matter))
    throw InputError(path, "a directory is not a surface", "Name a .stl or .obj file in it");
  std::string bytes;
  if (const auto fault = read_input(path, bytes))
    throw InputError(path, "the file " + fault->what, fault->hint);
  return parse_surface(path, bytes);
}

}  // namespace polhode::geometry
