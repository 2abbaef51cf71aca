// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/io/text/source_tree.hpp>

namespace polhode::io {

/// Makes values of a model file that stand at a line of another file. Numbers are written so that
/// they are read with the same bits.
struct NodeBuilder {
  int line = 0;

  [[nodiscard]] SourceNode text(const std::string& value) const;
  [[nodiscard]] SourceNode number(double value) const;
  [[nodiscard]] SourceNode boolean(bool value) const;
  [[nodiscard]] SourceNode vector(const Vec3& value) const;
  /// A letter if it is an axis, else three numbers.
  [[nodiscard]] SourceNode direction(const Vec3& value) const;
  [[nodiscard]] SourceNode list(std::vector<SourceNode> values = {}) const;
  [[nodiscard]] SourceNode map() const;
  /// {quaternion: [w, x, y, z]}.
  [[nodiscard]] SourceNode orientation(const Quat& value) const;
  /// {xx: , yy: , zz: , xy: , xz: , yz: }, without products that are zero.
  [[nodiscard]] SourceNode inertia(const Mat3& value) const;
  /// Adds a key to a map, and returns its value.
  SourceNode& put(SourceNode& map, const std::string& key, SourceNode value) const;
};

/// The nearest name that is allowed in a model file: other characters than letters, digits, '_' and
/// '-' become '_'.
[[nodiscard]] std::string allowed_name(const std::string& name);

}  // namespace polhode::io
