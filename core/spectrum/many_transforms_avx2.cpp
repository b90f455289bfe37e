#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/spectrum/many_transforms.h"

namespace imunoise {

#ifdef __AVX2__
namespace {
#include "core/spectrum/many_transforms.inl"
}  // namespace

const ManyTransforms* avx2_transforms() {
  static constexpr ManyTransforms kTable{transforms<double>, transforms<float>};
  return __builtin_cpu_supports("avx2") != 0 ? &kTable : nullptr;
}
#else
const ManyTransforms* avx2_transforms() { return nullptr; }
#endif

}  // namespace imunoise
