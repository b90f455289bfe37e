#include "recording/store/timeline/common_grid.h"

#include <algorithm>
#include <cmath>

namespace imunoise::recording {
namespace {

constexpr double kHalf = 0.5 + 1e-6;  // of a sample; what is half way off stays as it was

// A stretch in which each stream has one timeline.
struct Overlap {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<const Timeline*> of{};  // one a stream
};

std::int64_t end_of(const Timeline& line) {
  return line.first_ns + std::llround(static_cast<double>(line.part.count) * line.period_ns);
}

// What is left of the overlaps where this stream has samples, too.
std::vector<Overlap> shared_with(const std::vector<Overlap>& before,
                                 const std::vector<Timeline>& timelines) {
  std::vector<Overlap> out;
  for (const Overlap& one : before) {
    for (const Timeline& line : timelines) {
      Overlap next = one;
      next.begin_ns = std::max(one.begin_ns, line.first_ns);
      next.end_ns = std::min(one.end_ns, end_of(line));
      if (next.begin_ns >= next.end_ns) continue;
      next.of.push_back(&line);
      out.push_back(std::move(next));
    }
  }
  return out;
}

std::vector<Overlap> overlaps(std::span<const GridStream> streams) {
  std::vector<Overlap> out;
  for (const Timeline& line : streams.front().timelines)
    out.push_back({line.first_ns, end_of(line), {&line}});
  for (const GridStream& stream : streams.subspan(1)) out = shared_with(out, stream.timelines);
  return out;
}

double period_of(const Timeline& line, const GridStream& stream) {
  return line.period_ns * static_cast<double>(stream.averaged);
}

// The grid of an overlap: sample j of it lies in the middle of block j of the slowest stream.
struct Beat {
  const Timeline* line = nullptr;
  std::size_t first = 0;  // sample of the line
  std::size_t averaged = 1;

  double sample(std::size_t j) const {
    return static_cast<double>(first + j * averaged) + 0.5 * static_cast<double>(averaged - 1);
  }
};

Beat beat_of(const Overlap& overlap, std::span<const GridStream> streams) {
  std::size_t slowest = 0;
  for (std::size_t i = 1; i < streams.size(); ++i) {
    if (period_of(*overlap.of[i], streams[i]) > period_of(*overlap.of[slowest], streams[slowest]))
      slowest = i;
  }
  const Timeline& line = *overlap.of[slowest];
  const auto late = static_cast<double>(overlap.begin_ns - line.first_ns);
  return {&line, static_cast<std::size_t>(std::ceil(late / line.period_ns)),
          streams[slowest].averaged};
}

// Where a stream's blocks should begin to lie on the grid, in samples that need not be whole.
class Places {
 public:
  Places(const Timeline& line, std::size_t averaged, const Beat& beat)
      : line_(line), averaged_(averaged), beat_(beat) {}

  double at(std::size_t j) const {
    return beat_.line->time_ns(beat_.sample(j), line_.first_ns) / line_.period_ns -
           0.5 * static_cast<double>(averaged_ - 1);
  }
  bool begun(std::size_t j) const { return std::llround(at(j)) >= 0; }
  bool ended(std::size_t j) const {
    return std::floor(at(j) + kHalf) + static_cast<double>(averaged_) >
           static_cast<double>(line_.part.count);
  }

  // Blocks one after the other, which wait where they run ahead of the grid.
  Picked pick(std::size_t from, std::size_t count) const {
    Picked out;
    auto next = static_cast<std::size_t>(std::llround(at(from)));
    out.parts.push_back({line_.part.begin + next, 0});
    for (std::size_t j = from; j < from + count; ++j) {
      const double behind = at(j) - static_cast<double>(next);
      if (behind > kHalf) {
        const auto skipped = static_cast<std::size_t>(std::ceil(behind - kHalf));
        next += skipped;
        out.dropped += skipped;
        out.parts.push_back({line_.part.begin + next, 0});
      }
      next += averaged_;
      out.parts.back().count += averaged_;
    }
    return out;
  }

 private:
  const Timeline& line_;
  std::size_t averaged_;
  const Beat& beat_;
};

GridPiece piece_of(const Overlap& overlap, std::span<const GridStream> streams) {
  const Beat beat = beat_of(overlap, streams);
  std::vector<Places> places;
  for (std::size_t i = 0; i < streams.size(); ++i)
    places.emplace_back(*overlap.of[i], streams[i].averaged, beat);
  const double period = beat.line->period_ns * static_cast<double>(beat.averaged);
  // The first and the one after the last are a step or two from where the overlap says.
  std::size_t from = 0;
  auto end = static_cast<std::size_t>(
      std::ceil(static_cast<double>(overlap.end_ns - overlap.begin_ns) / period) + 1.0);
  const auto any = [&](auto test) { return std::any_of(places.begin(), places.end(), test); };
  while (from < end && any([&](const Places& one) { return !one.begun(from); })) ++from;
  while (end > from && any([&](const Places& one) { return one.ended(end - 1); })) --end;
  GridPiece out{end - from, period, {}};
  for (const Places& one : places) out.picked.push_back(one.pick(from, out.count));
  return out;
}

}  // namespace

std::vector<GridPiece> common_grid(std::span<const GridStream> streams, std::size_t fewest) {
  std::vector<GridPiece> out;
  for (const Overlap& one : overlaps(streams)) {
    GridPiece piece = piece_of(one, streams);
    if (piece.count >= fewest) out.push_back(std::move(piece));
  }
  return out;
}

void shorten(GridPiece& piece, std::size_t count) {
  for (Picked& one : piece.picked) {
    std::size_t surplus = 0;
    for (const Part& part : one.parts) surplus += part.count;
    surplus -= surplus / piece.count * count;
    while (surplus >= one.parts.back().count) {
      surplus -= one.parts.back().count;
      const std::size_t begin = one.parts.back().begin;
      one.parts.pop_back();
      one.dropped -= begin - (one.parts.back().begin + one.parts.back().count);
    }
    one.parts.back().count -= surplus;
  }
  piece.count = count;
}

double seconds_together(std::span<const GridStream> streams) {
  double out = 0.0;
  for (const Overlap& one : overlaps(streams))
    out += 1e-9 * static_cast<double>(one.end_ns - one.begin_ns);
  return out;
}

}  // namespace imunoise::recording
