// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/feb_curves.hpp>

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using Powers = std::array<double, 6>;

/// Points that a curve written out as a table may have, and as one expression.
constexpr std::size_t kMostPoints = 100'000, kMostTerms = 60;
/// Straight lines for a piece of a curve with more terms than an expression may have.
constexpr int kLines = 16;
/// Part of a curve's length by which FEBio finds the slope at its ends.
constexpr double kSlopePart = 1e-3;

/// Line through two points, of the time since an origin.
Powers line(const std::array<double, 2>& a, const std::array<double, 2>& b, double origin) {
  const double slope = (b[1] - a[1]) / (b[0] - a[0]);
  return {a[1] + slope * (origin - a[0]), slope};
}

/// Parabola through three points, of the time since an origin.
Powers parabola(const std::array<double, 2>& a, const std::array<double, 2>& b,
                const std::array<double, 2>& c, double origin) {
  const double ab = (b[1] - a[1]) / (b[0] - a[0]), bc = (c[1] - b[1]) / (c[0] - b[0]);
  const double second = (bc - ab) / (c[0] - a[0]);
  const double ta = a[0] - origin, tb = b[0] - origin;
  return {a[1] - ab * ta + second * ta * tb, ab - second * (ta + tb), second};
}

/// The piece of a curve that ends at point n.
Powers piece_before(const FebCurve& curve, std::size_t n) {
  const auto& p = curve.points;
  const std::size_t last = p.size() - 1;
  const double origin = p[n - 1][0], length = p[n][0] - origin, rise = p[n][1] - p[n - 1][1];
  switch (curve.rule) {
    case FebCurve::Rule::step:
      return {p[n][1]};
    case FebCurve::Rule::smooth_step: {
      const double h3 = length * length * length;
      return {p[n - 1][1],
              0.0,
              0.0,
              10.0 * rise / h3,
              -15.0 * rise / (h3 * length),
              6.0 * rise / (h3 * length * length)};
    }
    case FebCurve::Rule::smooth:
      if (last == 1) break;
      if (n == 1) return parabola(p[0], p[1], p[2], origin);
      if (n == last) return parabola(p[n - 2], p[n - 1], p[n], origin);
      {
        // A parabola that goes over into another one.
        const Powers a = parabola(p[n - 2], p[n - 1], p[n], origin);
        const Powers b = parabola(p[n - 1], p[n], p[n + 1], origin);
        Powers blend = a;
        for (std::size_t k = 0; k < 3; ++k) blend[k + 1] += (b[k] - a[k]) / length;
        return blend;
      }
    case FebCurve::Rule::linear:
      break;
  }
  return line(p[n - 1], p[n], origin);
}

/// Polynomial of a piece in powers of the time since another instant.
FebPiece moved(FebPiece piece, double from) {
  Powers& c = piece.powers;
  const double shift = from - piece.from;
  for (std::size_t k = 0; k + 1 < c.size(); ++k)  // Repeated division by (t - shift).
    for (std::size_t j = c.size() - 1; j-- > k;) c[j] += shift * c[j + 1];
  piece.from = from;
  return piece;
}

/// A curve that is zero outside of a time.
std::vector<FebPiece> during(const FebWindow& window, const std::vector<FebPiece>& pieces,
                             double until) {
  std::vector<FebPiece> own;
  if (window.begin > 0.0) own.push_back({0.0, window.begin, {}});
  for (FebPiece piece : pieces) {
    if (piece.to <= window.begin || piece.from >= window.end) continue;
    own.push_back(between(piece, window.begin, window.end));
  }
  if (window.end < until) own.push_back({window.end, until, {}});
  return own;
}

bool is_flat(const FebPiece& piece, std::size_t from) {
  return std::all_of(piece.powers.begin() + static_cast<std::ptrdiff_t>(from), piece.powers.end(),
                     [](double c) { return c == 0.0; });
}

/// A polynomial of t as an expression.
std::string polynomial(const FebPiece& piece, double factor) {
  std::size_t degree = piece.powers.size() - 1;
  while (degree > 0 && piece.powers[degree] == 0.0) --degree;
  const std::string since = piece.from == 0.0 ? "t" : format("(t - ({}))", piece.from);
  std::string text = format("({})", factor * piece.powers[degree]);
  for (std::size_t k = degree; k-- > 0;)  // Horner's scheme.
    text = format("(({}) + {}*{})", factor * piece.powers[k], since, text);
  return text;
}

SourceNode table(const NodeBuilder& make, const std::vector<std::array<double, 2>>& points,
                 const char* interpolation) {
  SourceNode node = make.map(), list = make.list();
  for (const auto& p : points)
    list.children.push_back(make.list({make.number(p[0]), make.number(p[1])}));
  make.put(node, "table", std::move(list));
  make.put(node, "interpolation", make.text(interpolation));
  return node;
}

}  // namespace

double FebPiece::at(double t) const {
  double value = 0.0;
  for (std::size_t k = powers.size(); k-- > 0;) value = value * (t - from) + powers[k];
  return value;
}

FebPiece between(FebPiece piece, double begin, double end) {
  if (piece.from < begin) piece = moved(piece, begin);
  piece.to = std::min(piece.to, end);
  return piece;
}

std::vector<FebPiece> FebCurve::pieces(double until, std::size_t most) const {
  const auto& p = points;
  std::vector<FebPiece> own, all;
  for (std::size_t n = 1; n < p.size(); ++n)
    if (p[n][0] > p[n - 1][0]) own.push_back({p[n - 1][0], p[n][0], piece_before(*this, n)});
  if (own.empty()) return {{0.0, until, {p.front()[1]}}};
  const double begin = own.front().from, end = own.back().to, length = end - begin;
  const bool repeats = extend == Extend::repeat || extend == Extend::repeat_offset;
  const bool sloped =
      extend == Extend::extrapolate && rule != Rule::step && rule != Rule::smooth_step;
  if (repeats) {
    const double first = std::min(0.0, std::floor(-begin / length));
    const double last = std::max(0.0, std::ceil((until - end) / length));
    if (!((last - first + 1.0) * static_cast<double>(own.size()) <= static_cast<double>(most)))
      return {};
    for (double n = first; n <= last; ++n)
      for (FebPiece piece : own) {
        piece.from += n * length;
        piece.to += n * length;
        if (extend == Extend::repeat_offset) piece.powers[0] += n * (p.back()[1] - p.front()[1]);
        all.push_back(piece);
      }
    return all;
  }
  if (own.size() + 2 > most) return {};
  // FEBio's slope at an end is that over a thousandth of the curve.
  const double part = rule == Rule::linear ? own.front().to - begin : kSlopePart * length;
  const double part_end = rule == Rule::linear ? end - own.back().from : kSlopePart * length;
  if (begin > 0.0) {
    const double slope = sloped ? (own.front().at(begin + part) - p.front()[1]) / part : 0.0;
    all.push_back({0.0, begin, {p.front()[1] - slope * begin, slope}});
  }
  all.insert(all.end(), own.begin(), own.end());
  if (until > end) {
    const double slope = sloped ? (p.back()[1] - own.back().at(end - part_end)) / part_end : 0.0;
    all.push_back({end, until, {p.back()[1], slope}});
  }
  return all;
}

void FebCurves::read(const XmlFile::Element& section) {
  for (const XmlFile::Element* e : file_.xml.children(section, "load_controller")) {
    const auto id = file_.id(*e);
    const std::string type = file_.type(*e);
    file_.ignored.attributes(*e, {"name"});
    if (!id || *id > INT32_MAX || type.empty()) continue;
    const auto [found, is_new] = controllers_.try_emplace(static_cast<int>(*id));
    if (!is_new) {
      file_.xml.fault(*e, format("the load controller {} stands twice", *id), "Renumber one.");
      continue;
    }
    Controller& controller = found->second;
    controller.at = e;
    if (type == "loadcurve") {
      read_curve(*e, controller);
    } else if (type == "pid") {
      read_pid(*e, controller);
    } else if (type == "math") {
      std::string unknown;
      controller.math = expression_of_feb(file_.text(*e, "math"), unknown);
      controller.usable = !controller.math.empty();
      if (!controller.usable)
        file_.refuse(*e,
                     format("the load controller {} has {}, which is not known", *id,
                            unknown.empty() ? "no expression" : quote(unknown)),
                     "Write it with t, pi, + - * / ^, sin, cos, tan, exp, ln, sqrt, abs and H.");
    } else {
      file_.refuse(*e, format("a load controller of type {} is not read", quote(type)),
                   "Use a loadcurve, math or PID, or add a controller to the model.");
    }
  }
}

void FebCurves::read_curve(const XmlFile::Element& e, Controller& controller) {
  FebCurve& curve = controller.curve;
  const std::string rule = lower_case(file_.text(e, "interpolate"));
  const std::string extend = lower_case(file_.text(e, "extend"));
  controller.usable = true;
  const auto unknown = [&](const char* tag, const std::string& word) {
    file_.refuse(e, format("the <{}> {} of a load curve is not read", tag, quote(word)),
                 "Give more points with another one.");
    controller.usable = false;
  };
  if (rule.empty() || rule == "linear" || rule == "0")
    curve.rule = FebCurve::Rule::linear;
  else if (rule == "step" || rule == "1")
    curve.rule = FebCurve::Rule::step;
  else if (rule == "smooth" || rule == "2")
    curve.rule = FebCurve::Rule::smooth;
  else if (rule == "smooth step" || rule == "smooth_step")
    curve.rule = FebCurve::Rule::smooth_step;
  else
    return unknown("interpolate", rule);
  if (extend.empty() || extend == "constant" || extend == "0")
    curve.extend = FebCurve::Extend::constant;
  else if (extend == "extrapolate" || extend == "1")
    curve.extend = FebCurve::Extend::extrapolate;
  else if (extend == "repeat" || extend == "2")
    curve.extend = FebCurve::Extend::repeat;
  else if (extend == "repeat offset" || extend == "repeat_offset" || extend == "3")
    curve.extend = FebCurve::Extend::repeat_offset;
  else
    return unknown("extend", extend);
  if (const XmlFile::Element* points = file_.child(e, "points"))
    for (const XmlFile::Element* p : file_.children(*points))
      if (const auto two = file_.numbers(*p, 2, 2)) curve.points.push_back({(*two)[0], (*two)[1]});
  std::stable_sort(curve.points.begin(), curve.points.end(),
                   [](const auto& a, const auto& b) { return a[0] < b[0]; });
  const bool twice = std::adjacent_find(curve.points.begin(), curve.points.end(),
                                        [](const auto& a, const auto& b) {
                                          return a[0] == b[0];
                                        }) != curve.points.end();
  controller.usable = !curve.points.empty() && !(twice && curve.rule == FebCurve::Rule::smooth);
  if (!controller.usable)
    file_.xml.fault(e,
                    twice ? "a smooth curve has two points at one time" : "the curve has no points",
                    "Give points with increasing times.");
}

std::vector<std::array<double, 2>> FebCurves::points(int controller) const {
  const auto found = controllers_.find(controller);
  return found == controllers_.end() ? std::vector<std::array<double, 2>>()
                                     : found->second.curve.points;
}

SourceNode FebCurves::node(const FebValue& value, double factor) {
  const NodeBuilder make{value.at == nullptr ? 0 : file_.xml.line(*value.at)};
  if (value.is_zero() || (value.is_constant() && !window))
    return make.number(factor * value.factor);
  if (value.is_constant())
    return pieces_node(make, *value.at, {{0.0, until, {1.0}}}, factor * value.factor);
  const auto found = controllers_.find(*value.controller);
  if (found == controllers_.end()) {
    file_.xml.fault(*value.at, format("there is no load controller {}", *value.controller),
                    "Give the id of a load_controller.");
    return make.number(0.0);
  }
  const Controller& controller = found->second;
  if (!controller.usable) return make.number(0.0);  // An error, or left out, already.
  if (!controller.channel.empty()) return pid_node(make, value, factor * value.factor);
  if (controller.math.empty())
    return pieces_node(make, *controller.at, controller.curve.pieces(until, kMostPoints),
                       factor * value.factor);
  std::string product = format("({})*({})", factor * value.factor, controller.math);
  if (window) product += format("*pulse(t, {}, {})", window->begin, window->end);
  SourceNode text = make.text(product);
  text.in_quotes = true;
  return text;
}

SourceNode FebCurves::pieces_node(const NodeBuilder& make, const XmlFile::Element& at,
                                  std::vector<FebPiece> pieces, double scale) {
  // Pieces before the start, or after the end, have no influence.
  while (pieces.size() > 1 && pieces.front().to <= 0.0) pieces.erase(pieces.begin());
  while (pieces.size() > 1 && pieces.back().from >= until) pieces.pop_back();
  if (pieces.empty()) {
    file_.xml.fault(at, format("the load curve has more than {} points up to the end", kMostPoints),
                    "Give a longer period.");
    return make.number(0.0);
  }
  if (window) pieces = during(*window, pieces, until);
  const auto all_flat = [&](std::size_t from) {
    return std::all_of(pieces.begin(), pieces.end(),
                       [&](const FebPiece& p) { return is_flat(p, from); });
  };
  bool joined = true;
  double size = 0.0;
  for (const FebPiece& p : pieces)
    size = std::max({size, std::abs(p.powers[0]), std::abs(p.at(p.to))});
  for (std::size_t k = 1; k < pieces.size(); ++k)
    joined =
        joined && std::abs(pieces[k].powers[0] - pieces[k - 1].at(pieces[k].from)) <= 1e-14 * size;
  if (all_flat(1)) {
    std::vector<std::array<double, 2>> points;
    for (const FebPiece& p : pieces)
      if (points.empty() || scale * p.powers[0] != points.back()[1])
        points.push_back({p.from, scale * p.powers[0]});
    return points.size() == 1 ? make.number(points[0][1]) : table(make, points, "step");
  }
  const bool straight = all_flat(2);
  if (joined && (straight || pieces.size() > kMostTerms)) {
    std::vector<std::array<double, 2>> points;
    const int lines = straight ? 1 : kLines;
    for (const FebPiece& p : pieces)
      for (int k = 0; k < lines; ++k) {
        const double t = p.from + k * (p.to - p.from) / lines;
        if (points.empty() || t > points.back()[0]) points.push_back({t, scale * p.at(t)});
      }
    points.push_back({pieces.back().to, scale * pieces.back().at(pieces.back().to)});
    if (!straight)
      file_.approximated(at,
                         format("the load curve has {} curved pieces: each is {} straight lines",
                                pieces.size(), kLines));
    return table(make, points, "linear");
  }
  if (pieces.size() > kMostTerms) {
    file_.refuse(at, format("the load curve jumps between more than {} pieces", kMostTerms),
                 "Give fewer points or another rule.");
    return make.number(0.0);
  }
  std::string sum;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const FebPiece& p = pieces[k];
    const bool first = k == 0, last = k + 1 == pieces.size();
    const std::string when = first && last ? "1"
                             : first       ? format("(1 - step(t, {}))", p.to)
                             : last        ? format("step(t, {})", p.from)
                                           : format("pulse(t, {}, {})", p.from, p.to);
    sum += (first ? "" : " + ") + when + "*" + polynomial(p, scale);
  }
  SourceNode text = make.text(sum);
  text.in_quotes = true;
  return text;
}

}  // namespace polhode::io
