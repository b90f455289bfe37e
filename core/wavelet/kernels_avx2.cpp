#include "core/wavelet/kernels.h"

namespace imunoise {

#ifdef __AVX2__
namespace {
#include "core/wavelet/kernels.inl"
}  // namespace

const Kernels* avx2_kernels() {
  static constexpr Kernels kTable{squares_double, squares_int,  squared_coefficients, biweight_sum,
                                  prefix_double,  prefix_int16, prefix_int32,         extent_int16,
                                  extent_int32,   "AVX2"};
  return __builtin_cpu_supports("avx2") != 0 ? &kTable : nullptr;
}
#else
const Kernels* avx2_kernels() { return nullptr; }
#endif

}  // namespace imunoise
