#include "core/spectrum/fourier.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace imunoise {
namespace {

// Twiddle factors cost as much as a transform, and a recording's replicates have one length: each
// thread keeps those of the lengths that it used last.
template <class Number>
class Plans {
 public:
  static Eigen::FFT<Number>& of(std::size_t n) {
    thread_local Plans plans;  // a cache, of no consequence
    return plans.kept(n);
  }

 private:
  Eigen::FFT<Number>& kept(std::size_t n) {
    constexpr std::size_t kMostKept = 4;
    if (std::find(lengths_.begin(), lengths_.end(), n) == lengths_.end()) {
      if (lengths_.size() == kMostKept) *this = Plans();
      lengths_.push_back(n);
    }
    transform_.SetFlag(Eigen::FFT<Number>::HalfSpectrum);
    return transform_;
  }

  std::vector<std::size_t> lengths_;
  Eigen::FFT<Number> transform_;
};

using Turns = std::vector<std::complex<double>>;

// Products of two short tables: a sine for each would take as long as the transform.
Turns turns_of(std::size_t n) {
  constexpr std::size_t kStretch = 512;
  const double angle = 0.5 * std::numbers::pi / static_cast<double>(n);
  Turns within(kStretch);
  for (std::size_t k = 0; k < kStretch; ++k)
    within[k] = std::polar(1.0, angle * static_cast<double>(k));
  Turns out(n / 2 + 1);
  for (std::size_t begin = 0; begin < out.size(); begin += kStretch) {
    const std::complex<double> first = std::polar(1.0, angle * static_cast<double>(begin));
    const std::size_t end = std::min(out.size(), begin + kStretch);
    for (std::size_t k = begin; k < end; ++k) out[k] = first * within[k - begin];
  }
  return out;
}

}  // namespace

std::vector<std::complex<double>> half_spectrum(std::span<const double> x) {
  std::vector<std::complex<double>> out(x.size() / 2 + 1);
  Plans<double>::of(x.size()).fwd(out.data(), x.data(), static_cast<Eigen::Index>(x.size()));
  return out;
}

template <class Number>
std::vector<Number> from_half_spectrum(const std::vector<std::complex<Number>>& spectrum,
                                       std::size_t n) {
  std::vector<Number> out(n);
  Plans<Number>::of(n).inv(out.data(), spectrum.data(), static_cast<Eigen::Index>(n));
  return out;
}

template std::vector<double> from_half_spectrum(const std::vector<std::complex<double>>&,
                                                std::size_t);
template std::vector<float> from_half_spectrum(const std::vector<std::complex<float>>&,
                                               std::size_t);

std::shared_ptr<const Turns> quarter_turns(std::size_t n) {
  constexpr std::size_t kMostKept = 4;
  static std::mutex mutex;
  static std::deque<std::pair<std::size_t, std::shared_ptr<const Turns>>> kept;  // newest first
  const std::lock_guard lock(mutex);
  const auto found =
      std::find_if(kept.begin(), kept.end(), [&](const auto& one) { return one.first == n; });
  if (found != kept.end()) return found->second;
  kept.emplace_front(n, std::make_shared<const Turns>(turns_of(n)));
  if (kept.size() > kMostKept) kept.pop_back();
  return kept.front().second;
}

}  // namespace imunoise
