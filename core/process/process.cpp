#include "core/process/process.h"

#include <optional>

namespace imunoise {
namespace {

template <class P>
concept Structured = requires(const P p) {
  { p.structure() } -> std::same_as<int>;
  { P::with_structure(1) } -> std::same_as<P>;
};

// Noise through a filter of finitely many taps. Its spectrum may be zero somewhere, and is not
// straight over a band there.
template <class P>
concept HasZeros = requires(const P p) {
  p.filter().taps();
};

// The mean of such a spectrum over each band, in place of its value in the middle: by two points
// that scatter as the band's frequencies do (Gauss and Legendre), exact for cubic polynomials.
template <class P>
void average_over_bands(const P& process, const Frequencies& f, Eigen::ArrayXd& out) {
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double off = f.deviation(i);
    if (off == 0.0) continue;
    out(i) =
        0.5 * (process.spectrum(Frequency(f(i) - off)) + process.spectrum(Frequency(f(i) + off)));
  }
}

// The least number that NAME(n) may hold.
template <class P>
constexpr int smallest() {
  if constexpr (requires { P::kSmallest; }) {
    return P::kSmallest;
  } else {
    return 1;
  }
}

template <class... P>
std::vector<Process> one_of_each(const std::variant<P...>*) {
  return {Process(P{})...};
}

}  // namespace

const ProcessInfo& info(const Process& process) {
  return std::visit([](const auto& p) -> const ProcessInfo& { return p.kInfo; }, process);
}
std::vector<ParameterInfo> parameters(const Process& process) {
  return std::visit([](const auto& p) { return p.parameters(); }, process);
}
std::vector<double> values(const Process& process) {
  return std::visit([](const auto& p) { return p.values(); }, process);
}
void set_values(Process& process, std::span<const double> values) {
  std::visit([&](auto& p) { p.set_values(values); }, process);
}
Eigen::ArrayXd shape(const Process& process, HalfWidths m) {
  return std::visit([&](const auto& p) { return p.shape(m); }, process);
}
Eigen::ArrayXXd shape_jacobian(const Process& process, HalfWidths m) {
  return std::visit([&](const auto& p) { return p.shape_jacobian(m); }, process);
}
double spectrum(const Process& process, const Frequency& f) {
  return std::visit([&](const auto& p) { return p.spectrum(f); }, process);
}
int taps(const Process& process) {
  return std::visit(
      [](const auto& p) {
        if constexpr (HasZeros<std::decay_t<decltype(p)>>) {
          return static_cast<int>(p.filter().taps().size());
        } else {
          return 0;
        }
      },
      process);
}
Eigen::ArrayXd spectrum(const Process& process, const Frequencies& f) {
  return std::visit(
      [&](const auto& p) -> Eigen::ArrayXd {
        if constexpr (requires { p.spectra(f); }) {
          return p.spectra(f);
        } else {
          Eigen::ArrayXd out(f.size());
          for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = p.spectrum(f.at(i));
          if constexpr (HasZeros<std::decay_t<decltype(p)>>) average_over_bands(p, f, out);
          return out;
        }
      },
      process);
}
SumCovariance sum_covariance(const Process& process) {
  return std::visit([](const auto& p) { return p.sum_covariance(); }, process);
}
std::vector<DerivedQuantity> derived(const Process& process, Hertz rate) {
  return std::visit([&](const auto& p) { return p.derived(rate); }, process);
}
std::vector<std::vector<double>> scan(const Process& process, const Scales& scales) {
  return std::visit([&](const auto& p) { return p.scan(scales); }, process);
}
void add_samples(const Process& process, RandomStream& rng, std::span<double> out) {
  std::visit(
      [&](const auto& p) {
        if constexpr (requires { p.add_samples(rng, out); }) {
          p.add_samples(rng, out);
        } else {
          auto recursion = p.recursion(rng);
          for (double& x : out) x += recursion.next(rng);
        }
      },
      process);
}

int structure(const Process& process) {
  return std::visit(
      [](const auto& p) {
        if constexpr (Structured<std::decay_t<decltype(p)>>) return p.structure();
        return 0;
      },
      process);
}

Eigen::ArrayXd variance(const Process& process, HalfWidths m) {
  return values(process).front() * shape(process, m);
}

Eigen::ArrayXXd jacobian(const Process& process, HalfWidths m) {
  const Eigen::ArrayXXd by_shape = shape_jacobian(process, m);
  Eigen::ArrayXXd out(m.size(), 1 + by_shape.cols());
  out.col(0) = shape(process, m);
  out.rightCols(by_shape.cols()) = values(process).front() * by_shape;
  return out;
}

const std::vector<Process>& known_processes() {
  static const std::vector<Process> kKnown = one_of_each(static_cast<const Process*>(nullptr));
  return kKnown;
}

std::optional<Process> with_structure(const Process& process, int number) {
  return std::visit(
      [&](const auto& p) -> std::optional<Process> {
        using P = std::decay_t<decltype(p)>;
        if constexpr (Structured<P>) {
          if (number >= smallest<P>() && number <= P::kLargest) return P::with_structure(number);
        }
        return std::nullopt;
      },
      process);
}

}  // namespace imunoise
