#include "core/wavelet/moment_covariance.h"

#include <array>
#include <deque>
#include <memory>
#include <mutex>

#include "core/wavelet/lag_sums.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// White noise, random walk and flicker noise, whose shapes have no parameter.
constexpr std::size_t kShapes = 3;

bool has_flicker_and_shapes_alone(const SumCovariance& process) {
  return process.flicker > 0.0 && process.near.empty() && process.exponentials.empty();
}

// Their sums over lags depend on scales and samples alone, and flicker noise's take by far the
// longest of a fit: those asked for last are kept.
std::shared_ptr<const LagSums> sums_of_shapes(const Scales& scales, std::size_t samples) {
  struct Kept {
    Scales scales;
    std::size_t samples;
    std::shared_ptr<const LagSums> sums;
  };
  constexpr std::size_t kMostKept = 16;
  static std::mutex mutex;       // not held while sums are made, which takes other threads
  static std::deque<Kept> kept;  // a cache, of no consequence
  {
    const std::lock_guard lock(mutex);
    for (const Kept& one : kept) {
      if (one.samples == samples && one.scales == scales) return one.sums;
    }
  }
  std::array<SumCovariance, kShapes> shapes;
  shapes[0].linear = 1.0;
  shapes[1].cubic = 1.0;
  shapes[2].flicker = 1.0;
  auto sums = std::make_shared<const LagSums>(shapes, scales, samples);
  const std::lock_guard lock(mutex);
  kept.push_back({scales, samples, sums});
  if (kept.size() > kMostKept) kept.pop_front();
  return sums;
}

}  // namespace

Eigen::MatrixXd moment_covariance(const SumCovariance& process, const Scales& scales,
                                  std::size_t samples) {
  const bool known = has_flicker_and_shapes_alone(process);
  const auto sums = known
                        ? sums_of_shapes(scales, samples)
                        : std::make_shared<const LagSums>(std::span(&process, 1), scales, samples);
  Eigen::VectorXd powers = Eigen::VectorXd::Ones(1);
  if (known) powers = Eigen::Vector3d(process.linear, process.cubic, process.flicker);
  const auto n = static_cast<Index>(scales.size());
  Eigen::MatrixXd out(n, n);
  for (std::size_t j = 0; j < scales.size(); ++j) {
    for (std::size_t k = 0; k < scales.size(); ++k) {
      const double means = process.slope_squared * static_cast<double>(scales[j]) *
                           static_cast<double>(scales[k]) / 4.0;
      out(static_cast<Index>(j), static_cast<Index>(k)) =
          2.0 * powers.dot(sums->products(j, k) * powers) +
          4.0 * means * powers.dot(sums->plain(j, k));
    }
  }
  return out;
}

}  // namespace imunoise
