// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include <polhode/core/format.hpp>
#include <polhode/io/results/svg_panel.hpp>
#include <polhode/io/results/write_campbell.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

std::string campbell_table(const std::vector<ModalAnalysis>& analyses) {
  std::string text =
      "spin [rad/s],mode,frequency [Hz],world_frequency [Hz],whirl,damping_ratio [-],kind,"
      "eigenvalue.real [rad/s],eigenvalue.imaginary [rad/s]\n";
  for (const ModalAnalysis& analysis : analyses)
    for (std::size_t i = 0; i < analysis.report().modes.size(); ++i) {
      const Mode& m = analysis.report().modes[i];
      text += format("{:.15g},{},{:.15g},{},{},{:.6g},{},{:.15g},{:.15g}\n", analysis.spin(), i + 1,
                     m.frequency,
                     m.world_frequency ? format("{:.15g}", *m.world_frequency) : std::string(),
                     whirl_name(m.whirl), m.damping, kind_name(m.kind), m.eigenvalue.real(),
                     m.eigenvalue.imag());
    }
  return text;
}

/// Families of curves of a Campbell diagram.
enum class Family { forward, backward, axial, other };

struct FamilyStyle {
  Family family;
  const char* colour;
  bool dashed;
};
constexpr FamilyStyle kFamilies[] = {{Family::other, "#9467bd", false},
                                     {Family::axial, "#7f7f7f", false},
                                     {Family::forward, "#1f77b4", false},
                                     {Family::backward, "#d62728", true}};

/// A mode at a speed. NaN: its frequency in the world is not known.
struct CampbellPoint {
  double turning = 0.0, world = 0.0;
  Family family = Family::other;
};

Family family_of(const Mode& m) {
  if (m.whirl == Whirl::forward) return Family::forward;
  if (m.whirl == Whirl::backward) return Family::backward;
  return m.whirl == Whirl::none ? Family::axial : Family::other;
}

/// Modes of a speed by rising frequency in the world, or in the frame if that is not known.
std::vector<CampbellPoint> points_of(const ModalAnalysis& analysis) {
  std::vector<CampbellPoint> list;
  for (const Mode& m : analysis.report().modes)
    list.push_back({m.frequency,
                    m.world_frequency.value_or(std::numeric_limits<double>::quiet_NaN()),
                    family_of(m)});
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) {
    const auto key = [](const CampbellPoint& p) {
      return std::isnan(p.world) ? p.turning : p.world;
    };
    return key(a) < key(b);
  });
  return list;
}

/// Gives modes at rest, which do not whirl, the families of those of the same rank at the nearest
/// speed: at rest each curve of a whirl begins.
void name_families_at_rest(const std::vector<double>& speeds,
                           std::vector<std::vector<CampbellPoint>>& modes) {
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    if (speeds[k] != 0.0) continue;
    for (const std::size_t near : {k + 1, k - 1}) {
      if (near >= speeds.size() || modes[near].size() != modes[k].size()) continue;
      for (std::size_t i = 0; i < modes[k].size(); ++i) modes[k][i].family = modes[near][i].family;
      break;
    }
  }
}

/// Curves by whirl, in the frame and in the world, with the line of one vibration a turn.
std::string campbell_picture(const std::vector<ModalAnalysis>& analyses) {
  constexpr double kPictureWidth = 720.0, kPanelHeight = 300.0, kCampbellMargin = 60.0;
  constexpr double kFirst = 58.0, kNext = 366.0;
  std::vector<double> speeds;
  std::vector<std::vector<CampbellPoint>> modes;
  std::size_t most = 0;
  double top = 0.0;
  for (const ModalAnalysis& analysis : analyses) {
    speeds.push_back(analysis.spin());
    modes.push_back(points_of(analysis));
    most = std::max(most, modes.back().size());
    for (const CampbellPoint& p : modes.back())
      top = std::max({top, p.turning, std::isnan(p.world) ? 0.0 : p.world});
  }
  name_families_at_rest(speeds, modes);
  const double low = *std::min_element(speeds.begin(), speeds.end());
  const double high = *std::max_element(speeds.begin(), speeds.end());
  const double width = kPictureWidth - 1.5 * kCampbellMargin;
  const auto panel_at = [&](double y, const char* title) {
    return SvgPanel({kCampbellMargin, y, width, kPanelHeight}, low, high > low ? high : low + 1.0,
                    0.0, top > 0.0 ? 1.06 * top : 1.0, title);
  };
  SvgPanel turning = panel_at(kFirst, "frequency in the turning frame [Hz]");
  SvgPanel world = panel_at(kFirst + kNext, "frequency in the world [Hz]");
  std::vector<double> once;
  for (const double speed : speeds) once.push_back(std::abs(speed) / (2.0 * std::numbers::pi));
  world.curve(speeds, once, "#bbbbbb");
  for (const FamilyStyle& style : kFamilies)
    for (std::size_t rank = 0; rank < most; ++rank) {
      std::vector<double> x, in_frame, in_world;
      for (std::size_t k = 0; k < speeds.size(); ++k) {
        std::size_t at = 0;
        for (const CampbellPoint& p : modes[k]) {
          if (p.family != style.family || at++ != rank) continue;
          x.push_back(speeds[k]);
          in_frame.push_back(p.turning);
          in_world.push_back(p.world);
          break;
        }
      }
      turning.curve(x, in_frame, style.colour, style.dashed);
      turning.points(x, in_frame, style.colour);
      world.curve(x, in_world, style.colour, style.dashed);
      world.points(x, in_world, style.colour);
    }
  std::string content = turning.text() + world.text();
  for (const double y : {kFirst, kFirst + kNext})
    content +=
        svg_text(kCampbellMargin + 0.5 * width, y + kPanelHeight + 32.0, "spin [rad/s]", "middle");
  content += svg_text(kCampbellMargin, 22.0,
                      "Whirl: blue forward, red backward, grey along or about the axis, violet not "
                      "known. Light grey: once a turn.");
  return svg_page(kPictureWidth, kFirst + kNext + kPanelHeight + 46.0, content);
}

}  // namespace

void write_campbell(const std::vector<ModalAnalysis>& analyses, const std::string& folder) {
  std::filesystem::create_directories(folder);
  write_file_atomically(folder + "/campbell.csv", campbell_table(analyses), false);
  write_file_atomically(folder + "/campbell.svg", campbell_picture(analyses), false);
}

}  // namespace polhode::io
