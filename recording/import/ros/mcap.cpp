#include <fmt/core.h>

#include <map>
#include <string>
#include <string_view>

#include "recording/import/packed/chunk.h"
#include "recording/import/ros/imu_messages.h"
#include "recording/import/table/bytes.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"

// MCAP (mcap.dev/spec): records of an opcode, a length and that many bytes, from the start of the
// file. The summary at the end is not needed, so a truncated file reads up to its last whole
// record.

namespace imunoise::recording {
namespace {

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::uint64_t kMcapFrame = 9;  // opcode and length

enum McapRecord : unsigned char {
  kMcapSchema = 0x03,
  kMcapChannel = 0x04,
  kMcapMessage = 0x05,
  kMcapChunk = 0x06,
  kMcapDataEnd = 0x0F,
};

class McapReader {
 public:
  McapReader(const File& file, const ImportOptions& options)
      : file_(file), collector_(file.name(), options) {}

  Result<Table> read(FileProgress& progress) {
    Window window(file_);
    std::uint64_t place = kMcapMagic.size();
    std::size_t records = 0;
    while (true) {
      if (++records % 4096 == 0 || place - reported_ > (std::uint64_t{1} << 22U)) {
        reported_ = place;
        progress.report(static_cast<double>(place) / static_cast<double>(file_.size()));
        if (progress.stopped())
          return fail(fmt::format("{}: the import was stopped", file_.name()));
      }
      const Result<std::string_view> head = window.at(place, kMcapFrame);
      if (!head) return tl::make_unexpected(head.error());
      Fields fields(*head);
      const auto code = fields.number<unsigned char>();
      const auto length = fields.number<std::uint64_t>();
      if (fields.ok() && code == kMcapDataEnd) return collector_.finish();
      if (!fields.ok()) break;
      const std::uint64_t begin = place + kMcapFrame;
      const std::uint64_t there = file_.size() - begin;
      const bool whole = length <= there;
      if (code == kMcapChunk || (whole && is_content(code))) {
        if (length > kLargestChunk + (std::uint64_t{1} << 16U)) {
          return fail(fmt::format("{}: a record of {} bytes at byte {}; record with smaller chunks",
                                  file_.name(), length, place));
        }
        const Result<std::string_view> content = window.at(begin, length);
        if (!content) return tl::make_unexpected(content.error());
        if (code != kMcapChunk) {
          record(code, *content);
        } else if (const auto done = chunk(*content, place, whole); !done) {
          return tl::make_unexpected(done.error());
        }
      }
      if (!whole) break;
      place = begin + length;
    }
    return collector_.finish(true);
  }

 private:
  static bool is_content(unsigned char code) {
    return code == kMcapSchema || code == kMcapChannel || code == kMcapMessage;
  }

  void record(unsigned char code, std::string_view content) {
    Fields fields(content);
    const auto number = fields.number<std::uint16_t>();
    if (code == kMcapSchema) {
      const auto name = fields.counted<std::uint32_t>();
      if (fields.ok()) schemas_.try_emplace(number, name);
    } else if (code == kMcapChannel) {
      const auto schema = schemas_.find(fields.number<std::uint16_t>());
      const auto topic = fields.counted<std::uint32_t>();
      const auto encoding = fields.counted<std::uint32_t>();
      if (!fields.ok()) return;
      encodings_[number] = encoding == "ros1" ? Encoding::kRos1 : Encoding::kCdr;
      const bool readable = encoding == "ros1" || encoding == "cdr";
      const std::string type = schema == schemas_.end() ? "" : schema->second;
      collector_.topic(number, topic, readable ? type : fmt::format("{} in {}", type, encoding));
    } else if (code == kMcapMessage && collector_.wants(number)) {
      fields.number<std::uint32_t>();  // sequence
      const auto received = static_cast<std::int64_t>(fields.number<std::uint64_t>());
      fields.number<std::uint64_t>();  // published
      collector_.add(number, encodings_[number], fields.rest(), received);
    }
  }

  Result<void> chunk(std::string_view content, std::uint64_t place, bool in_file) {
    Fields fields(content);
    fields.bytes(16);  // first and last time
    const auto size = fields.number<std::uint64_t>();
    fields.number<std::uint32_t>();  // checksum
    const auto method = fields.counted<std::uint32_t>();
    fields.number<std::uint64_t>();  // length of what follows
    if (!fields.ok()) return {};
    const auto trouble = [&](const std::string& what) {
      return fail(fmt::format("{}: the chunk at byte {}: {}", file_.name(), place, what));
    };
    const Result<Unpacked> unpacked = unpack_chunk(method, fields.rest(), size);
    if (!unpacked) return trouble(unpacked.error().message);
    if (in_file && !unpacked->whole) return trouble("is damaged; copy or record the file again");
    Fields records(unpacked->bytes);
    while (!records.rest().empty()) {
      const auto code = records.number<unsigned char>();
      const std::string_view inner = records.counted<std::uint64_t>();
      if (!records.ok()) break;
      record(code, inner);
    }
    if (in_file && !records.ok()) return trouble("ends within a record; record the file again");
    return {};
  }

  const File& file_;
  ImuCollector collector_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Encoding> encodings_;
  std::uint64_t reported_ = 0;
};

Result<Table> read_mcap(const std::filesystem::path& path, const ImportOptions& options,
                        FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  return McapReader(*file, options).read(progress);
}

Result<bool> claims_mcap(const UnknownFile& file) {
  if (file.extension != ".mcap") return false;
  return fail(
      fmt::format("{}: is not an MCAP file, despite its name; copy it again", file.content.name()));
}

}  // namespace

namespace formats {

const ImportFormat& mcap() {
  static constexpr ImportFormat kFormat = {
      .kind = "MCAP (.mcap)",
      .begins = [](std::string_view head) { return head.starts_with(kMcapMagic); },
      .claims = claims_mcap,
      .read = read_mcap};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
