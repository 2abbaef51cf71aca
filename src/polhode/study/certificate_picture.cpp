// SPDX-License-Identifier: Apache-2.0
#include <polhode/study/certificate_picture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/core/xml_text.hpp>
#include <polhode/io/results/svg_panel.hpp>

namespace polhode {

namespace {

constexpr double kWidth = 1180.0, kTop = 92.0, kRow = 200.0, kHigh = 118.0;
constexpr std::array<const char*, 3> kColours = {"#1f5fa8", "#c8641b", "#2d8a4e"};
constexpr const char* kBar = "#1f5fa8";
constexpr const char* kOwn = "#888888";
constexpr const char* kLost = "#f6d9d5";
constexpr double kMaxDecades = 12.0;

/// Lowest and highest finite value.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double y) {
    if (!std::isfinite(y)) return;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  /// Range with a margin, or 0 to 1 if it is empty.
  [[nodiscard]] Range roomy() const {
    if (!(high >= low)) return {0.0, 1.0};
    const double room = 0.06 * (high - low);
    return {low - room, high + room};
  }
};

std::vector<double> column(const Mat& m, Eigen::Index c) {
  return {m.col(c).begin(), m.col(c).end()};
}

std::vector<double> logarithms(const std::vector<double>& values) {
  std::vector<double> logs;
  for (const double x : values)
    logs.push_back(x > 0.0 ? std::log10(x) : -std::numeric_limits<double>::infinity());
  return logs;
}

/// Position of a quantity, and common data of its panels.
struct Row {
  const CertifiedQuantity& q;
  double y, duration;

  [[nodiscard]] io::SvgPanel::Box box(double x, double width) const {
    return {x, y + 46, width, kHigh};
  }
  void shade(io::SvgPanel& panel) const {
    if (q.report.lost_from) panel.shade(*q.report.lost_from, duration, kLost);
  }
};

std::string value_panel(const Row& row) {
  const CertifiedQuantity& q = row.q;
  const Mat& fine = q.series.values[2];
  Range range;
  for (Eigen::Index c = 0; c < fine.cols(); ++c)
    for (const double y : fine.col(c)) range.add(y);
  range = range.roomy();
  io::SvgPanel panel(row.box(70, 380), 0.0, row.duration, range.low, range.high,
                     format("value [{}], with its error bar", q.unit));
  row.shade(panel);
  for (Eigen::Index c = 0; c < fine.cols(); ++c) {
    const std::vector<double> y = column(fine, c);
    const char* colour = kColours[static_cast<std::size_t>(c) % kColours.size()];
    std::vector<double> low = y, high = y;
    for (std::size_t i = 0; i < y.size(); ++i) {
      low[i] -= q.report.bar[i];
      high[i] += q.report.bar[i];
    }
    panel.band(q.series.t, low, high, colour);
    panel.curve(q.series.t, y, colour);
  }
  std::string text = panel.text();
  for (std::size_t c = q.columns.size(); c-- > 0;)
    text += format(
        "<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"right\" fill=\"{}\" "
        "style=\"fill:{}\">{}</text>\n",
        450.0 - 62.0 * static_cast<double>(q.columns.size() - 1 - c), row.y + 40,
        kColours[c % kColours.size()], kColours[c % kColours.size()], xml_text(q.columns[c]));
  return text;
}

std::string bar_panel(const Row& row) {
  const CertifiedQuantity& q = row.q;
  const std::vector<double> bar = logarithms(q.report.bar);
  std::vector<double> own;
  for (Eigen::Index i = 0; i < q.series.own_values().rows(); ++i)
    own.push_back((q.series.own_values().row(i) - q.series.values[2].row(i)).norm());
  own = logarithms(own);
  Range range;
  for (const double y : bar) range.add(y);
  for (const double y : own) range.add(y);
  range = range.roomy();
  range.low = std::floor(std::max(range.low, range.high - kMaxDecades));
  range.high = std::max(std::ceil(range.high), range.low + 1.0);
  io::SvgPanel panel(row.box(535, 330), 0.0, row.duration, range.low, range.high,
                     format("error bar [{}]; grey: from the coarse to the fine run", q.unit), true);
  row.shade(panel);
  panel.curve(q.series.t, own, kOwn, true);
  panel.curve(q.series.t, bar, kBar);
  return panel.text();
}

std::string order_panel(const Row& row, const std::vector<double>& orders) {
  const double most = *std::max_element(orders.begin(), orders.end());
  io::SvgPanel panel(row.box(930, 220), 0.0, row.duration, -1.0, most + 2.0,
                     "observed order; dotted: of the method");
  row.shade(panel);
  for (const double order : orders) panel.level(order, "#c8641b");
  panel.curve(row.q.series.t, row.q.report.order_at, kBar);
  return panel.text();
}

std::string verdict(const CertifiedQuantity& q) {
  const ConvergenceReport& r = q.report;
  std::string text = "order " + q.order_text();
  if (!r.lost_from || *r.lost_from > q.series.t.front())
    text += format(", error bar {:.2g} {}, of the model's own step {:.2g} {}", r.largest_bar,
                   q.unit, r.largest_own, q.unit);
  if (r.lost_from) text += format(", does not converge from {:.4g} s on", *r.lost_from);
  return text;
}

}  // namespace

std::string certificate_svg(const Certificate& certificate) {
  const std::size_t count = std::min(certificate.quantities.size(), kMaxPictured);
  std::string text =
      io::svg_text(30, 32, certificate.title.empty() ? "Certificate" : certificate.title, "head");
  std::string runs = certificate.automatic ? "tolerance " : "step ";
  for (std::size_t k = 0; k < 3; ++k)
    runs += format("{}{:.3g}{} ({} steps)", k == 0 ? "" : ", ", certificate.runs[k].setting,
                   certificate.automatic ? "" : " s", certificate.runs[k].summary.steps);
  text += io::svg_text(30, 54, runs + ". Time in seconds.");
  text += io::svg_text(30, 72,
                       certificate.quantities.size() > count
                           ? format("The first {} of {} quantities. Red: no convergence.", count,
                                    certificate.quantities.size())
                           : "Red: no convergence.");
  for (std::size_t k = 0; k < count; ++k) {
    const CertifiedQuantity& q = certificate.quantities[k];
    const Row row{q, kTop + kRow * static_cast<double>(k), certificate.duration};
    text +=
        io::svg_text(30, row.y + 18, format("{} [{}]: {}", q.name(), q.unit, verdict(q)), "name");
    text += value_panel(row) + bar_panel(row) + order_panel(row, certificate.orders);
  }
  return io::svg_page(kWidth, kTop + kRow * static_cast<double>(count) + 10, text);
}

}  // namespace polhode
