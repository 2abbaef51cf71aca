// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/mesh/xml_tags.hpp>

namespace polhode::solids {

/// Encoding of numbers in a VTK file.
struct VtkEncoding {
  bool big_endian = false;
  bool wide_header = false;  ///< UInt64 instead of UInt32.
  bool compressed = false;   ///< By zlib.
  std::size_t appended = 0;  ///< First byte of the appended data, 0 if there is none.
  bool appended_base64 = false;
};

/// One DataArray of a VTK file.
struct VtkArray {
  std::string name;
  int components = 1;
  bool whole = false;  ///< Integers; otherwise floating point.
  std::vector<std::int64_t> integers;
  std::vector<double> reals;

  [[nodiscard]] std::size_t size() const { return whole ? integers.size() : reals.size(); }
};

/// Reads the array of a DataArray tag that has just been read, up to its closing tag.
/// @param count  Required number of values.
/// @throws InputError for another number of values, unknown types, and data that cannot be decoded.
[[nodiscard]] VtkArray read_vtk_array(MeshCursor& in, XmlTags& xml, const XmlTag& tag,
                                      const VtkEncoding& encoding, std::size_t count);

}  // namespace polhode::solids
