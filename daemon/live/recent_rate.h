#pragma once

// How fast samples come now.

#include <cstdint>
#include <deque>
#include <optional>

namespace imunoise::live {

/// Samples a second over the last ten seconds, by their time stamps.
class RecentRate {
 public:
  /// So many samples came until `now_ns`.
  void take(std::int64_t now_ns, std::uint64_t samples) {
    constexpr std::int64_t kStep = 1'000'000'000;  // ns
    constexpr std::size_t kSteps = 10;
    newest_ = {now_ns, samples};
    if (!marks_.empty() && now_ns - marks_.back().time_ns < kStep) return;
    marks_.push_back(newest_);
    if (marks_.size() > kSteps + 1) marks_.pop_front();
  }
  /// Hz; nothing before two seconds have passed.
  std::optional<double> hz() const {
    constexpr double kLeast = 2.0;  // s
    if (marks_.empty()) return std::nullopt;
    const double time = 1e-9 * static_cast<double>(newest_.time_ns - marks_.front().time_ns);
    if (time < kLeast) return std::nullopt;
    return static_cast<double>(newest_.samples - marks_.front().samples) / time;
  }

 private:
  struct Mark {
    std::int64_t time_ns = 0;
    std::uint64_t samples = 0;
  };
  std::deque<Mark> marks_;
  Mark newest_;
};

}  // namespace imunoise::live
