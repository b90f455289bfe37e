#include "core/spectrum/cross_power.h"

#include <cassert>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {

Eigen::VectorXd samples_of(const Signal& signal) {
  assert(signal.size() >= kFewestSamples);
  Eigen::VectorXd out(static_cast<Eigen::Index>(quick_length(signal.size())));
  std::visit(
      [&](auto samples) {
        for (Eigen::Index t = 0; t < out.size(); ++t) {
          out(t) = signal.scale() * (static_cast<double>(samples[static_cast<std::size_t>(t)]) -
                                     static_cast<double>(samples[0]));
        }
      },
      signal.samples());
  return out;
}

Eigen::MatrixXd samples_of(std::span<const Signal> signals) {
  assert(!signals.empty());
  const auto n = static_cast<Eigen::Index>(quick_length(signals.front().size()));
  Eigen::MatrixXd out(n, static_cast<Eigen::Index>(signals.size()));
  Eigen::Index column = 0;
  for (const Signal& signal : signals) {
    assert(signal.size() == signals.front().size());
    out.col(column++) = samples_of(signal);
  }
  return out;
}

std::vector<Signal> signals_of(const Eigen::MatrixXd& samples, Hertz rate) {
  std::vector<Signal> out;
  const auto n = static_cast<std::size_t>(samples.rows());
  for (Eigen::Index i = 0; i < samples.cols(); ++i)
    out.emplace_back(std::span<const double>(samples.col(i).data(), n), rate);
  return out;
}

CrossPower cross_power(const MatrixRef& series, Hertz rate) {
  Eigen::MatrixXd transform(series.rows() - 1, series.cols());
  for (Eigen::Index i = 0; i < series.cols(); ++i)
    transform.col(i) = cosine_transform(series.col(i));
  const Bands bands(series.rows());
  CrossPower out{bands.frequency, bands.count, {}, static_cast<std::size_t>(series.rows()), rate};
  for (Eigen::Index b = 0; b < bands.size(); ++b) {
    const Eigen::Index begin = bands.edges[static_cast<std::size_t>(b)];
    const Eigen::Index width = bands.edges[static_cast<std::size_t>(b) + 1] - begin;
    const auto within = transform.middleRows(begin, width);
    out.power.push_back(within.transpose() * within / bands.count(b));
  }
  return out;
}

}  // namespace imunoise
