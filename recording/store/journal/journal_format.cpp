#include "recording/store/journal/journal_format.h"

#include <fmt/core.h>

#include <array>
#include <bit>
#include <cassert>
#include <cstring>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/format_version.h"

namespace imunoise::recording {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr std::string_view kMagic = "IMJ1";
constexpr std::size_t kChecked = 12;  // length and sequence
constexpr std::size_t kOverhead = 4 + kChecked + 4;

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string out(numbers.size() * sizeof(Number), '\0');
  if (!out.empty()) std::memcpy(out.data(), numbers.data(), out.size());
  return out;
}

// False when the bytes are not `rows` numbers.
template <class Number>
bool take(std::string_view bytes, std::size_t rows, std::vector<Number>& out) {
  if (bytes.size() / sizeof(Number) != rows || bytes.size() % sizeof(Number) != 0) return false;
  out.resize(rows);
  if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
  return true;
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t offset) {
  Number out = 0;
  std::memcpy(&out, bytes.data() + offset, sizeof out);
  return out;
}

// Size of the whole frame at the beginning of `bytes`; 0 when there is none. `budget` limits how
// many bytes may be checksummed in vain: hostile bytes could ask for their square.
std::size_t whole_frame(std::string_view bytes, std::uint64_t& budget) {
  if (bytes.size() < kOverhead || !bytes.starts_with(kMagic)) return 0;
  const auto length = number_at<std::uint32_t>(bytes, 4);
  if (length > kMaximumPayload || length > bytes.size() - kOverhead) return 0;
  if (length > budget) return 0;
  const std::string_view payload = bytes.substr(kOverhead, length);
  if (crc32c(bytes.substr(4, kChecked), payload) == number_at<std::uint32_t>(bytes, 4 + kChecked)) {
    return kOverhead + length;
  }
  budget -= length;
  return 0;
}

}  // namespace

std::string frame(std::uint64_t sequence, std::string_view payload) {
  assert(payload.size() <= kMaximumPayload);
  const auto length = static_cast<std::uint32_t>(payload.size());
  std::array<char, kChecked> checked = {};
  std::memcpy(checked.data(), &length, sizeof length);
  std::memcpy(checked.data() + sizeof length, &sequence, sizeof sequence);
  const std::string_view head(checked.data(), checked.size());
  const std::uint32_t crc = crc32c(head, payload);
  std::string out;
  out.reserve(kOverhead + payload.size());
  out.append(kMagic).append(head);
  out.resize(out.size() + sizeof crc);
  std::memcpy(out.data() + out.size() - sizeof crc, &crc, sizeof crc);
  return out.append(payload);
}

std::string header_frame(const v1::JournalHeader& header) {
  return frame(kHeaderSequence, header.SerializeAsString());
}

std::string block_frame(std::uint64_t sequence, const Block& block) {
  const Rows& rows = block.rows;
  v1::JournalBlock out;
  out.set_stream(static_cast<std::uint32_t>(block.stream));
  out.set_received(rows.received);
  out.set_host_time(bytes_of(rows.host_time));
  out.set_counter(bytes_of(rows.counter));
  out.set_flags(bytes_of(rows.flags));
  for (const Numbers& column : rows.channels) {
    std::visit([&](const auto& values) { out.add_columns(bytes_of(values)); }, column);
  }
  for (const Refusal& one : rows.refused) *out.add_refused() = to_message(one);
  return frame(sequence, out.SerializeAsString());
}

std::vector<Damage> scan_frames(
    std::string_view bytes,
    const std::function<void(std::uint64_t sequence, std::string_view payload)>& use) {
  std::vector<Damage> damage;
  std::uint64_t budget = 16 * static_cast<std::uint64_t>(bytes.size());
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t found = at;
    std::size_t length = whole_frame(bytes.substr(at), budget);
    while (length == 0 && found < bytes.size()) {
      found = std::min(bytes.find(kMagic, found + 1), bytes.size());
      length = whole_frame(bytes.substr(found), budget);
    }
    if (found != at) damage.push_back({at, found - at, found == bytes.size()});
    if (length == 0) break;
    use(number_at<std::uint64_t>(bytes, found + 8),
        bytes.substr(found + kOverhead, length - kOverhead));
    at = found + length;
  }
  return damage;
}

Result<v1::JournalHeader> parse_header(std::string_view payload) {
  v1::JournalHeader out;
  if (!out.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
    return fail("its header is not one of a journal");
  }
  if (out.version() != kFormatVersion) return fail(other_version(out.version()));
  if (auto good = check_device(out.device()); !good) return tl::make_unexpected(good.error());
  return out;
}

Result<Block> parse_block(const v1::RecordedDevice& device, std::string_view payload) {
  const auto broken = [] { return fail("is not a block of samples of this device"); };
  v1::JournalBlock in;
  if (!in.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return broken();
  if (in.stream() >= static_cast<std::uint32_t>(device.streams_size())) return broken();
  const v1::RecordedStream& stream = device.streams(static_cast<int>(in.stream()));
  if (in.columns_size() != stream.channels_size()) return broken();
  Block out{in.stream(), empty_rows(stream)};
  Rows& rows = out.rows;
  const std::size_t n = in.host_time().size() / sizeof(std::int64_t);
  bool good = take(in.host_time(), n, rows.host_time) && take(in.flags(), n, rows.flags) &&
              take(in.counter(), stream.counter_modulus() != 0 ? n : 0, rows.counter);
  for (int i = 0; i < in.columns_size() && good; ++i) {
    good = std::visit([&](auto& values) { return take(in.columns(i), n, values); },
                      rows.channels[static_cast<std::size_t>(i)]);
  }
  if (!good) return broken();
  rows.received = in.received();
  for (const v1::RefusalCount& count : in.refused()) {
    const Result<Refusal> refusal = from_message(count);
    if (!refusal) return broken();
    rows.refused.push_back(*refusal);
  }
  if (!check_block(device, out)) return broken();
  return out;
}

}  // namespace imunoise::recording
