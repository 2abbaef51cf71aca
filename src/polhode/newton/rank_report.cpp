// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/loop_rank.hpp>
#include <polhode/newton/rank_report.hpp>

namespace polhode {

namespace {

/// Exact rows of an interaction, each normalised.
struct Rows {
  int interaction = 0;
  std::vector<int> bodies{};  ///< Moving bodies, six columns of G each.
  Mat G{};
  std::vector<int> number{};       ///< Of each row in the system.
  std::vector<double> per_size{};  ///< Factor by which each was normalised.

  [[nodiscard]] auto part(std::size_t body) const {
    return G.middleCols<6>(6 * static_cast<Eigen::Index>(body));
  }
  /// Adds a body's columns, or adds to them.
  void add(int body, const Mat& by) {
    if (body == kGround) return;
    const auto found = std::find(bodies.begin(), bodies.end(), body);
    if (found != bodies.end()) {
      G.middleCols<6>(6 * (found - bodies.begin())) += by;
      return;
    }
    bodies.push_back(body);
    G.conservativeResize(by.rows(), 6 * static_cast<Eigen::Index>(bodies.size()));
    G.rightCols<6>() = by;
  }
};

std::vector<Rows> constraint_rows(const System& system, const State& state) {
  std::vector<BodyStep> steps;
  steps.reserve(system.body_count() + 1);
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  context.t_n = state.t;
  context.conserving = false;

  std::vector<Rows> list;
  const std::vector<double> no_lambda(system.rows(), 0.0);
  const double per_length = 1.0 / system.length_scale();
  InteractionSweep sweep(system);
  sweep.run(
      steps, context, no_lambda.data(), state.history.data(),
      [&](int i, const PairStep&, const PairTerms& terms) {
        const InteractionRef& ref = system.interactions()[i];
        std::vector<int> exact;
        for (int k = 0; k < ref.rows; ++k)
          if (terms.compliance[k] == 0.0) exact.push_back(k);
        if (exact.empty()) return;
        if (!ref.further_part) list.push_back({.interaction = i});
        Rows& rows = list.back();
        const auto of = [&](const auto& G) {
          Mat by(exact.size(), 6);
          for (std::size_t k = 0; k < exact.size(); ++k)
            by.row(static_cast<Eigen::Index>(k)) = G.row(exact[k]);
          by.rightCols<3>() *= per_length;
          return by;
        };
        rows.add(ref.a, of(terms.G_a));
        rows.add(ref.b, of(terms.G_b));
        if (!ref.further_part)
          for (const int k : exact) rows.number.push_back(ref.first_row + k);
      },
      true);
  for (Rows& rows : list)
    for (Eigen::Index k = 0; k < rows.G.rows(); ++k) {
      const double size = rows.G.row(k).norm();
      if (size > 0.0) rows.G.row(k) /= size;
      rows.per_size.push_back(size > 0.0 ? 1.0 / size : 0.0);
    }
  return list;
}

/// Removes, one after the other, the joint of each body that has only one: if its rows are
/// independent on that body alone, they are independent of all others. The remainder are loops.
/// @returns the rank of the removed rows.
int take_out_branches(const System& system, double tolerance, std::vector<Rows>& rows) {
  std::vector<std::vector<int>> of_body(static_cast<std::size_t>(system.body_count()));
  for (int k = 0; k < static_cast<int>(rows.size()); ++k)
    for (const int body : rows[k].bodies) of_body[body].push_back(k);
  std::vector<char> gone(rows.size(), 0);
  std::vector<int> ends;
  for (int b = 0; b < system.body_count(); ++b)
    if (of_body[b].size() == 1) ends.push_back(b);
  int rank = 0;
  while (!ends.empty()) {
    const int body = ends.back();
    ends.pop_back();
    if (of_body[body].size() != 1) continue;
    const int k = of_body[body].front();
    const Rows& joint = rows[k];
    Eigen::ColPivHouseholderQR<Mat> qr(6, joint.G.rows());
    qr.setThreshold(tolerance);
    const auto place = std::find(joint.bodies.begin(), joint.bodies.end(), body);
    qr.compute(joint.part(static_cast<std::size_t>(place - joint.bodies.begin())).transpose());
    if (qr.rank() < joint.G.rows()) continue;
    rank += static_cast<int>(joint.G.rows());
    gone[k] = 1;
    of_body[body].clear();
    for (const int other : joint.bodies) {
      if (other == body) continue;
      std::vector<int>& left = of_body[other];
      left.erase(std::find(left.begin(), left.end(), k));
      if (left.size() == 1) ends.push_back(other);
    }
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (!gone[k]) std::swap(rows[kept++], rows[k]);
  rows.resize(kept);
  return rank;
}

/// Connected components of interactions that share bodies, as positions in the list.
std::vector<std::vector<int>> clusters(const System& system, const std::vector<Rows>& rows) {
  DisjointSets sets(static_cast<std::size_t>(system.body_count()));
  for (const Rows& r : rows)
    for (const int body : r.bodies) sets.join(r.bodies.front(), body);
  std::map<int, std::vector<int>> by_first;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k)
    by_first[sets.first_of(rows[k].bodies.front())].push_back(k);
  std::vector<std::vector<int>> list;
  for (auto& [body, members] : by_first) list.push_back(std::move(members));
  return list;
}

/// Rows of a connected component over its own bodies, and the interaction of each.
struct ClusterRows {
  std::vector<linear::BodyRows> blocks;
  std::vector<int> interaction;
  int bodies = 0;
};

ClusterRows rows_of(const std::vector<Rows>& rows, const std::vector<int>& cluster) {
  ClusterRows list;
  std::map<int, int> place;
  for (const int k : cluster) {
    const Rows& r = rows[static_cast<std::size_t>(k)];
    linear::BodyRows block{{}, Mat(r.G.rows(), 0)};
    for (const int body : r.bodies)
      block.bodies.push_back(place.try_emplace(body, static_cast<int>(place.size())).first->second);
    block.G = r.G;
    list.interaction.insert(list.interaction.end(), static_cast<std::size_t>(r.G.rows()),
                            r.interaction);
    list.blocks.push_back(std::move(block));
  }
  list.bodies = static_cast<int>(place.size());
  return list;
}

/// Part of a contradiction, relative to the largest, from which on a row is named.
constexpr double kTakesPart = 1e-3;

}  // namespace

std::string interaction_name(const System& system, int interaction) {
  const InteractionRef& ref = system.interactions()[interaction];
  return format("{} '{}'", system.group(ref.group).kind(), system.name(ref));
}

std::string RankReport::text() const {
  std::string s = format("mobility {}, {} constraint rows, rank {}", mobility, rows, rank);
  if (redundant == 0) return s + ", none redundant";
  s += format(", {} redundant among", redundant);
  for (std::size_t i = 0; i < names.size(); ++i) s += (i == 0 ? " " : ", ") + names[i];
  return s;
}

RankReport rank_report(const System& system, const State& state, double tolerance) {
  std::vector<Rows> rows = constraint_rows(system, state);
  RankReport report;
  for (const Rows& r : rows) report.rows += static_cast<int>(r.G.rows());
  report.rank = take_out_branches(system, tolerance, rows);
  std::set<int> involved;
  for (const std::vector<int>& cluster : clusters(system, rows)) {
    const ClusterRows own = rows_of(rows, cluster);
    const linear::LoopRank found = linear::loop_rank(own.blocks, own.bodies, tolerance);
    report.rank += found.rank;
    for (std::size_t j = 0; j < found.dependent.size(); ++j)
      if (found.dependent[j]) involved.insert(own.interaction[j]);
  }
  report.redundant = report.rows - report.rank;
  report.mobility = 6 * system.body_count() - report.rank;
  for (const int i : involved) {
    report.involved.push_back(i);
    report.names.push_back(interaction_name(system, i));
  }
  return report;
}

Contradiction find_contradiction(const System& system, const State& state,
                                 std::span<const double> right_side, double tolerance) {
  std::vector<Rows> rows = constraint_rows(system, state);
  Contradiction found;
  for (const Rows& r : rows)
    for (std::size_t k = 0; k < r.number.size(); ++k)
      found.of = std::max(found.of, std::abs(r.per_size[k] * right_side[r.number[k]]));
  if (found.of == 0.0) return found;
  (void)take_out_branches(system, tolerance, rows);
  std::map<int, double> parts;  // by interaction
  for (const std::vector<int>& cluster : clusters(system, rows)) {
    const ClusterRows own = rows_of(rows, cluster);
    Vec r(static_cast<Eigen::Index>(own.interaction.size()));
    Eigen::Index at = 0;
    for (const int k : cluster)
      for (std::size_t j = 0; j < rows[k].number.size(); ++j)
        r[at++] = rows[k].per_size[j] * right_side[rows[k].number[j]];
    if (r.isZero(0.0)) continue;
    const Vec part = linear::unreachable_part(own.blocks, own.bodies, tolerance, r);
    for (Eigen::Index j = 0; j < part.size(); ++j) {
      double& most = parts[own.interaction[static_cast<std::size_t>(j)]];
      most = std::max(most, std::abs(part[j]));
      found.part = std::max(found.part, most);
    }
  }
  for (const auto& [interaction, part] : parts)
    if (part > kTakesPart * found.part)
      found.names.push_back(interaction_name(system, interaction));
  return found;
}

}  // namespace polhode
