#pragma once

// Where the rows of a stream are not consecutive samples.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "recording/store/stream/stream.h"

namespace imunoise::recording {

enum class Evidence { kFlag, kCounter, kDuplicate, kTime };
/// "flag", "counter", "duplicate", "time"
std::string_view word(Evidence evidence);

struct RowGap {
  std::size_t before = 0;  ///< Index of the first row after the gap, at least 1.
  std::uint64_t lost = 0;  ///< Samples that never came; 0 when unknown.
  Evidence evidence = Evidence::kFlag;
};

/// Gaps in order, one at most at each row. With a device counter: every step that is not
/// counter_step, and pauses of the host's clock long enough to hide a wrap of the counter. Without:
/// time stamps that come late for good. A stamp alone may be late, as transfers are; a lost sample
/// makes all later ones late by a period, so the earliest of 32 stamps on either side are compared.
/// Both: rows flagged kLostBefore.
std::vector<RowGap> find_gaps(const v1::RecordedStream& stream, const Rows& rows);

/// Nanoseconds from sample to sample by the host's clock, from differences over 32 samples, whose
/// median neither gaps nor late stamps move; the nominal period when rows are too few.
double typical_period(const v1::RecordedStream& stream, const Rows& rows);

/// Consecutive rows.
struct Part {
  std::size_t begin = 0;
  std::size_t count = 0;
};
/// The rows between gaps.
std::vector<Part> parts_between(const std::vector<RowGap>& gaps, std::size_t rows);

}  // namespace imunoise::recording
