// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/study/certify.hpp>

namespace polhode {

/// A certificate as an SVG picture: for each quantity its value with the error bar as a band, the
/// bar itself beside the error of the model's own step, and the observed order, over time. Time in
/// which nothing converges is shaded. The first kMaxPictured quantities are drawn.
[[nodiscard]] std::string certificate_svg(const Certificate& certificate);

inline constexpr std::size_t kMaxPictured = 40;

}  // namespace polhode
