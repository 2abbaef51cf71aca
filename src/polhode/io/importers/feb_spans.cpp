// SPDX-License-Identifier: Apache-2.0
// Values that each of several steps gives in its own way.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/io/importers/feb_curves.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

/// Pieces that the value of one step may have.
constexpr std::size_t kMostInStep = 100'000;

bool same_value(const FebSpan& a, const FebSpan& b) {
  return a.value && b.value && a.value->factor == b.value->factor &&
         a.value->controller == b.value->controller && !a.relative && !b.relative;
}

}  // namespace

bool FebCurves::is_curve(const FebValue& value) const {
  if (value.is_constant()) return false;
  const auto found = controllers_.find(*value.controller);
  return found != controllers_.end() && !found->second.curve.points.empty();
}

std::optional<std::vector<FebPiece>> FebCurves::pieces_of(const FebSpan& span) {
  if (!span.value || span.value->is_constant())
    return std::vector<FebPiece>{{span.begin, span.end, {span.value ? span.value->factor : 0.0}}};
  const FebValue& value = *span.value;
  const auto found = controllers_.find(*value.controller);
  if (found == controllers_.end()) {
    file_.xml.fault(*value.at, format("there is no load controller {}", *value.controller),
                    "Give the id of a load_controller.");
    return std::nullopt;
  }
  const Controller& controller = found->second;
  if (!controller.usable) return std::nullopt;  // An error, or left out, already.
  if (!controller.channel.empty() || !controller.math.empty()) {
    file_.refuse(*value.at,
                 format("the load controller {} of a value that changes from step to step is no "
                        "load curve",
                        *value.controller),
                 "Use a loadcurve, or one value for all steps.");
    return std::nullopt;
  }
  std::vector<FebPiece> own;
  for (FebPiece piece : controller.curve.pieces(span.end, kMostInStep)) {
    if (piece.to <= span.begin || piece.from >= span.end) continue;
    piece = between(piece, span.begin, span.end);
    for (double& c : piece.powers) c *= value.factor;
    own.push_back(piece);
  }
  if (own.empty()) {
    file_.xml.fault(*controller.at,
                    format("the load curve has more than {} points up to the end", kMostInStep),
                    "Give a longer period.");
    return std::nullopt;
  }
  return own;
}

SourceNode FebCurves::node(const XmlFile::Element& at, const std::vector<FebSpan>& spans,
                           double factor) {
  const NodeBuilder make{file_.xml.line(at)};
  const bool ends = spans.back().released;
  const bool same = std::all_of(spans.begin(), spans.end(), [&](const FebSpan& s) {
    return s.released || same_value(s, spans.front());
  });
  if (same && (!ends || !is_curve(*spans.front().value))) return node(*spans.front().value, factor);
  std::vector<FebPiece> pieces;
  double last = 0.0;
  for (const FebSpan& span : spans) {
    if (span.released) {
      // No kink where it is let go, so that it keeps its velocity.
      pieces.back().to = span.end;
      continue;
    }
    auto own = pieces_of(span);
    if (!own) return make.number(0.0);
    const double shift = span.value && !span.relative ? 0.0 : last;
    for (FebPiece& piece : *own) piece.powers[0] += shift;
    last = own->back().at(span.end);
    pieces.insert(pieces.end(), own->begin(), own->end());
  }
  return pieces_node(make, at, std::move(pieces), factor);
}

std::vector<FebSpan> FebModel::spans(
    const std::function<std::optional<FebSpan>(std::size_t)>& of) const {
  std::vector<FebSpan> all;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    FebSpan span = of(s).value_or(FebSpan{});
    span.begin = steps[s].begin;
    span.end = steps[s].end;
    all.push_back(span);
  }
  return all;
}

}  // namespace polhode::io
