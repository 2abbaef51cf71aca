// SPDX-License-Identifier: Apache-2.0
#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/solve/block_lu.hpp>
#include <polhode/solve/kkt.hpp>
#include <polhode/solve/sparse_solvers.hpp>

namespace polhode {

std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name) {
  if (name == "block_lu") return std::make_unique<BlockLu>();
  if (name == "klu") return make_klu_solver();
  if (name == "sparse_lu") return make_sparse_lu();
  throw InputError("linear_solver", format("'{}' is not known", name),
                   "Use one of: block_lu, klu, sparse_lu");
}

}  // namespace polhode
