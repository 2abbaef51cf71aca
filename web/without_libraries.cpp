// SPDX-License-Identifier: Apache-2.0
// Linear solvers in a web page, which has neither SuiteSparse nor MUMPS.
#include <polhode/core/error.hpp>
#include <polhode/linear/mumps.hpp>
#include <polhode/linear/sparse_solvers.hpp>

namespace polhode::linear {

std::unique_ptr<LinearSolver> make_klu_solver() {
  throw InputError("linear_solver", "'klu' is missing in a web page",
                   "Use one of: block_lu, sparse_lu");
}

struct Mumps::Impl {};

Mumps::Mumps(Symmetry) {
  throw InputError("solids", "need the MUMPS library, which a web page has not",
                   "Run models with deformable solids outside of it");
}
Mumps::~Mumps() = default;
Mumps::Mumps(Mumps&&) noexcept = default;
// Functions of objects that do not exist.
void Mumps::analyse(int, const std::vector<int>&, const std::vector<int>&) {}
bool Mumps::factor(const double*) { return false; }
void Mumps::solve(double*, int) const {}
void Mumps::solve_transposed(double*, int) const {}
int Mumps::negative_pivots() const { return 0; }
double Mumps::factor_flops() const { return 0.0; }
double Mumps::factor_entries() const { return 0.0; }
void Mumps::find_null_pivots(bool) {}
std::vector<int> Mumps::null_pivots() const { return {}; }

}  // namespace polhode::linear
