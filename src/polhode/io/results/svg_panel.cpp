// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/svg_panel.hpp>

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/xml_text.hpp>

namespace polhode::io {

namespace {

/// Distance outside its panel at which a curve is clipped [pixel].
constexpr double kMargin = 50.0;
constexpr double kClose = 0.5;
/// Ticks without which an axis has no scale.
constexpr std::size_t kFewestTicks = 3;

}  // namespace

std::string svg_text(double x, double y, const std::string& text, const char* style) {
  return format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>\n", x, y, style,
                xml_text(text));
}

std::string svg_page(double width, double height, const std::string& content) {
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
             "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<style>\n"
             "text {{ font-family: sans-serif; font-size: 11px; fill: #222; }}\n"
             ".head {{ font-size: 17px; font-weight: bold; }}\n"
             ".name {{ font-size: 13px; font-weight: bold; }}\n"
             ".right {{ text-anchor: end; }}\n.middle {{ text-anchor: middle; }}\n"
             ".tick {{ stroke: #e4e4e4; stroke-width: 1; }}\n"
             ".frame {{ fill: none; stroke: #888; stroke-width: 1; }}\n"
             ".curve {{ fill: none; stroke-width: 1.4; stroke-linejoin: round; }}\n"
             "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
             width, height) +
         content + "</svg>\n";
}

std::vector<double> round_ticks(double low, double high, int count) {
  const double rough = (high - low) / std::max(1, count);
  if (!(rough > 0.0) || !std::isfinite(rough)) return {low};
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  std::vector<double> ticks;
  // The longest step that is short enough; a shorter one where it leaves too few to read a scale.
  for (const double factor : {10.0, 5.0, 2.0, 1.0, 0.5}) {
    const double step = factor * decade;
    if (step < rough * (1.0 - 1e-9) && ticks.size() >= kFewestTicks) break;
    ticks.clear();
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
      ticks.push_back(k * step);
  }
  return ticks;
}

SvgPanel::SvgPanel(const Box& box, double x_low, double x_high, double y_low, double y_high,
                   const std::string& title, bool decades)
    : box_(box), x_low_(x_low), x_high_(x_high), y_low_(y_low), y_high_(y_high) {
  if (!(x_high_ > x_low_)) x_high_ = x_low_ + 1.0;
  if (!(y_high_ > y_low_)) {
    const double room = y_low_ == 0.0 ? 1.0 : 0.1 * std::abs(y_low_);
    y_low_ -= room;
    y_high_ += room;
  }
  const double bottom = box.y + box.height, right = box.x + box.width;
  const auto line = [&](double x1, double y1, double x2, double y2) {
    axes_ +=
        format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"tick\"/>\n",
               x1, y1, x2, y2);
  };
  for (const double x : round_ticks(x_low_, x_high_, 5)) {
    line(px(x), box.y, px(x), bottom);
    axes_ +=
        svg_text(px(x), bottom + 14, format("{:.6g}", std::abs(x) < 1e-300 ? 0.0 : x), "middle");
  }
  for (const double y : round_ticks(y_low_, y_high_, 4)) {
    if (decades && y != std::round(y)) continue;
    const double size = std::abs(y) < 1e-9 * (y_high_ - y_low_) ? 0.0 : y;
    line(box.x, py(y), right, py(y));
    axes_ += svg_text(box.x - 5, py(y) + 4,
                      decades ? format("1e{:.0f}", size) : format("{:.4g}", size), "right");
  }
  axes_ += svg_text(box.x, box.y - 6, title);
}

double SvgPanel::px(double x) const {
  return box_.x + box_.width * (x - x_low_) / (x_high_ - x_low_);
}

double SvgPanel::py(double y) const {
  const double p = box_.y + box_.height * (y_high_ - y) / (y_high_ - y_low_);
  return std::clamp(p, box_.y - kMargin, box_.y + box_.height + kMargin);
}

void SvgPanel::curve(const std::vector<double>& x, const std::vector<double>& y, const char* colour,
                     bool dashed) {
  std::string path;
  double at_x = 0.0, at_y = 0.0;
  bool open = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(y[i])) {
      open = false;
      continue;
    }
    // Points closer than half a pixel are skipped.
    const bool last = i + 1 == x.size() || i + 1 == y.size() || !std::isfinite(y[i + 1]);
    if (open && !last && std::hypot(px(x[i]) - at_x, py(y[i]) - at_y) < kClose) continue;
    at_x = px(x[i]);
    at_y = py(y[i]);
    path += format("{}{:.1f} {:.1f} ", open ? "L" : "M", at_x, at_y);
    open = true;
  }
  if (path.empty()) return;
  curves_ += format("<path d=\"{}\" class=\"curve\" stroke=\"{}\"{}/>\n", path, colour,
                    dashed ? " stroke-dasharray=\"5 3\"" : "");
}

void SvgPanel::points(const std::vector<double>& x, const std::vector<double>& y,
                      const char* colour) {
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (std::isfinite(y[i]))
      curves_ += format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2\" fill=\"{}\"/>\n", px(x[i]),
                        py(y[i]), colour);
}

void SvgPanel::band(const std::vector<double>& x, const std::vector<double>& low,
                    const std::vector<double>& high, const char* colour) {
  std::string there, back;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(low[i]) || !std::isfinite(high[i])) continue;
    there += format("{}{:.1f} {:.1f} ", there.empty() ? "M" : "L", px(x[i]), py(low[i]));
    back = format("L{:.1f} {:.1f} ", px(x[i]), py(high[i])) + back;
  }
  if (there.empty()) return;
  behind_ += format("<path d=\"{}{}Z\" fill=\"{}\" fill-opacity=\"0.25\"/>\n", there, back, colour);
}

void SvgPanel::shade(double from, double to, const char* colour) {
  behind_ +=
      format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
             px(from), box_.y, px(to) - px(from), box_.height, colour);
}

void SvgPanel::level(double y, const char* colour) {
  if (y < y_low_ || y > y_high_) return;
  curves_ += format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
      "stroke-dasharray=\"2 3\"/>\n",
      box_.x, py(y), box_.x + box_.width, py(y), colour);
}

std::string SvgPanel::text() const {
  const std::string clip = format("c{:.0f}-{:.0f}", box_.x, box_.y);
  const std::string area = format("x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"",
                                  box_.x, box_.y, box_.width, box_.height);
  return format("<clipPath id=\"{}\"><rect {}/></clipPath>\n", clip, area) + axes_ +
         format("<g clip-path=\"url(#{})\">\n", clip) + behind_ + curves_ +
         format("</g>\n<rect {} class=\"frame\"/>\n", area);
}

}  // namespace polhode::io
