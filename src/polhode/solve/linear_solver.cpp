// SPDX-License-Identifier: Apache-2.0
#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/solve/block_lu.hpp>
#include <polhode/solve/kkt.hpp>
#include <polhode/solve/klu_solver.hpp>
#include <polhode/solve/sparse_lu.hpp>

namespace polhode {

std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name) {
  if (name == "block_lu") return std::make_unique<BlockLu>();
  if (name == "klu") return std::make_unique<KluSolver>();
  if (name == "sparse_lu") return std::make_unique<SparseLu>();
  throw InputError("linear_solver", format("'{}' is not known", name),
                   "Use one of: block_lu, klu, sparse_lu");
}

}  // namespace polhode
