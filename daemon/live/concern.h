#pragma once

// What the user should hear of while it can still be mended.

#include <cstdint>
#include <deque>
#include <optional>

namespace imunoise::live {

/// Something that was seen, and is of concern for a minute after it was seen last. Times in ns.
class Concern {
 public:
  /// Seen `count` times more.
  void see(std::int64_t now_ns, std::uint64_t count = 1);
  /// Since when; nothing: it is of no concern any more.
  std::optional<std::int64_t> since(std::int64_t now_ns) const;
  /// How often it was seen since then, or the last time that it was of concern; 0: never.
  std::uint64_t count() const { return count_; }
  /// When it was seen last.
  std::int64_t last_ns() const { return last_ns_; }

 private:
  std::int64_t since_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint64_t count_ = 0;
};

/// The slope of a slow quantity over the last ten minutes, by least squares through means of ten
/// seconds.
class Slope {
 public:
  void take(std::int64_t time_ns, double value);
  /// A second; nothing before half of the ten minutes are known.
  std::optional<double> per_second() const;

 private:
  struct Mean {
    double time_s = 0.0;
    double value = 0.0;
    std::size_t count = 0;
  };
  std::optional<std::int64_t> origin_ns_;
  std::deque<Mean> means_;
};

}  // namespace imunoise::live
