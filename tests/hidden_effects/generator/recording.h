#pragma once

// What a generated file holds.

#include <algorithm>
#include <cassert>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::hidden {

using Series = std::vector<double>;

/// The channel that a case is about.
inline constexpr std::string_view kSubject = "gyro_x";

/// One channel of one replicate.
struct Trace {
  std::string name;
  std::string unit;  ///< As people write it: "rad/s", "K", …
  Series values;     ///< In that unit.
};

/// One replicate: channels of one length.
struct Recording {
  std::vector<Trace> traces;

  /// The values of a channel that is there.
  Series& operator[](std::string_view name) { return find(traces, name)->values; }
  const Series& operator[](std::string_view name) const { return find(traces, name)->values; }

 private:
  static auto find(auto& traces, std::string_view name) -> decltype(traces.begin()) {
    const auto found = std::find_if(traces.begin(), traces.end(),
                                    [&](const Trace& trace) { return trace.name == name; });
    assert(found != traces.end());
    return found;
  }
};

}  // namespace imunoise::hidden
