#pragma once

// Several Fourier transforms at once, a lane of a vector each: compiled once for every x86-64 and
// once for AVX2. Both give the same bits as one transform alone, for neither uses fused
// multiply-add. Nothing inline of other headers, so that no function of the AVX2 copy leaks out.

#include <cstddef>

namespace imunoise {

/// One number of each transform.
template <class Number>
struct alignas(32) Row {
  static constexpr std::size_t kLanes = 32 / sizeof(Number);
  Number lanes[kLanes];  // NOLINT(modernize-avoid-c-arrays)
};

/// Of n complex numbers each: the real parts of number j lie in row 2j, the imaginary ones in row
/// 2j + 1. The result lies likewise behind `out`, which is other memory; the inverse lacks its
/// factor 1/n.
struct ManyTransforms {
  void (*of_doubles)(const Row<double>* x, std::size_t n, bool inverse, Row<double>* out);
  void (*of_floats)(const Row<float>* x, std::size_t n, bool inverse, Row<float>* out);
};

/// For any processor.
const ManyTransforms& baseline_transforms();
/// Null where the build or the processor lacks AVX2.
const ManyTransforms* avx2_transforms();
/// The best for this processor.
const ManyTransforms& many_transforms();

}  // namespace imunoise
