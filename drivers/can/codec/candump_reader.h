#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/can/codec/candump.h"
#include "drivers/codec/bytes.h"
#include "drivers/codec/refusal.h"

namespace imunoise::drivers {

/// The frames in the text of candump -L; whatever the pieces in which it arrives, the frames are
/// the same. Lines that do not begin with "(" are skipped; those that do and are no frame are
/// refused. Memory: one line and what was pushed but not asked for. One thread at a time.
class CandumpReader {
 public:
  void push(Bytes bytes);
  /// There are no more bytes: the last line may lack its ending.
  void finish() { finished_ = true; }
  /// The next frame, borrowed until the next call; nothing when more bytes are needed.
  std::optional<CandumpLine> next();

  /// Lines that are no frame.
  const Refusals& refused() const { return refused_; }

 private:
  std::optional<CandumpLine> parse(std::string_view line);
  void refuse_if_frame(std::string_view line);

  std::string buffer_;
  std::size_t begin_ = 0;     // characters before it are done with
  std::size_t searched_ = 0;  // no line ends before it
  bool too_long_ = false;     // within a line that was refused for its length
  bool finished_ = false;
  Refusals refused_;
};

}  // namespace imunoise::drivers
