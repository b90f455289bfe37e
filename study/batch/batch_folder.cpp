#include "study/batch/batch_folder.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "recording/store/format/crc32c.h"
#include "study/batch/batch_plan.h"
#include "study/report/json.h"

namespace imunoise::study {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBatchName = "batch.json";
constexpr std::size_t kLogLines = 5;

fs::path shard_path(const fs::path& folder, std::uint32_t number) {
  return folder / "shards" / (shard_name(number) + ".json");
}
fs::path result_path(const fs::path& folder, std::uint32_t number) {
  return folder / "results" / (shard_name(number) + ".json");
}

// `what`: "a batch". Error: not JSON, an unknown field, another version.
template <class Message>
Result<Message> parse(const std::string& text, std::string_view what) {
  Message out;
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &out, strict);
  if (!status.ok()) return fail(fmt::format("not {}: {}", what, status.message().ToString()));
  if (out.version() != kBatchVersion) {
    return fail(
        fmt::format("version {} of {}; this program reads {}", out.version(), what, kBatchVersion));
  }
  return out;
}

Error at(const fs::path& path, const Error& error) {
  return {fmt::format("{}: {}", path.string(), error.message)};
}

std::vector<std::string> last_lines(const std::string& text) {
  std::vector<std::string> out;
  std::size_t end = text.size();
  while (end > 0 && out.size() < kLogLines) {
    const std::size_t begin = text.rfind('\n', end - 1) + 1;  // npos + 1 is 0
    if (begin < end) out.push_back(text.substr(begin, end - begin));
    end = begin > 0 ? begin - 1 : 0;
  }
  std::reverse(out.begin(), out.end());
  return out;
}

v1::ShardStatus open_shard(const recording::FileSystem& files, const fs::path& folder,
                           std::uint32_t number, bool there, const Error& error) {
  v1::ShardStatus out;
  out.set_number(number);
  out.set_state(there ? v1::damaged : v1::missing);
  if (there) out.set_trouble(error.message);
  if (const auto log = files.read(log_path(folder, number))) {
    for (const std::string& line : last_lines(*log)) out.add_log(line);
  }
  return out;
}

}  // namespace

std::string shard_name(std::uint32_t number) { return fmt::format("{:06}", number); }

fs::path log_path(const fs::path& folder, std::uint32_t number) {
  return folder / "log" / (shard_name(number) + ".txt");
}

Result<void> make_batch(recording::FileSystem& files, const fs::path& folder,
                        const v1::Batch& batch) {
  if (auto good = check_batch(batch); !good) return good;
  if (auto done = files.make_folder(folder); !done) return done;
  const auto there = recording::contains(files, folder, kBatchName);
  if (!there) return tl::unexpected(there.error());
  if (*there) return fail(folder.string() + ": contains a batch; name another folder");
  for (const char* const part : {"shards", "results", "log"}) {
    if (auto done = files.make_folder(folder / part); !done) return done;
  }
  for (const v1::BatchShard& shard : shards_of(batch)) {
    auto done =
        recording::replace_file(files, shard_path(folder, shard.number()), report::to_json(shard));
    if (!done) return done;
  }
  return recording::replace_file(files, folder / kBatchName, report::to_json(batch));
}

Result<v1::Batch> read_batch(const recording::FileSystem& files, const fs::path& folder) {
  const auto there = recording::contains(files, folder, kBatchName);
  if (!there) return tl::unexpected(there.error());
  if (!*there) return fail(folder.string() + ": contains no batch; imunoise batch new makes one");
  const auto text = files.read(folder / kBatchName);
  if (!text) return tl::unexpected(text.error());
  auto batch = parse<v1::Batch>(*text, "a batch");
  if (!batch) return tl::unexpected(at(folder / kBatchName, batch.error()));
  if (auto good = check_batch(*batch); !good)
    return tl::unexpected(at(folder / kBatchName, good.error()));
  return batch;
}

Result<Shard> read_shard(const recording::FileSystem& files, const fs::path& folder,
                         std::uint32_t number) {
  const fs::path path = shard_path(folder, number);
  const auto text = files.read(path);
  if (!text) return tl::unexpected(text.error());
  auto shard = parse<v1::BatchShard>(*text, "a shard");
  if (!shard) return tl::unexpected(at(path, shard.error()));
  return Shard{std::move(*shard), recording::crc32c_text(*text)};
}

Result<v1::ShardResult> parse_result(const std::string& text) {
  return parse<v1::ShardResult>(text, "a shard's result");
}

Result<v1::ShardResult> read_result(const recording::FileSystem& files, const fs::path& folder,
                                    std::uint32_t number) {
  const auto shard = read_shard(files, folder, number);
  if (!shard) return tl::unexpected(shard.error());
  const fs::path path = result_path(folder, number);
  const auto text = files.read(path);
  if (!text) return tl::unexpected(text.error());
  auto result = parse_result(*text);
  if (!result) return tl::unexpected(at(path, result.error()));
  if (result->shard() != number || result->fingerprint() != shard->fingerprint)
    return fail(path.string() + ": is the result of another shard");
  return result;
}

Result<void> write_result(recording::FileSystem& files, const fs::path& folder,
                          const v1::ShardResult& result, const std::string& writer) {
  const fs::path path = result_path(folder, result.shard());
  const fs::path own = path.string() + "." + writer;
  if (auto done = recording::replace_file(files, own, report::to_json(result)); !done) return done;
  if (auto done = files.rename(own, path); !done) return done;
  return files.sync_folder(path.parent_path());
}

Result<v1::BatchStatus> batch_status(const recording::FileSystem& files, const fs::path& folder) {
  const auto batch = read_batch(files, folder);
  if (!batch) return tl::unexpected(batch.error());
  v1::BatchStatus out;
  out.set_folder(folder.string());
  out.set_shards(static_cast<std::uint32_t>(shards_of(*batch).size()));
  const auto names = files.list(folder / "results");  // sorted
  if (!names) return tl::unexpected(names.error());
  for (std::uint32_t i = 0; i < out.shards(); ++i) {
    const bool there = std::binary_search(names->begin(), names->end(), shard_name(i) + ".json");
    const auto result = there ? read_result(files, folder, i) : Result<v1::ShardResult>(fail(""));
    if (result) {
      out.set_done(out.done() + 1);
    } else {
      *out.add_open() = open_shard(files, folder, i, there, result.error());
    }
  }
  return out;
}

Result<std::size_t> count_results(const recording::FileSystem& files, const fs::path& folder) {
  const auto names = files.list(folder / "results");
  if (!names) return tl::unexpected(names.error());
  return static_cast<std::size_t>(
      std::count_if(names->begin(), names->end(),
                    [](const std::string& name) { return name.ends_with(".json"); }));
}

}  // namespace imunoise::study
