#pragma once

// The innermost loops of the wavelet variance, compiled once for every x86-64 and once for AVX2.
// Both give the same bits: sums run in 16 fixed lanes whatever the vector width, without fused
// multiply-add. Plain pointers only, so that no inline function of the AVX2 copy leaks out.

#include <cstddef>
#include <cstdint>

namespace imunoise {

/// Samples per block of prefix sums.
inline constexpr std::size_t kBlock = 1024;

/// What one block of counts spans.
struct Extent {
  std::int64_t least;
  std::int64_t most;
  std::int64_t sum;
};

struct Kernels {
  // Σ (a[i] - 2 b[i] + c[i])², i < n ≤ kBlock: the squared Haar coefficients of one block, times
  // 4m². The integer form needs |a - 2b + c| ≤ 2^26, so that the sum of a block fits.
  double (*squares_double)(const double* a, const double* b, const double* c, std::size_t n);
  std::uint64_t (*squares_int)(const std::int32_t* a, const std::int32_t* b, const std::int32_t* c,
                               std::size_t n);

  // out[i] = (unit (a[i] - 2 b[i] + c[i]))², i < n. Returns their sum.
  double (*squared_coefficients)(const double* a, const double* b, const double* c, double unit,
                                 std::size_t n, double* out);
  // With q = max(0, 1 - outer·w[i]), i < n: Σ w q⁴, and Σ w q³ (q - 4 outer·w) behind `slope`.
  double (*biweight_sum)(const double* w, double outer, std::size_t n, double* slope);

  // Prefix sums out[i] = start + Σ_{u<i} (x[u] - origin), 0 ≤ i < n ≤ kBlock, n ≥ 1.
  void (*prefix_double)(const double* x, double origin, double start, double* out, std::size_t n);
  void (*prefix_int16)(const std::int16_t* x, std::int32_t origin, std::int32_t start,
                       std::int32_t* out, std::size_t n);
  void (*prefix_int32)(const std::int32_t* x, std::int32_t origin, std::int32_t start,
                       std::int32_t* out, std::size_t n);

  // Least, most and sum of n ≥ 1 counts.
  void (*extent_int16)(const std::int16_t* x, std::size_t n, Extent* out);
  void (*extent_int32)(const std::int32_t* x, std::size_t n, Extent* out);

  const char* name;
};

/// For any x86-64 processor (and any other).
const Kernels& baseline_kernels();
/// Null where the build or the processor lacks AVX2.
const Kernels* avx2_kernels();
/// The best for this processor.
const Kernels& kernels();

}  // namespace imunoise
