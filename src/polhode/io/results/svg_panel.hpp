// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace polhode::io {

/// A line of text. @param style  Class of the style sheet, see svg_page().
[[nodiscard]] std::string svg_text(double x, double y, const std::string& text,
                                   const char* style = "text");

/// A complete picture of that size in pixels, with the style sheet of panels.
[[nodiscard]] std::string svg_page(double width, double height, const std::string& content);

/// A diagram with axes, ticks and a title in an SVG picture.
class SvgPanel {
 public:
  struct Box {
    double x, y, width, height;  ///< Of the area of curves [pixel].
  };
  /// @param decades  The values drawn are logarithms to base ten: ticks say 1e-3.
  SvgPanel(const Box& box, double x_low, double x_high, double y_low, double y_high,
           const std::string& title, bool decades = false);

  /// Draws a curve, interrupted at points that are not finite and clipped.
  void curve(const std::vector<double>& x, const std::vector<double>& y, const char* colour,
             bool dashed = false);
  /// Marks points, as those of a curve that were computed.
  void points(const std::vector<double>& x, const std::vector<double>& y, const char* colour);
  /// Fills the area between two curves.
  void band(const std::vector<double>& x, const std::vector<double>& low,
            const std::vector<double>& high, const char* colour);
  /// Shades the full height from one x to another.
  void shade(double from, double to, const char* colour);
  /// Draws a horizontal line.
  void level(double y, const char* colour);
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] double px(double x) const;
  [[nodiscard]] double py(double y) const;

  Box box_;
  double x_low_, x_high_, y_low_, y_high_;
  std::string axes_, behind_, curves_;
};

/// Ticks at round numbers within a range, at most some `count` of them, but three at least.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);

}  // namespace polhode::io
