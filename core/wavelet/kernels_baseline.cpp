#include "core/wavelet/kernels.h"

namespace imunoise {
namespace {
#include "core/wavelet/kernels.inl"
}  // namespace

const Kernels& baseline_kernels() {
  static constexpr Kernels kTable{squares_double, squares_int,  squared_coefficients, biweight_sum,
                                  prefix_double,  prefix_int16, prefix_int32,         extent_int16,
                                  extent_int32,   "baseline"};
  return kTable;
}

const Kernels& kernels() {
  static const Kernels& best = avx2_kernels() != nullptr ? *avx2_kernels() : baseline_kernels();
  return best;
}

}  // namespace imunoise
