#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/spectrum/many_transforms.h"

namespace imunoise {
namespace {
#include "core/spectrum/many_transforms.inl"
}  // namespace

const ManyTransforms& baseline_transforms() {
  static constexpr ManyTransforms kTable{transforms<double>, transforms<float>};
  return kTable;
}

const ManyTransforms& many_transforms() {
  static const ManyTransforms& best =
      avx2_transforms() != nullptr ? *avx2_transforms() : baseline_transforms();
  return best;
}

}  // namespace imunoise
