// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/linear/block_lu.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/linear/sparse_solvers.hpp>

namespace polhode::linear {

std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name) {
  if (name == "block_lu") return std::make_unique<BlockLu>();
  if (name == "klu") return make_klu_solver();
  if (name == "sparse_lu") return make_sparse_lu();
  throw InputError("analysis.solver", format("'{}' is not known", name),
                   "Use one of: automatic, tree, block_lu, klu, sparse_lu");
}

}  // namespace polhode::linear
