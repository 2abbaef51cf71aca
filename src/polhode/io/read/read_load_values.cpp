// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <Eigen/Cholesky>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_load_values.hpp>

namespace polhode::io {

std::optional<Mat6> read_stiffness_matrix(ReadContext& context, Section& section,
                                          const std::string& key, const SourceNode& node) {
  const auto fault = [&](const std::string& what, const char* hint) {
    section.fault(key, what, hint);
  };
  if (!node.is_list() || node.children.size() != 6) {
    fault("expects six rows of six numbers", "Write [[..., ...], ...].");
    return std::nullopt;
  }
  Mat6 M;
  const Field number{.name = key, .meaning = "A number."};
  for (int i = 0; i < 6; ++i) {
    const SourceNode& row = node.children[static_cast<std::size_t>(i)];
    if (!row.is_list() || row.children.size() != 6) {
      fault(format("row {} has not six numbers", i + 1), "Write [[..., ...], ...].");
      return std::nullopt;
    }
    for (int j = 0; j < 6; ++j) {
      const auto value = read_number(context, row.children[static_cast<std::size_t>(j)],
                                     section.path(key), number);
      if (!value) return std::nullopt;
      M(i, j) = *value;
    }
  }
  const double size = M.cwiseAbs().maxCoeff();
  if ((M - M.transpose()).cwiseAbs().maxCoeff() > 1e-9 * size) {
    fault("is not symmetric", "Only a symmetric matrix has a potential.");
    return std::nullopt;
  }
  if (M.ldlt().vectorD().minCoeff() < -1e-9 * size) {
    fault("is not positive semidefinite, so it has no bounded energy", "Check its signs.");
    return std::nullopt;
  }
  return 0.5 * (M + M.transpose());
}

void check_resistance(Section& section, const std::string& key, const TimeFunction& law) {
  for (int k = -40; k <= 20; ++k)
    for (const double sign : {-1.0, 1.0}) {
      const double v = sign * std::pow(10.0, 0.1 * k), force = law(v);
      if (force * v >= -1e-12 * std::abs(v)) continue;
      section.fault(key,
                    format("is {} at v = {}: a damper must not add energy", shown(force), shown(v)),
                    "Give a force with the sign of v.");
      return;
    }
}

}  // namespace polhode::io
