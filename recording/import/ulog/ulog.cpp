#include <fmt/core.h>

#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "recording/import/table/bytes.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"
#include "recording/import/table/streams.h"
#include "recording/import/ulog/ulog_topics.h"

// Logs of PX4 (docs.px4.io, "ULog File Format"): records of a length, a type and that many bytes. A
// truncated log reads up to its last whole record.

namespace imunoise::recording {
namespace {

constexpr std::string_view kUlogMagic = "ULog\x01\x12\x35";
constexpr std::uint64_t kUlogHeader = 16;
constexpr std::size_t kMostSubscriptions = 4096;

class UlogReader {
 public:
  UlogReader(const File& file, const ImportOptions& options) : file_(file), options_(options) {}

  Result<Table> read(FileProgress& progress) {
    Window window(file_);
    std::uint64_t place = kUlogHeader;
    std::size_t records = 0;
    while (place < file_.size()) {
      if (++records % 65536 == 0) {
        progress.report(static_cast<double>(place) / static_cast<double>(file_.size()));
        if (progress.stopped())
          return fail(fmt::format("{}: the import was stopped", file_.name()));
      }
      const Result<std::string_view> head = window.at(place, 3);
      if (!head) return tl::make_unexpected(head.error());
      Fields fields(*head);
      const auto length = fields.number<std::uint16_t>();
      const auto type = fields.number<char>();
      if (!fields.ok()) break;
      const Result<std::string_view> content = window.at(place + 3, length);
      if (!content) return tl::make_unexpected(content.error());
      if (content->size() < length) break;
      if (auto done = record(type, *content); !done) return tl::make_unexpected(done.error());
      place += 3 + std::uint64_t{length};
    }
    return finish(place != file_.size());
  }

 private:
  Result<void> record(char type, std::string_view content) {
    Fields fields(content);
    if (type == 'B') {
      fields.bytes(8);
      const std::string_view flags = fields.bytes(8);
      for (std::size_t i = 0; i < flags.size(); ++i) {
        // Bit 0: data were appended at the end, which are read in their turn.
        const auto unknown = static_cast<unsigned char>(flags[i]) & (i == 0 ? 0xFEU : 0xFFU);
        if (unknown != 0) {
          return fail(
              fmt::format("{}: has a newer form of ULog; convert it with ulog2csv", file_.name()));
        }
      }
    } else if (type == 'F') {
      formats_.add(content);
    } else if (type == 'A') {
      subscribe(fields);
    } else if (type == 'D') {
      sample(fields);
    } else if (type == 'O') {
      ++dropouts_;
      dropped_ms_ += fields.number<std::uint16_t>();
    }
    return {};
  }

  void subscribe(Fields& fields) {
    const unsigned instance = fields.number<std::uint8_t>();
    const auto number = fields.number<std::uint16_t>();
    const std::string_view name = fields.rest();
    const UlogTopic* const topic = find_ulog_topic(name);
    if (!fields.ok() || topic == nullptr || sources_.size() >= kMostSubscriptions) return;
    std::string called(name);
    if (instance > 0) called += fmt::format("/{}", instance);
    const bool wanted = options_.topic.empty() ? instance == 0 : options_.topic == called;
    names_.insert_or_assign(number, called);
    if (!wanted) return;
    auto made = UlogSamples::make(*topic, called, formats_);
    if (made) sources_.insert_or_assign(number, std::move(*made));
  }

  void sample(Fields& fields) {
    const auto number = fields.number<std::uint16_t>();
    const auto found = sources_.find(number);
    if (found == sources_.end() || found->second.rank() > best_) return;
    if (!found->second.add(fields.rest())) {
      if (unreadable_++ == 0)
        first_unreadable_ = fmt::format("a message of topic {} is damaged", names_[number]);
      return;
    }
    if (found->second.rank() < best_) {
      best_ = found->second.rank();
      std::erase_if(sources_, [&](const auto& one) { return one.second.rank() > best_; });
    }
  }

  Result<Table> finish(bool truncated) {
    std::vector<TimedStream> streams;
    for (auto& [number, source] : sources_) streams.push_back(source.take());
    std::string known;
    for (const auto& [number, name] : names_) known += (known.empty() ? "" : ", ") + name;
    std::erase_if(streams, [](const TimedStream& one) { return one.times.empty(); });
    if (streams.empty()) {
      return fail(
          fmt::format("{}: no samples of an IMU{} (topics of an IMU: {}); log "
                      "sensor_gyro_fifo and sensor_accel_fifo, or sensor_gyro and "
                      "sensor_accel",
                      file_.name(), options_.topic.empty() ? "" : " in topic " + options_.topic,
                      known.empty() ? "none" : known));
    }
    auto table = join_streams(file_.name(), std::move(streams), "timestamp_sample", options_);
    if (!table) return table;
    table->truncated = truncated;
    table->unreadable = unreadable_;
    table->first_unreadable = first_unreadable_;
    if (dropouts_ > 0) {
      table->notes.push_back(
          fmt::format("the logger dropped data {} times, {} ms in all", dropouts_, dropped_ms_));
    }
    return table;
  }

  const File& file_;
  const ImportOptions& options_;
  UlogFormats formats_;
  std::map<std::uint16_t, std::string> names_;
  std::map<std::uint16_t, UlogSamples> sources_;
  int best_ = 1000;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
  std::size_t dropouts_ = 0;
  std::uint64_t dropped_ms_ = 0;
};

Result<Table> read_ulog(const std::filesystem::path& path, const ImportOptions& options,
                        FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  return UlogReader(*file, options).read(progress);
}

Result<bool> claims_ulog(const UnknownFile& file) {
  if (file.extension != ".ulg") return false;
  return fail(
      fmt::format("{}: is not a ULog, despite its name; copy it again", file.content.name()));
}

}  // namespace

namespace formats {

const ImportFormat& ulog() {
  static constexpr ImportFormat kFormat = {
      .kind = "ULog (.ulg)",
      .begins = [](std::string_view head) { return head.starts_with(kUlogMagic); },
      .claims = claims_ulog,
      .read = read_ulog};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
