// Body of the kernels, included by kernels_baseline.cpp and kernels_avx2.cpp inside a namespace of
// their own. Explicit vectors are 16 bytes wide in both; the other loops are left to the
// vectoriser.

using Doubles2 = double __attribute__((vector_size(16), aligned(8)));
using Ints4 = std::int32_t __attribute__((vector_size(16), aligned(4)));
using Mask2 = std::int64_t __attribute__((vector_size(16)));
using Mask4 = std::int32_t __attribute__((vector_size(16)));

template <class Vector, class Element>
inline Vector load(const Element* from) {
  Vector out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}

template <class Vector, class Element>
inline void store(Element* to, const Vector& value) {
  __builtin_memcpy(to, &value, sizeof value);
}

double squares_double(const double* a, const double* b, const double* c, std::size_t n) {
  constexpr std::size_t kLanes = 16;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): nothing inline of another header here
  double sum[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double middle = b[i + lane];
      const double w = (a[i + lane] - middle) + (c[i + lane] - middle);
      sum[lane] += w * w;
    }
  }
  double out = 0.0;
  for (const double lane : sum) out += lane;
  for (; i < n; ++i) {
    const double w = (a[i] - b[i]) + (c[i] - b[i]);
    out += w * w;
  }
  return out;
}

std::uint64_t squares_int(const std::int32_t* a, const std::int32_t* b, const std::int32_t* c,
                          std::size_t n) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::int32_t w = (a[i] - b[i]) + (c[i] - b[i]);
    const auto size = static_cast<std::uint32_t>(w < 0 ? -w : w);
    sum += static_cast<std::uint64_t>(size) * size;
  }
  return sum;
}

double squared_coefficients(const double* a, const double* b, const double* c, double unit,
                            std::size_t n, double* out) {
  constexpr std::size_t kLanes = 16;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays)
  double sum[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double middle = b[i + lane];
      const double w = ((a[i + lane] - middle) + (c[i + lane] - middle)) * unit;
      out[i + lane] = w * w;
      sum[lane] += w * w;
    }
  }
  double total = 0.0;
  for (const double lane : sum) total += lane;
  for (; i < n; ++i) {
    const double w = ((a[i] - b[i]) + (c[i] - b[i])) * unit;
    out[i] = w * w;
    total += w * w;
  }
  return total;
}

double biweight_sum(const double* w, double outer, std::size_t n, double* slope) {
  constexpr std::size_t kLanes = 8;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays)
  double values[kLanes] = {};
  // NOLINTNEXTLINE(modernize-avoid-c-arrays)
  double slopes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double x = w[i + lane];
      const double inside = 1.0 - x * outer;
      const double q = inside > 0.0 ? inside : 0.0;
      const double wq3 = x * q * q * q;
      values[lane] += wq3 * q;
      slopes[lane] += wq3 * (q - 4.0 * outer * x);
    }
  }
  double value = 0.0;
  *slope = 0.0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    value += values[lane];
    *slope += slopes[lane];
  }
  for (; i < n; ++i) {
    const double inside = 1.0 - w[i] * outer;
    const double q = inside > 0.0 ? inside : 0.0;
    value += w[i] * q * q * q * q;
    *slope += w[i] * q * q * q * (q - 4.0 * outer * w[i]);
  }
  return value;
}

// Both forms write inclusive sums one place on: out[i + 1] = out[i] + x[i].
void prefix_double(const double* x, double origin, double start, double* out, std::size_t n) {
  out[0] = start;
  Doubles2 carry = {0.0, 0.0};
  std::size_t i = 0;
  for (; i + 5 <= n; i += 4) {
    Doubles2 low = load<Doubles2>(x + i) - origin;
    Doubles2 high = load<Doubles2>(x + i + 2) - origin;
    low += __builtin_shufflevector(low, Doubles2{0.0, 0.0}, 2, 0);
    high += __builtin_shufflevector(high, Doubles2{0.0, 0.0}, 2, 0);
    high += __builtin_shufflevector(low, low, 1, 1);
    store(out + i + 1, (low + carry) + start);
    store(out + i + 3, (high + carry) + start);
    carry += __builtin_shufflevector(high, high, 1, 1);
  }
  double sum = carry[0];
  for (; i + 1 < n; ++i) {
    sum += x[i] - origin;
    out[i + 1] = sum + start;
  }
}

template <class Sample>
inline void prefix_counts(const Sample* x, std::int32_t origin, std::int32_t start,
                          std::int32_t* out, std::size_t n) {
  out[0] = start;
  Ints4 carry = {start, start, start, start};
  std::size_t i = 0;
  for (; i + 5 <= n; i += 4) {
    Ints4 v = {x[i], x[i + 1], x[i + 2], x[i + 3]};
    v -= origin;
    v += __builtin_shufflevector(v, Ints4{}, 4, 0, 1, 2);
    v += __builtin_shufflevector(v, Ints4{}, 4, 5, 0, 1);
    store(out + i + 1, v + carry);
    carry += __builtin_shufflevector(v, v, 3, 3, 3, 3);
  }
  std::int32_t sum = carry[0];
  for (; i + 1 < n; ++i) {
    sum += x[i] - origin;
    out[i + 1] = sum;
  }
}

template <class Sample, class Sum>
inline void extent_of(const Sample* x, std::size_t n, Extent* out) {
  Sample least = x[0];
  Sample most = x[0];
  Sum sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    least = x[i] < least ? x[i] : least;
    most = x[i] > most ? x[i] : most;
    sum += x[i];
  }
  *out = {least, most, sum};
}

void extent_int16(const std::int16_t* x, std::size_t n, Extent* out) {
  extent_of<std::int16_t, std::int32_t>(x, n, out);
}

void extent_int32(const std::int32_t* x, std::size_t n, Extent* out) {
  extent_of<std::int32_t, std::int64_t>(x, n, out);
}

void prefix_int16(const std::int16_t* x, std::int32_t origin, std::int32_t start, std::int32_t* out,
                  std::size_t n) {
  prefix_counts(x, origin, start, out, n);
}

void prefix_int32(const std::int32_t* x, std::int32_t origin, std::int32_t start, std::int32_t* out,
                  std::size_t n) {
  prefix_counts(x, origin, start, out, n);
}
