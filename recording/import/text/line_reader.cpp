#include "recording/import/text/line_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>

namespace imunoise::recording {
namespace {

// No row of a table is this long; a binary file without line ends is.
constexpr std::size_t kMaximumLine = std::size_t{1} << 20U;

// CR where the beginning of a file has no LF; whatever the size of blocks.
char ending_of(const File& file) {
  std::vector<char> beginning(std::min<std::uint64_t>(kBlockBytes, file.size()));
  const Result<std::size_t> got = file.read_at(0, beginning);
  const std::string_view read(beginning.data(), got.value_or(0));
  const bool old = read.find('\n') == std::string_view::npos &&
                   read.substr(0, read.size() - std::min<std::size_t>(1, read.size())).find('\r') !=
                       std::string_view::npos;
  return old ? '\r' : '\n';
}

}  // namespace

LineReader::LineReader(const File& file, std::size_t block_bytes)
    : file_(file),
      block_bytes_(std::min<std::uint64_t>(block_bytes, file.size() + 1)),
      ending_(ending_of(file)) {}

bool LineReader::load_more() {
  const std::size_t kept = end_ - begin_;
  if (kept > kMaximumLine) {
    error_ = Error{fmt::format(
        "{}: row {}: a line of more than {} bytes; is this a text file, or a table whose rows are "
        "channels?",
        file_.name(), line_number_ + 1, kMaximumLine)};
    return false;
  }
  if (begin_ > 0 && kept > 0) std::memmove(buffer_.data(), buffer_.data() + begin_, kept);
  begin_ = 0;
  end_ = kept;
  if (buffer_.size() < kept + block_bytes_) buffer_.resize(std::max(2 * kept, kept + block_bytes_));
  const Result<std::size_t> got =
      file_.read_at(loaded_, std::span(buffer_).subspan(kept, block_bytes_));
  if (!got) {
    error_ = got.error();
    return false;
  }
  loaded_ += *got;
  end_ += *got;
  return *got > 0;
}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = 0;
  while (true) {
    const char* const start = buffer_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const void* const found =
        held > searched ? std::memchr(start + searched, ending_, held - searched) : nullptr;
    std::string_view line(start, held);
    if (found != nullptr) {
      line = line.substr(0, static_cast<std::size_t>(static_cast<const char*>(found) - start));
      begin_ += line.size() + 1;
    } else {
      searched = held;
      if (load_more()) continue;
      if (error_ || held == 0) return std::nullopt;
      line = std::string_view(buffer_.data() + begin_, held);  // the last line has no ending
      begin_ = end_;
    }
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line_number_++ == 0) {
      if (line.starts_with("\xff\xfe") || line.starts_with("\xfe\xff")) {
        error_ = Error{fmt::format("{}: is UTF-16 text; save it as UTF-8", file_.name())};
        return std::nullopt;
      }
      if (line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
    }
    return line;
  }
}

}  // namespace imunoise::recording
