// SPDX-License-Identifier: Apache-2.0
#include <polhode/gradient/kkt_product.hpp>

namespace polhode {

void kkt_product(const linear::KktTopology& topology, const linear::KktValues& values, const Vec& x,
                 bool transposed, Vec& out) {
  out.setZero(x.size());
  const int first_row = 6 * topology.bodies;
  const auto add = [&](const Mat6& K, int to, int from) {
    if (transposed)
      out.segment<6>(6 * from) += K.transpose() * x.segment<6>(6 * to);
    else
      out.segment<6>(6 * to) += K * x.segment<6>(6 * from);
  };
  for (int b = 0; b < topology.bodies; ++b) add(values.diagonal[b], b, b);
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    const linear::KktPair& pair = topology.pairs[p];
    const linear::KktValues::Pair& v = values.pairs[p];
    if (pair.a != kGround && pair.b != kGround) {
      add(v.K_ab, pair.a, pair.b);
      add(v.K_ba, pair.b, pair.a);
    }
    const int row = first_row + pair.first_row, rows = pair.rows;
    const auto add_rows_of = [&](int body, const auto& B, const auto& G) {
      if (body == kGround || rows == 0) return;
      const auto of_body = x.segment<6>(6 * body);
      const auto of_rows = x.segment(row, rows);
      if (transposed) {
        out.segment<6>(6 * body) += G.topRows(rows).transpose() * of_rows;
        out.segment(row, rows) -= B.leftCols(rows).transpose() * of_body;
      } else {
        out.segment<6>(6 * body) -= B.leftCols(rows) * of_rows;
        out.segment(row, rows) += G.topRows(rows) * of_body;
      }
    };
    add_rows_of(pair.a, v.B_a, v.G_a);
    add_rows_of(pair.b, v.B_b, v.G_b);
  }
}

}  // namespace polhode
