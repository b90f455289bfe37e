// Body of the transforms, included by many_transforms_baseline.cpp and many_transforms_avx2.cpp
// inside a namespace of their own. Eigen's transform (kissfft) computes with any type of numbers:
// here each is a vector, so that one pass makes as many transforms as the vector has lanes.

template <class Number>
struct Vector;
template <>
struct Vector<double> {
  using Type = double __attribute__((vector_size(32)));
};
template <>
struct Vector<float> {
  using Type = float __attribute__((vector_size(32)));
};

template <class Number>
struct Lanes {
  Lanes() = default;
  Lanes(Number x) : v(typename Vector<Number>::Type{} + x) {}  // NOLINT: as a number is

  Lanes& operator+=(const Lanes& o) { return v += o.v, *this; }
  Lanes& operator-=(const Lanes& o) { return v -= o.v, *this; }
  Lanes& operator*=(const Lanes& o) { return v *= o.v, *this; }
  friend Lanes operator+(Lanes a, const Lanes& b) { return a += b; }
  friend Lanes operator-(Lanes a, const Lanes& b) { return a -= b; }
  friend Lanes operator*(Lanes a, const Lanes& b) { return a *= b; }
  friend Lanes operator-(Lanes a) { return a.v = -a.v, a; }

  typename Vector<Number>::Type v;
};

template <class Number>
using Plan = Eigen::internal::kiss_cpx_fft<Lanes<Number>>;

// Each thread keeps the twiddle factors of the lengths that it used last.
template <class Number>
Plan<Number>& plan_of(std::size_t n, bool inverse) {
  struct Kept {
    std::size_t n = 0;
    bool inverse = false;
    Plan<Number> plan;
  };
  constexpr std::size_t kMostKept = 16;
  // NOLINTNEXTLINE(modernize-avoid-c-arrays): nothing inline of another header here
  thread_local Kept kept[kMostKept];  // a cache, of no consequence
  thread_local std::size_t next = 0;
  for (Kept& one : kept) {
    if (one.n == n && one.inverse == inverse) return one.plan;
  }
  Kept& out = kept[next];
  next = (next + 1) % kMostKept;
  out = Kept{n, inverse, {}};
  out.plan.make_twiddles(static_cast<int>(n), inverse);
  out.plan.factorize(static_cast<int>(n));
  return out.plan;
}

template <class Number>
void transforms(const Row<Number>* x, std::size_t n, bool inverse, Row<Number>* out) {
  using Complex = std::complex<Lanes<Number>>;
  static_assert(sizeof(Complex) == 2 * sizeof(Row<Number>));
  const auto* from = reinterpret_cast<const Complex*>(x);
  plan_of<Number>(n, inverse).work(0, reinterpret_cast<Complex*>(out), from, 1, 1);
}
