#include "recording/store/journal/journal_reader.h"

#include <utility>

namespace imunoise::recording {
namespace {

struct Frame {
  std::uint64_t sequence;
  std::string_view payload;
};

// Puts blocks into a chunk, one after the other.
class Collector {
 public:
  Collector(const v1::JournalHeader& header, std::uint64_t after) : last_(after) {
    chunk_.replicate = header.replicate();
    chunk_.device = header.device();
    for (const v1::RecordedStream& stream : chunk_.device.streams()) {
      chunk_.streams.push_back(empty_rows(stream));
    }
    lost_before_.assign(chunk_.streams.size(), false);
  }

  void add(std::uint64_t sequence, Block block) {
    if (chunk_.first_sequence != 0) lost_ += sequence - last_ - 1;
    if (sequence != last_ + 1) lost_before_.assign(lost_before_.size(), true);
    if (chunk_.first_sequence == 0) chunk_.first_sequence = sequence;
    last_ = sequence;
    if (lost_before_[block.stream] && block.rows.size() > 0) {
      block.rows.flags.front() |= kLostBefore;
      lost_before_[block.stream] = false;
    }
    append(chunk_.streams[block.stream], block.rows);
  }
  std::uint64_t last() const { return last_; }
  std::uint64_t lost() const { return lost_; }
  std::optional<Chunk> finish() {
    if (chunk_.first_sequence == 0) return std::nullopt;
    chunk_.last_sequence = last_;
    return std::move(chunk_);
  }

 private:
  Chunk chunk_;
  std::uint64_t last_;
  std::uint64_t lost_ = 0;
  std::vector<bool> lost_before_;  // of each stream: blocks are missing since its last row
};

}  // namespace

Result<Segment> read_segment(std::string_view bytes, std::uint64_t after,
                             const v1::JournalHeader* fallback, std::uint64_t before) {
  Segment out;
  std::optional<Result<v1::JournalHeader>> header;
  std::vector<Frame> frames;
  out.damage = scan_frames(bytes, [&](std::uint64_t sequence, std::string_view payload) {
    if (sequence == kHeaderSequence && !header) {
      header = parse_header(payload);
    } else {
      frames.push_back({sequence, payload});
    }
  });
  if (header && !*header) return tl::make_unexpected(header->error());
  if (!header && fallback == nullptr) {
    out.unusable = frames.size();
    return out;
  }
  const v1::JournalHeader& used = header ? **header : *fallback;
  Collector collector(used, after);
  for (const Frame& frame : frames) {
    if (frame.sequence <= collector.last() || frame.sequence >= before) continue;  // written twice
    Result<Block> block = parse_block(used.device(), frame.payload);
    if (block) {
      collector.add(frame.sequence, std::move(*block));
    } else {
      ++out.unusable;
    }
  }
  out.lost_blocks = collector.lost();
  out.chunk = collector.finish();
  return out;
}

}  // namespace imunoise::recording
