// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <polhode/io/results/results_reader.hpp>
#include <polhode/view/channels.hpp>

namespace polhode {

/// Extremes and means of a quantity over time.
struct Extremes {
  double least = 0.0, greatest = 0.0;            ///< NaN, like the others, if no value is finite.
  double least_time = 0.0, greatest_time = 0.0;  ///< The first ones of equal values.
  double mean = 0.0, rms = 0.0;  ///< Over time, of values that change evenly between samples.
};

/// Extremes of finite values; a span beside one that is not finite counts in no mean.
/// @param t  Times, ascending. @param values  As many.
[[nodiscard]] Extremes extremes_of(const std::vector<double>& t, const std::vector<double>& values);

/// Contents of a report besides those of the results.
struct ReportRequest {
  std::vector<ReportTable> probes;
  std::string picture;  ///< Of the model, PNG; empty: none.
  std::string time_label = "t [s]";
};

/// Report of a run: whether it is trusted, its ledger, a picture, extremes and plots of probes,
/// extremes of joints, loads and contacts, versions, and the model's text. One page that needs no
/// other file.
[[nodiscard]] std::string report_page(const io::ResultsReader& results,
                                      const ReportRequest& request);

/// The same report in Markdown.
struct MarkdownReport {
  std::string text;
  std::map<std::string, std::string> pictures;  ///< By the name that the text gives them.
};
/// @param folder  Folder of the pictures, relative to the text.
[[nodiscard]] MarkdownReport report_markdown(const io::ResultsReader& results,
                                             const ReportRequest& request,
                                             const std::string& folder);

}  // namespace polhode
