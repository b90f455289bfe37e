#include "cli/client/event_reader.h"

#include <utility>

namespace imunoise::cli {
namespace {

constexpr std::size_t kLargestEvent = std::size_t{16} << 20U;

// What follows "event:" or "data:" and a blank.
bool field(std::string_view line, std::string_view name, std::string_view& value) {
  if (!line.starts_with(name)) return false;
  value = line.substr(name.size());
  if (value.starts_with(' ')) value.remove_prefix(1);
  return true;
}

}  // namespace

void EventReader::line(std::string_view text) {
  std::string_view value;
  if (field(text, "event:", value)) {
    name_ = value;
  } else if (field(text, "data:", value)) {
    if (!data_.empty()) data_ += '\n';
    data_ += value;
  }
}

bool EventReader::push(
    std::string_view bytes,
    const std::function<bool(std::string_view name, const std::string& data)>& take) {
  rest_ += bytes;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = rest_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    if (end > begin) {
      line(std::string_view(rest_).substr(begin, end - begin));
      continue;
    }
    const std::string name = std::exchange(name_, {});
    const std::string data = std::exchange(data_, {});
    if (!data.empty() && !take(name, data)) return false;
  }
  rest_.erase(0, begin);
  return rest_.size() + data_.size() <= kLargestEvent;
}

}  // namespace imunoise::cli
