// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <dmumps_c.h>
#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <mutex>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/linear/mumps.hpp>

namespace polhode::linear {

namespace {

using Entry = void (*)(DMUMPS_STRUC_C*);

/// Address space that OpenBLAS takes when it is loaded, for good, and that of the code [bytes].
constexpr std::size_t kBlasBuffer = std::size_t{128} << 20, kCode = std::size_t{96} << 20;

/// @throws SolveError if a limit of the process leaves too little for OpenBLAS, which would try for
/// ever to have its buffer
void require_address_space() {
  void* const space = mmap(nullptr, kBlasBuffer + kCode, PROT_READ | PROT_WRITE,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (space == MAP_FAILED)
    throw SolveError(format("The solver of solids needs {} MB of memory at once, which this "
                            "process may not have",
                            (kBlasBuffer + kCode) >> 20),
                     "Raise its limit, which 'ulimit -v' shows");
  munmap(space, kBlasBuffer + kCode);
}

/// A variable of the environment that has a value during this object's life, unless it has one.
class WhileSet {
 public:
  WhileSet(const char* name, const char* value) : name_(getenv(name) ? nullptr : name) {
    if (name_) setenv(name, value, 0);
  }
  ~WhileSet() {
    if (name_) unsetenv(name_);
  }
  WhileSet(const WhileSet&) = delete;
  WhileSet& operator=(const WhileSet&) = delete;

 private:
  const char* name_;
};

/// The library, loaded once. OpenBLAS starts its threads when it is loaded, and none of them works.
Entry load() {
  require_address_space();
  const WhileSet alone("OPENBLAS_NUM_THREADS", "1");
  void* library = dlopen(POLHODE_MUMPS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  if (!library)
    throw InputError("solids", format("need the MUMPS library: {}", dlerror()),
                     format("Install {} (Debian: libmumps-seq)", POLHODE_MUMPS_LIBRARY));
  using SetThreads = void (*)(int);
  if (auto one = reinterpret_cast<SetThreads>(dlsym(library, "openblas_set_num_threads"))) one(1);
  return reinterpret_cast<Entry>(dlsym(library, "dmumps_c"));
}

/// Serialises calls: MUMPS stores tables in module variables.
void call_alone(Entry entry, DMUMPS_STRUC_C* m) {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> alone(one_at_a_time);
  entry(m);
}

constexpr int kUseCommWorld = -987654;  // value required by MUMPS without MPI
constexpr const char* kTooLarge = "Run a coarser mesh, or on a machine with more memory";
constexpr int kInitialise = -1, kEnd = -2, kAnalyse = 1, kFactor = 2, kSolve = 3;
// Errors of MUMPS that more workspace avoids, and those of a singular matrix.
constexpr int kWorkspaceTooSmall = -9, kIntegersTooSmall = -8, kSingular = -10, kStructural = -6;

}  // namespace

struct Mumps::Impl {
  mutable DMUMPS_STRUC_C m;
  Entry call;
  std::vector<MUMPS_INT> rows, columns;
  std::vector<double> values;
  std::vector<MUMPS_INT> null_list;
  bool started = false, factored = false;

  explicit Impl(Symmetry symmetry) {
    static const Entry entry = load();
    call = entry;
    std::memset(&m, 0, sizeof m);
    m.comm_fortran = kUseCommWorld;
    m.par = 1;
    m.sym = symmetry == Symmetry::symmetric ? 2 : 0;
    m.job = kInitialise;
    call_alone(call, &m);
    started = true;
    for (int k = 1; k <= 4; ++k) control(k) = k < 4 ? -1 : 0;  // silent
    control(14) = 30;                                          // workspace: 30 % more than planned
  }
  ~Impl() {
    if (!started) return;
    m.job = kEnd;
    call_alone(call, &m);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  MUMPS_INT& control(int k) const { return m.icntl[k - 1]; }

  void solve(double* x, int count, bool transposed) const {
    POLHODE_ASSERT(factored);
    control(9) = transposed ? 0 : 1;
    m.rhs = x;
    m.nrhs = count;
    m.lrhs = m.n;
    m.job = kSolve;
    call_alone(call, &m);
    if (m.infog[0] < 0)
      throw SolveError(
          format("The tangent matrix of the nodes could not be solved (MUMPS {})", m.infog[0]),
          kTooLarge);
  }
};

Mumps::Mumps(Symmetry symmetry) : impl_(std::make_unique<Impl>(symmetry)) {}
Mumps::~Mumps() = default;
Mumps::Mumps(Mumps&&) noexcept = default;

void Mumps::analyse(int n, const std::vector<int>& rows, const std::vector<int>& columns) {
  Impl& s = *impl_;
  POLHODE_ASSERT(rows.size() == columns.size());
  s.factored = false;
  s.rows.resize(rows.size());
  s.columns.resize(columns.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    POLHODE_ASSERT(rows[k] >= 0 && rows[k] < n && columns[k] >= 0 && columns[k] < n);
    s.rows[k] = rows[k] + 1;
    s.columns[k] = columns[k] + 1;
  }
  s.values.assign(rows.size(), 0.0);
  s.m.n = n;
  s.m.nnz = static_cast<MUMPS_INT8>(rows.size());
  s.m.irn = s.rows.data();
  s.m.jcn = s.columns.data();
  s.m.a = s.values.data();
  s.m.job = kAnalyse;
  call_alone(s.call, &s.m);
  if (s.m.infog[0] == kStructural)
    throw SolveError("The tangent matrix of the nodes is singular by its pattern",
                     "Look for bodies and solids that nothing holds");
  if (s.m.infog[0] < 0)
    throw SolveError(format("The tangent matrix of the nodes could not be analysed (MUMPS {}, {})",
                            s.m.infog[0], s.m.infog[1]),
                     kTooLarge);
}

bool Mumps::factor(const double* values) {
  Impl& s = *impl_;
  s.factored = false;
  std::copy(values, values + s.values.size(), s.values.begin());
  for (int attempt = 0; attempt < 5; ++attempt) {
    s.m.job = kFactor;
    call_alone(s.call, &s.m);
    const int error = s.m.infog[0];
    s.factored = error >= 0;
    if (s.factored) return true;
    if (error == kSingular) return false;
    if (error != kWorkspaceTooSmall && error != kIntegersTooSmall)
      throw SolveError(
          format("The tangent matrix of the nodes could not be factored (MUMPS {}, {})", error,
                 s.m.infog[1]),
          kTooLarge);
    s.control(14) *= 2;
  }
  return false;  // hardly any pivot is found, and the others are postponed without end
}

void Mumps::solve(double* x, int count) const { impl_->solve(x, count, false); }
void Mumps::solve_transposed(double* x, int count) const { impl_->solve(x, count, true); }
int Mumps::negative_pivots() const { return impl_->m.infog[11]; }
double Mumps::factor_flops() const { return impl_->m.rinfog[2]; }
double Mumps::factor_entries() const {
  const MUMPS_INT n = impl_->m.infog[28];  // in millions if negative
  return n < 0 ? -1e6 * n : n;
}
void Mumps::find_null_pivots(bool yes) { impl_->control(24) = yes ? 1 : 0; }

std::vector<int> Mumps::null_pivots() const {
  const Impl& s = *impl_;
  std::vector<int> list;
  list.reserve(s.m.infog[27]);
  for (int k = 0; k < s.m.infog[27]; ++k) list.push_back(s.m.pivnul_list[k] - 1);
  return list;
}

}  // namespace polhode::linear
