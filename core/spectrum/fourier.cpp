#include "core/spectrum/fourier.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/FFT>

#include "core/spectrum/many_transforms.h"
#include "core/spectrum/roots_of_unity.h"

namespace imunoise {
namespace {

template <class Number>
using Complex = std::complex<Number>;

// Each thread keeps the twiddle factors of the lengths that it used last.
template <class Number>
class Plans {
 public:
  static Eigen::FFT<Number>& of(std::size_t n) {
    thread_local Plans plans;  // a cache, of no consequence
    return plans.kept(n);
  }

 private:
  Eigen::FFT<Number>& kept(std::size_t n) {
    constexpr std::size_t kMostKept = 16;
    if (std::find(lengths_.begin(), lengths_.end(), n) == lengths_.end()) {
      if (lengths_.size() == kMostKept) *this = Plans();
      lengths_.push_back(n);
    }
    return transform_;
  }

  std::vector<std::size_t> lengths_;
  Eigen::FFT<Number> transform_;
};

// Of n complex numbers; the inverse without its factor 1/n.
template <class Number>
void transform_at_once(const Complex<Number>* x, std::size_t n, bool inverse,
                       Complex<Number>* out) {
  if (n == 1) {
    *out = *x;
    return;
  }
  Eigen::FFT<Number>& plan = Plans<Number>::of(n);
  plan.SetFlag(Eigen::FFT<Number>::Unscaled);
  const auto count = static_cast<Eigen::Index>(n);
  if (inverse) {
    plan.inv(out, x, count);
  } else {
    plan.fwd(out, x, count);
  }
}

// The largest divisor of n that is at most its root.
std::size_t middle_divisor(std::size_t n) {
  auto out = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  while (n % out != 0) --out;
  return out;
}

void many(const Row<double>* x, std::size_t n, bool inverse, Row<double>* out) {
  many_transforms().of_doubles(x, n, inverse, out);
}
void many(const Row<float>* x, std::size_t n, bool inverse, Row<float>* out) {
  many_transforms().of_floats(x, n, inverse, out);
}

// Up to kMost series of n complex numbers, each a lane of a group, and their transforms.
template <class Number>
class Series {
 public:
  static constexpr std::size_t kMost = 16;

  explicit Series(std::size_t n) : n_(n), from_(kGroups * 2 * n), to_(kGroups * 2 * n) {}

  void set(std::size_t series, std::size_t j, Complex<Number> x) {
    Row<Number>* const row = &from_[place(series, j)];
    row[0].lanes[series % kLanes] = x.real();
    row[1].lanes[series % kLanes] = x.imag();
  }
  Complex<Number> get(std::size_t series, std::size_t j) const {
    const Row<Number>* const row = &to_[place(series, j)];
    return {row[0].lanes[series % kLanes], row[1].lanes[series % kLanes]};
  }
  // The first `count` series; lanes without one are transformed for nothing.
  void transform(std::size_t count, bool inverse) {
    for (std::size_t begin = 0; begin < count; begin += kLanes)
      many(&from_[place(begin, 0)], n_, inverse, &to_[place(begin, 0)]);
  }

 private:
  static constexpr std::size_t kLanes = Row<Number>::kLanes;
  static constexpr std::size_t kGroups = kMost / kLanes;
  std::size_t place(std::size_t series, std::size_t j) const {
    return 2 * (series / kLanes * n_ + j);
  }

  std::size_t n_;
  std::vector<Row<Number>> from_;
  std::vector<Row<Number>> to_;
};

// The same, x being overwritten. Of many numbers the transform does not fit the cache: laid out as
// rows × columns it is a transform of each column, a rotation of each number and a transform of
// each row, read out by columns (Bailey 1990); a few columns, or rows, are transformed at once.
template <class Number>
void transform(Complex<Number>* x, std::size_t n, bool inverse, Complex<Number>* out) {
  constexpr std::size_t kFits = 4096;
  const std::size_t rows = middle_divisor(n);
  if (n <= kFits || rows == 1) return transform_at_once(x, n, inverse, out);
  constexpr std::size_t kMost = Series<Number>::kMost;
  const std::size_t columns = n / rows;
  const RootsOfUnity roots(n);
  Series<Number> down(rows);
  for (std::size_t begin = 0; begin < columns; begin += kMost) {
    const std::size_t count = std::min(kMost, columns - begin);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < count; ++c) down.set(c, r, x[r * columns + begin + c]);
    }
    down.transform(count, inverse);
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < count; ++c) {
        const std::complex<double> root = roots(r * (begin + c));
        x[r * columns + begin + c] =
            down.get(c, r) * static_cast<Complex<Number>>(inverse ? root : std::conj(root));
      }
    }
  }
  Series<Number> across(columns);
  for (std::size_t begin = 0; begin < rows; begin += kMost) {
    const std::size_t count = std::min(kMost, rows - begin);
    for (std::size_t r = 0; r < count; ++r) {
      for (std::size_t c = 0; c < columns; ++c) across.set(r, c, x[(begin + r) * columns + c]);
    }
    across.transform(count, inverse);
    for (std::size_t c = 0; c < columns; ++c) {
      for (std::size_t r = 0; r < count; ++r) out[c * rows + begin + r] = across.get(r, c);
    }
  }
}

// An even number of real ones are half as many complex ones, z_j = x_2j + i x_2j+1. With E and O
// the transforms of those at even and odd places, Z = E + iO and X_k = E_k + w O_k, w =
// e^{-2πik/n}, where E and O at h - k are the conjugates of those at k, h = n/2. From the numbers a
// at k and b at h - k this makes f (a + b* ± (a - b*) v) there, the second of them conjugated: with
// v = -iw X of Z, with v = iw* Z of X.
template <class Number>
void recombine(std::vector<Complex<Number>>& x, std::size_t n, Number f, bool inverse) {
  const RootsOfUnity roots(n);
  const std::size_t half = n / 2;
  for (std::size_t k = 0; 2 * k <= half; ++k) {
    const std::complex<double> root = roots(k);  // w*
    const auto vr = static_cast<Number>(-root.imag());
    const auto vi = static_cast<Number>(inverse ? root.real() : -root.real());
    Complex<Number>& a = x[k];
    Complex<Number>& b = x[half - k];
    const Number er = f * (a.real() + b.real());
    const Number ei = f * (a.imag() - b.imag());
    const Number dr = f * (a.real() - b.real());
    const Number di = f * (a.imag() + b.imag());
    const Number odd_r = dr * vr - di * vi;
    const Number odd_i = dr * vi + di * vr;
    a = {er + odd_r, ei + odd_i};
    b = {er - odd_r, odd_i - ei};
  }
}

}  // namespace

std::vector<std::complex<double>> half_spectrum(std::vector<double> x) {
  const std::size_t n = x.size();
  if (n % 2 != 0) {
    std::vector<std::complex<double>> whole(x.begin(), x.end());
    std::vector<std::complex<double>> out(n);
    transform(whole.data(), n, false, out.data());
    out.resize(n / 2 + 1);
    return out;
  }
  std::vector<std::complex<double>> out(n / 2 + 1);
  transform(reinterpret_cast<std::complex<double>*>(x.data()), n / 2, false, out.data());
  out.back() = out.front();
  recombine(out, n, 0.5, false);
  return out;
}

template <class Number>
std::vector<Number> from_half_spectrum(std::vector<std::complex<Number>> spectrum, std::size_t n) {
  const auto scale = static_cast<Number>(1.0 / static_cast<double>(n));
  std::vector<Number> out(n);
  if (n % 2 != 0) {
    for (std::size_t k = n / 2; k > 0; --k) spectrum.push_back(std::conj(spectrum[k]));
    std::vector<std::complex<Number>> whole(n);
    transform(spectrum.data(), n, true, whole.data());
    for (std::size_t t = 0; t < n; ++t) out[t] = scale * whole[t].real();
    return out;
  }
  recombine(spectrum, n, scale, true);
  transform(spectrum.data(), n / 2, true, reinterpret_cast<std::complex<Number>*>(out.data()));
  return out;
}

template std::vector<double> from_half_spectrum(std::vector<std::complex<double>>, std::size_t);
template std::vector<float> from_half_spectrum(std::vector<std::complex<float>>, std::size_t);

}  // namespace imunoise
