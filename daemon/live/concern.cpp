#include "daemon/live/concern.h"

#include <algorithm>

#include "recording/store/timeline/straight_line.h"

namespace imunoise::live {
namespace {

constexpr std::int64_t kMinute = 60'000'000'000;  // ns
constexpr double kMeanOver = 10.0;                // s
constexpr std::size_t kMeans = 60;

}  // namespace

void Concern::see(std::int64_t now_ns, std::uint64_t count) {
  if (!since(now_ns)) {
    since_ns_ = now_ns;
    count_ = 0;
  }
  last_ns_ = std::max(last_ns_, now_ns);
  count_ += count;
}

std::optional<std::int64_t> Concern::since(std::int64_t now_ns) const {
  if (count_ == 0 || now_ns - last_ns_ > kMinute) return std::nullopt;
  return since_ns_;
}

void Slope::take(std::int64_t time_ns, double value) {
  if (!origin_ns_) origin_ns_ = time_ns;
  const double time = static_cast<double>(time_ns - *origin_ns_) * 1e-9;
  if (means_.empty() || time - means_.back().time_s >= kMeanOver) means_.push_back({time, 0.0, 0});
  Mean& mean = means_.back();
  ++mean.count;
  mean.value += (value - mean.value) / static_cast<double>(mean.count);
  if (means_.size() > kMeans) means_.pop_front();
}

std::optional<double> Slope::per_second() const {
  if (means_.size() < kMeans / 2) return std::nullopt;
  recording::StraightLine line;
  for (const Mean& mean : means_) line.add(mean.time_s, mean.value);
  return line.slope();
}

}  // namespace imunoise::live
