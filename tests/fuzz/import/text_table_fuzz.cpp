// Any bytes as a text table, judged: no crash, no number that is not finite in a stretch, and the
// size of the blocks in which the file is read changes nothing.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "recording/import/preflight/preflight.h"
#include "recording/import/text/text_table.h"
#include "tests/fuzz/import/memory_file.h"

using namespace imunoise;
using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::uint8_t choice = data[0];
  ImportOptions options;
  if ((choice & 1U) != 0) options.rate = Hertz{100.0};
  if ((choice & 2U) != 0) options.header = (choice & 4U) != 0;
  if ((choice & 8U) != 0) options.delimiter = ",; \t"[choice >> 4U & 3U];
  if ((choice & 64U) != 0) {
    options.channels = {"*x"};
    options.axes_to_judge = true;
  }
  const MemoryFile file({static_cast<const char*>(static_cast<const void*>(data + 2)), size - 2});
  const Progress progress;
  std::atomic<double> done = 0.0;
  FileProgress first(progress, done, 1);
  FileProgress second(progress, done, 1);
  const auto whole = read_text_table(file.path(), options, first);
  const auto pieces = read_text_table(file.path(), options, second, 1 + data[1] % 64U);
  if (whole.has_value() != pieces.has_value()) std::abort();
  if (!whole) {
    if (whole.error().message != pieces.error().message) std::abort();
    return 0;
  }
  if (whole->columns.size() != pieces->columns.size()) std::abort();
  std::vector<std::string> wanted;  // the first channel, or all
  for (const Column& one : whole->columns) {
    if (wanted.empty() || !options.axes_to_judge) wanted.push_back(one.name);
  }
  const auto judged = judge("f", *whole, wanted, options);
  const auto again = judge("f", *pieces, wanted, options);
  if (judged.has_value() != again.has_value()) std::abort();
  if (!judged) {
    if (judged.error().message != again.error().message) std::abort();
    return 0;
  }
  if (!(judged->rate == again->rate) || !(judged->rate.value > 0.0)) std::abort();
  for (std::size_t c = 0; c < judged->columns.size(); ++c) {
    const auto& values = std::get<std::vector<double>>(judged->columns[c].samples);
    const auto& same = std::get<std::vector<double>>(again->columns[c].samples);
    for (const Stretch& stretch : judged->stretches) {
      for (std::size_t i = stretch.begin; i < stretch.begin + stretch.count; ++i) {
        if (!std::isfinite(values.at(i)) || values[i] != same.at(i)) std::abort();
      }
    }
  }
  return 0;
}
