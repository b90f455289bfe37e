#include <fmt/core.h>

#include <string>
#include <string_view>

#include "recording/import/packed/chunk.h"
#include "recording/import/ros/imu_messages.h"
#include "recording/import/table/bytes.h"
#include "recording/import/table/file.h"
#include "recording/import/table/format.h"

// ROS 1 bags (wiki.ros.org/Bags/Format/2.0): records of a header of named fields and data, each
// after its length, from the start of the file. The index at the end is not needed, so a truncated
// bag reads up to its last whole record.

namespace imunoise::recording {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLongestHeader = std::uint64_t{1} << 20U;

// The field `name` of a header, empty where there is none.
std::string_view bag_field(std::string_view header, std::string_view name) {
  Fields fields(header);
  while (!fields.rest().empty() && fields.ok()) {
    const std::string_view field = fields.counted<std::uint32_t>();
    const std::size_t equals = field.find('=');
    if (equals != std::string_view::npos && field.substr(0, equals) == name) {
      return field.substr(equals + 1);
    }
  }
  return {};
}

template <class Number>
Number bag_number(std::string_view header, std::string_view name) {
  return Fields(bag_field(header, name)).number<Number>();
}

class BagReader {
 public:
  BagReader(const File& file, const ImportOptions& options)
      : file_(file), collector_(file.name(), options) {}

  Result<Table> read(FileProgress& progress) {
    Window window(file_);
    std::uint64_t place = kBagMagic.size();
    std::uint64_t reported = 0;
    while (true) {
      if (place - reported > (std::uint64_t{1} << 20U)) {
        reported = place;
        progress.report(static_cast<double>(place) / static_cast<double>(file_.size()));
        if (progress.stopped())
          return fail(fmt::format("{}: the import was stopped", file_.name()));
      }
      const Result<std::uint32_t> header_length = length_at(window, place);
      if (!header_length) return tl::make_unexpected(header_length.error());
      const std::uint64_t after = place + 4 + *header_length;
      if (place + 4 >= file_.size() || after + 4 > file_.size()) break;
      if (*header_length > kLongestHeader) {
        return fail(
            fmt::format("{}: the record at byte {} is damaged; copy or record the bag again",
                        file_.name(), place));
      }
      const Result<std::string_view> head = window.at(place + 4, *header_length);
      if (!head) return tl::make_unexpected(head.error());
      const std::string header(*head);
      const Result<std::uint32_t> data_length = length_at(window, after);
      if (!data_length) return tl::make_unexpected(data_length.error());
      const bool whole = after + 4 + *data_length <= file_.size();
      const auto code = bag_number<unsigned char>(header, "op");
      if (code == kChunk || (whole && (code == kConnection || code == kMessage))) {
        const Result<std::string_view> data = window.at(after + 4, *data_length);
        if (!data) return tl::make_unexpected(data.error());
        if (code != kChunk) {
          record(header, *data);
        } else if (const auto done = chunk(header, *data, place, whole); !done) {
          return tl::make_unexpected(done.error());
        }
      }
      if (!whole) break;
      place = after + 4 + *data_length;
    }
    return collector_.finish(place != file_.size());
  }

 private:
  enum BagRecord : unsigned char { kMessage = 0x02, kChunk = 0x05, kConnection = 0x07 };

  static Result<std::uint32_t> length_at(Window& window, std::uint64_t place) {
    const Result<std::string_view> raw = window.at(place, 4);
    if (!raw) return tl::make_unexpected(raw.error());
    return Fields(*raw).number<std::uint32_t>();
  }

  void record(std::string_view header, std::string_view data) {
    const auto code = bag_number<unsigned char>(header, "op");
    const auto number = bag_number<std::uint32_t>(header, "conn");
    if (code == kConnection) {
      collector_.topic(number, bag_field(header, "topic"), bag_field(data, "type"));
    } else if (code == kMessage && collector_.wants(number)) {
      Fields time(bag_field(header, "time"));
      const std::int64_t seconds = time.number<std::uint32_t>();
      const std::int64_t nanoseconds = time.number<std::uint32_t>();
      collector_.add(number, Encoding::kRos1, data, seconds * 1'000'000'000 + nanoseconds);
    }
  }

  Result<void> chunk(std::string_view header, std::string_view data, std::uint64_t place,
                     bool in_file) {
    const auto trouble = [&](const std::string& what) {
      return fail(fmt::format("{}: the chunk at byte {}: {}", file_.name(), place, what));
    };
    const Result<Unpacked> unpacked = unpack_chunk(bag_field(header, "compression"), data,
                                                   bag_number<std::uint32_t>(header, "size"));
    if (!unpacked) return trouble(unpacked.error().message);
    if (in_file && !unpacked->whole) return trouble("is damaged; copy or record the bag again");
    Fields records(unpacked->bytes);
    while (!records.rest().empty()) {
      const std::string_view inner = records.counted<std::uint32_t>();
      const std::string_view inner_data = records.counted<std::uint32_t>();
      if (!records.ok()) break;
      record(inner, inner_data);
    }
    if (in_file && !records.ok()) return trouble("ends within a record; record the bag again");
    return {};
  }

  const File& file_;
  ImuCollector collector_;
};

Result<Table> read_ros1_bag(const std::filesystem::path& path, const ImportOptions& options,
                            FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  return BagReader(*file, options).read(progress);
}

Result<bool> claims_ros1_bag(const UnknownFile& file) {
  if (file.extension != ".bag") return false;
  return fail(
      fmt::format("{}: is not a ROS 1 bag of version 2.0, despite its name; convert it with "
                  "rosbag fix or copy it again",
                  file.content.name()));
}

}  // namespace

namespace formats {

const ImportFormat& ros1_bag() {
  static constexpr ImportFormat kFormat = {
      .kind = "a ROS 1 bag (.bag)",
      .begins = [](std::string_view head) { return head.starts_with(kBagMagic); },
      .claims = claims_ros1_bag,
      .read = read_ros1_bag};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
