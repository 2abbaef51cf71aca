// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace polhode {

/// Scope in which denormal results of this thread are flushed to zero: the far ends of long chains
/// decay to such numbers, and arithmetic with them is a hundred times slower. (x86-64 only; other
/// machines do without.)
class DenormalsAreZero {
 public:
#if defined(__x86_64__)
  DenormalsAreZero() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kFlushToZero | kInputsToZero); }
  ~DenormalsAreZero() { _mm_setcsr(saved_); }
#else
  DenormalsAreZero() = default;
#endif
  DenormalsAreZero(const DenormalsAreZero&) = delete;
  DenormalsAreZero& operator=(const DenormalsAreZero&) = delete;

 private:
#if defined(__x86_64__)
  static constexpr unsigned kFlushToZero = 0x8000, kInputsToZero = 0x0040;
  unsigned saved_;
#endif
};

}  // namespace polhode
