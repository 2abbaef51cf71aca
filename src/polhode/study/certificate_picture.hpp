// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/study/certify.hpp>

namespace polhode {

/// A certificate as an SVG picture: for each quantity its value with the error bar as a band, the
/// bar itself together with the error of the model's own step, and the observed order, over time.
/// Times without convergence are shaded. The first kMaxPictured quantities are drawn.
[[nodiscard]] std::string certificate_svg(const Certificate& certificate);

inline constexpr std::size_t kMaxPictured = 40;

}  // namespace polhode
