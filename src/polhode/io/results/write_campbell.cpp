// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

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

/// Curves by the number of the mode in the frame, and by the whirl in the world.
std::string campbell_picture(const std::vector<ModalAnalysis>& analyses) {
  constexpr double kPictureWidth = 720.0, kPanelHeight = 300.0, kCampbellMargin = 84.0;
  constexpr double kFirst = 34.0, kNext = 370.0;
  const double begin = analyses.front().spin(), end = analyses.back().spin();
  const double low = std::min(begin, end), high = std::max(begin, end);
  std::vector<double> speeds;
  std::size_t most = 0;
  double top = 0.0;
  for (const ModalAnalysis& analysis : analyses) {
    speeds.push_back(analysis.spin());
    most = std::max(most, analysis.report().modes.size());
    for (const Mode& m : analysis.report().modes)
      top = std::max({top, m.frequency, m.world_frequency.value_or(0.0)});
  }
  const auto panel_at = [&](double y, const char* title) {
    return SvgPanel({kCampbellMargin, y, kPictureWidth - 2.0 * kCampbellMargin, kPanelHeight}, low,
                    high > low ? high : low + 1.0, 0.0, top > 0.0 ? 1.06 * top : 1.0, title);
  };
  SvgPanel turning = panel_at(kFirst, "in the turning frame [Hz]");
  SvgPanel world = panel_at(kFirst + kNext, "in the world [Hz]");
  for (std::size_t i = 0; i < most; ++i) {
    std::vector<double> x, y;
    for (const ModalAnalysis& analysis : analyses)
      if (i < analysis.report().modes.size()) {
        x.push_back(analysis.spin());
        y.push_back(analysis.report().modes[i].frequency);
      }
    turning.curve(x, y, "#1f77b4");
  }
  for (const Whirl whirl : {Whirl::none, Whirl::forward, Whirl::backward}) {
    const char* colour = whirl == Whirl::none      ? "#7f7f7f"
                         : whirl == Whirl::forward ? "#1f77b4"
                                                   : "#d62728";
    for (std::size_t i = 0; i < most; ++i) {
      std::vector<double> x, y;
      for (const ModalAnalysis& analysis : analyses) {
        std::vector<double> all;
        for (const Mode& m : analysis.report().modes)
          if (m.whirl == whirl && m.world_frequency) all.push_back(*m.world_frequency);
        std::sort(all.begin(), all.end());
        if (i >= all.size()) continue;
        x.push_back(analysis.spin());
        y.push_back(all[i]);
      }
      world.curve(x, y, colour, whirl == Whirl::backward);
    }
  }
  std::string content = turning.text() + world.text();
  for (const double y : {kFirst, kFirst + kNext})
    content += svg_text(kCampbellMargin + 200.0, y + kPanelHeight + 34.0, "spin [rad/s]");
  content += svg_text(kPictureWidth - 300.0, kFirst + kNext - 10.0,
                      "blue forward, red backward, grey on the axis");
  return svg_page(kPictureWidth, kFirst + 2.0 * kNext, content);
}

}  // namespace

void write_campbell(const std::vector<ModalAnalysis>& analyses, const std::string& folder) {
  std::filesystem::create_directories(folder);
  write_file_atomically(folder + "/campbell.csv", campbell_table(analyses), false);
  write_file_atomically(folder + "/campbell.svg", campbell_picture(analyses), false);
}

}  // namespace polhode::io
