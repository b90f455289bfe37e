#pragma once

// Server-sent events out of bytes as they come.

#include <functional>
#include <string>
#include <string_view>

namespace imunoise::cli {

/// The part of the format that the daemon uses: lines "event: NAME" and "data: TEXT", an empty line
/// at the end of each, comments; at most 16 MiB an event.
class EventReader {
 public:
  /// Calls `take` with each event that is complete. False: it said so, or an event is too large.
  bool push(std::string_view bytes,
            const std::function<bool(std::string_view name, const std::string& data)>& take);

 private:
  void line(std::string_view text);

  std::string rest_;  // of a line that has not ended
  std::string name_;
  std::string data_;
};

}  // namespace imunoise::cli
