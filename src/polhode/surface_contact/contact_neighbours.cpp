// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/surface_contact/contact_neighbours.hpp>
#include <polhode/system/nodes.hpp>

namespace polhode::surface_contact {

namespace {

/// Smallest search radius, as a part of an edge.
constexpr double kLook = 0.3;
/// Number of steps like the last one whose relative displacement of the surfaces the search radius
/// covers.
constexpr double kLookSteps = 5.0;
/// Number of steps like the last one that must remain; with fewer the search is repeated.
constexpr double kStepsLeft = 2.0;

}  // namespace

ContactNeighbours::ContactNeighbours(std::initializer_list<const std::vector<MeshPoint>*> lists,
                                     const SolidContactStart& start)
    : edge_(start.edge), way_(start.way) {
  for (const std::vector<MeshPoint>* list : lists)
    for (const MeshPoint& p : *list) numbers_.insert(numbers_.end(), p.node, p.node + p.count);
  std::sort(numbers_.begin(), numbers_.end());
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  for (const int i : numbers_) {
    const Vec3& x = start.X[static_cast<std::size_t>(i)];
    start_.insert(start_.end(), x.begin(), x.end());
    carriers_.push_back(start.carriers[static_cast<std::size_t>(i)]);
  }
}

int ContactNeighbours::at(int node) const {
  return static_cast<int>(std::lower_bound(numbers_.begin(), numbers_.end(), node) -
                          numbers_.begin());
}

void ContactNeighbours::write_start(double* key) const {
  std::copy(start_.begin(), start_.end(), key);
  key[start_.size()] = std::max(kLook * edge_, kLookSteps * way_);
}

std::vector<double> ContactNeighbours::positions(const double* key) const {
  std::vector<double> x(3 * static_cast<std::size_t>(numbers_.back() + 1));
  for (const int i : numbers_) {
    std::copy_n(key, 3, x.begin() + 3 * i);
    key += 3;
  }
  return x;
}

void ContactNeighbours::write_instant(const double* x, double* key) const {
  for (const int i : numbers_) key = std::copy_n(x + 3 * i, 3, key);
  *key = kLook * edge_;
}

Vec3 ContactNeighbours::place(const MeshPoint& p, const double* key) const {
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < p.count; ++a) x += p.N[a] * NodeStep::at(key, at(p.node[a]));
  return x;
}

bool ContactNeighbours::carried_together(std::initializer_list<const MeshPoint*> points) const {
  int carrier = 0;
  bool first = true;
  for (const MeshPoint* p : points)
    for (int a = 0; a < p->count; ++a) {
      const int body = carriers_[static_cast<std::size_t>(at(p->node[a]))];
      if (body == kFreeNode || (!first && body != carrier)) return false;
      carrier = body;
      first = false;
    }
  return true;
}

std::vector<double> ContactNeighbours::deviations(const double* x, const double* places) const {
  const auto n = static_cast<int>(numbers_.size());
  const auto moved = [&](int k) -> Vec3 {
    return NodeStep::at(x, numbers_[static_cast<std::size_t>(k)]) - NodeStep::at(places, k);
  };
  Vec3 mean = Vec3::Zero();
  for (int k = 0; k < n; ++k) mean += moved(k);
  mean /= n;
  std::vector<double> far;
  far.reserve(numbers_.size());
  for (int k = 0; k < n; ++k) far.push_back((moved(k) - mean).norm());
  return far;
}

void ContactNeighbours::renew(const NodeStep& step, double* key) const {
  std::vector<double> before;
  before.reserve(start_.size());
  for (const int i : numbers_) before.insert(before.end(), step.x_n + 3 * i, step.x_n + 3 * i + 3);
  const std::vector<double> far = deviations(step.x_n1, key),
                            last = deviations(step.x_n1, before.data());
  const double way = *std::max_element(last.begin(), last.end());
  if (*std::max_element(far.begin(), far.end()) + kStepsLeft * way <= 0.5 * look(key)) return;
  write_instant(step.x_n1, key);
  key[start_.size()] = std::max(kLook * edge_, kLookSteps * way);
}

double ContactNeighbours::free_part(const double* from, const double* to, const double* key) const {
  double most = 1.0;
  const std::vector<double> far_from = deviations(from, key), far_to = deviations(to, key);
  const double clearance = 0.5 * look(key);
  for (std::size_t k = 0; k < far_to.size(); ++k)
    if (far_to[k] > clearance && far_to[k] > far_from[k])
      most = std::min(most, std::max(0.0, clearance - far_from[k]) / (far_to[k] - far_from[k]));
  return most;
}

ContactNeighbours::Blocks ContactNeighbours::blocks(
    const std::vector<std::vector<int>>& sets) const {
  std::vector<std::vector<int>> columns(numbers_.size());
  for (std::vector<int> together : sets) {
    std::sort(together.begin(), together.end());
    together.erase(std::unique(together.begin(), together.end()), together.end());
    for (const int i : together) {
      std::vector<int>& row = columns[static_cast<std::size_t>(at(i))];
      row.insert(row.end(), together.begin(), together.end());
    }
  }
  Blocks b;
  b.row_start.assign(1, 0);
  for (std::size_t r = 0; r < numbers_.size(); ++r) {
    std::sort(columns[r].begin(), columns[r].end());
    columns[r].erase(std::unique(columns[r].begin(), columns[r].end()), columns[r].end());
    b.blocks.row.insert(b.blocks.row.end(), columns[r].size(), numbers_[r]);
    b.blocks.column.insert(b.blocks.column.end(), columns[r].begin(), columns[r].end());
    b.row_start.push_back(static_cast<int>(b.blocks.column.size()));
  }
  return b;
}

void ContactNeighbours::add(const Blocks& b, const MeshPoint& row, const MeshPoint& column,
                            const Mat3& K, double* tangent) const {
  for (int i = 0; i < row.count; ++i) {
    const auto r = static_cast<std::size_t>(at(row.node[i]));
    const auto first = b.blocks.column.begin() + b.row_start[r],
               last = b.blocks.column.begin() + b.row_start[r + 1];
    for (int j = 0; j < column.count; ++j) {
      const auto slot = std::lower_bound(first, last, column.node[j]) - b.blocks.column.begin();
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(tangent + 9 * slot);
      block += row.N[i] * column.N[j] * K;
    }
  }
}

}  // namespace polhode::surface_contact
