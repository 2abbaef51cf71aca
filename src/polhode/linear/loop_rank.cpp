// SPDX-License-Identifier: Apache-2.0
#include <polhode/linear/loop_rank.hpp>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>

namespace polhode::linear {

namespace {

/// Multiplier in a redundancy, as a part of the largest, from which on its row takes part.
constexpr double kPart = 1e-6;
constexpr int kProbes = 2;

/// Pseudo-random numbers between −1 and 1, the same in every run (splitmix64).
double fixed_random(std::uint64_t n) {
  std::uint64_t x = (n + 1) * 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  x ^= x >> 31;
  return static_cast<double>(x >> 11) * 0x1.0p-52 - 1.0;
}

/// Fixed pseudo-random vectors.
Mat fixed_probes(const std::vector<BodyRows>& rows) {
  Eigen::Index count = 0;
  for (const BodyRows& block : rows) count += block.G.rows();
  Mat probes(count, kProbes);
  for (Eigen::Index i = 0; i < probes.size(); ++i)
    probes.data()[i] = fixed_random(static_cast<std::uint64_t>(i));
  return probes;
}

class Elimination {
 public:
  /// @param probes  Vectors to be projected, by row.
  Elimination(const std::vector<BodyRows>& rows, int bodies, double tolerance, Mat probes)
      : tolerance_(tolerance),
        of_body_(static_cast<std::size_t>(bodies)),
        probes_(std::move(probes)) {
    int first = 0;
    for (const BodyRows& block : rows) {
      std::vector<int> slots(static_cast<std::size_t>(block.G.rows()));
      for (int& slot : slots) slot = first++;
      add({block.bodies, block.G, std::move(slots)});
    }
    vanished_.assign(static_cast<std::size_t>(first), 0);
  }

  void run() {
    using Entry = std::pair<std::size_t, int>;  // Neighbours, body.
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (int b = 0; b < static_cast<int>(of_body_.size()); ++b)
      queue.emplace(neighbours(b).size(), b);
    while (!queue.empty()) {
      const auto [said, body] = queue.top();
      queue.pop();
      const std::vector<int> others = neighbours(body);
      if (others.size() > said && !queue.empty() && queue.top().first < others.size())
        queue.emplace(others.size(), body);  // It has gained neighbours since then.
      else
        eliminate(body, others);
    }
  }

  [[nodiscard]] int rank() const { return rank_; }
  /// Projection of the vectors onto the vanished combinations.
  [[nodiscard]] const Mat& projection() {
    for (Eigen::Index i = 0; i < probes_.rows(); ++i)
      if (!vanished_[static_cast<std::size_t>(i)]) probes_.row(i).setZero();
    for (std::size_t k = turns_.size(); k-- > 0;) apply(turns_[k], false);
    return probes_;
  }

 private:
  struct Block {
    std::vector<int> bodies;
    Mat G;
    std::vector<int> slots;  ///< Positions of its rows among all.
  };
  /// Orthogonal transformation of rows: new = Qᵀ old.
  struct Turn {
    std::vector<int> slots;
    Mat Q;
  };

  void add(Block block) {
    for (const int body : block.bodies)
      of_body_[static_cast<std::size_t>(body)].push_back(static_cast<int>(blocks_.size()));
    blocks_.push_back(std::move(block));
  }

  /// The other bodies of the rows on a body, sorted.
  [[nodiscard]] std::vector<int> neighbours(int body) const {
    std::vector<int> list;
    for (const int k : of_body_[static_cast<std::size_t>(body)])
      for (const int other : blocks_[static_cast<std::size_t>(k)].bodies)
        if (other != body) list.push_back(other);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  /// Transforms rows so that the first ones contain the range of some columns above the tolerance.
  /// @returns their number.
  Eigen::Index turn(Block& front, Eigen::Index first_row, Eigen::Index columns) {
    const Eigen::Index count = front.G.rows() - first_row;
    if (count == 0 || columns == 0) return 0;
    const Eigen::ColPivHouseholderQR<Mat> qr(front.G.bottomRows(count).leftCols(columns));
    const Eigen::Index most = std::min(count, columns);
    Eigen::Index rank = 0;
    while (rank < most && std::abs(qr.matrixQR()(rank, rank)) > tolerance_) ++rank;
    Turn t{{front.slots.begin() + first_row, front.slots.end()}, qr.householderQ()};
    front.G.bottomRows(count) = t.Q.transpose() * front.G.bottomRows(count);
    front.G.bottomRows(count - rank).leftCols(columns).setZero();
    apply(t, true);
    turns_.push_back(std::move(t));
    return rank;
  }

  void apply(const Turn& t, bool transposed) {
    Mat part(static_cast<Eigen::Index>(t.slots.size()), probes_.cols());
    for (std::size_t i = 0; i < t.slots.size(); ++i)
      part.row(static_cast<Eigen::Index>(i)) = probes_.row(t.slots[i]);
    part = transposed ? Mat(t.Q.transpose() * part) : Mat(t.Q * part);
    for (std::size_t i = 0; i < t.slots.size(); ++i)
      probes_.row(t.slots[i]) = part.row(static_cast<Eigen::Index>(i));
  }

  /// Keeps the rows [begin, begin + count) of a front; those after them have vanished.
  void keep(Block& front, Eigen::Index begin, Eigen::Index count) {
    for (Eigen::Index i = begin + count; i < front.G.rows(); ++i)
      vanished_[static_cast<std::size_t>(front.slots[static_cast<std::size_t>(i)])] = 1;
    front.G = Mat(front.G.middleRows(begin, count));
    front.slots = {front.slots.begin() + begin, front.slots.begin() + begin + count};
  }

  void eliminate(int body, const std::vector<int>& others) {
    // The body's columns come first.
    std::vector<int> columns{body};
    columns.insert(columns.end(), others.begin(), others.end());
    const Eigen::Index width = 6 * static_cast<Eigen::Index>(columns.size());
    Block front{columns, Mat(0, width), {}};
    for (const int k : of_body_[static_cast<std::size_t>(body)]) {
      Block& block = blocks_[static_cast<std::size_t>(k)];
      const Eigen::Index at = front.G.rows();
      front.G.conservativeResize(at + block.G.rows(), width);
      front.G.bottomRows(block.G.rows()).setZero();
      for (std::size_t j = 0; j < block.bodies.size(); ++j) {
        const int other = block.bodies[j];
        const Eigen::Index place =
            other == body
                ? 0
                : 1 + (std::lower_bound(others.begin(), others.end(), other) - others.begin());
        front.G.block(at, 6 * place, block.G.rows(), 6) =
            block.G.middleCols(6 * static_cast<Eigen::Index>(j), 6);
      }
      front.slots.insert(front.slots.end(), block.slots.begin(), block.slots.end());
      // Many rows on few bodies are reduced as they are added.
      if (front.G.rows() > 2 * width + 32) keep(front, 0, turn(front, 0, width));
      forget(k, body);
    }
    of_body_[static_cast<std::size_t>(body)].clear();
    const Eigen::Index pivots = turn(front, 0, 6);
    rank_ += static_cast<int>(pivots);
    front.G = Mat(front.G.rightCols(width - 6));
    front.bodies.erase(front.bodies.begin());
    keep(front, pivots, turn(front, pivots, width - 6));
    if (front.G.rows() > 0) add(std::move(front));
  }

  /// Removes a block from the lists of all its bodies but one.
  void forget(int block, int but) {
    for (const int body : blocks_[static_cast<std::size_t>(block)].bodies)
      if (body != but) std::erase(of_body_[static_cast<std::size_t>(body)], block);
    blocks_[static_cast<std::size_t>(block)] = {};
  }

  double tolerance_;
  int rank_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::vector<int>> of_body_;  ///< Blocks with rows on it.
  std::vector<Turn> turns_;
  std::vector<char> vanished_;  ///< By row.
  Mat probes_;
};

}  // namespace

LoopRank loop_rank(const std::vector<BodyRows>& rows, int bodies, double tolerance) {
  Elimination elimination(rows, bodies, tolerance, fixed_probes(rows));
  elimination.run();
  // Rows in which the projection onto the vanished combinations is nonzero.
  const Mat& projection = elimination.projection();
  std::vector<char> part(static_cast<std::size_t>(projection.rows()), 0);
  const double largest = projection.size() > 0 ? projection.cwiseAbs().maxCoeff() : 0.0;
  for (Eigen::Index i = 0; i < projection.rows(); ++i)
    part[static_cast<std::size_t>(i)] =
        largest > 0.0 && projection.row(i).cwiseAbs().maxCoeff() > kPart * largest;
  return {elimination.rank(), std::move(part)};
}

Vec unreachable_part(const std::vector<BodyRows>& rows, int bodies, double tolerance,
                     const Vec& right_side) {
  Elimination elimination(rows, bodies, tolerance, right_side);
  elimination.run();
  return elimination.projection();
}

}  // namespace polhode::linear
