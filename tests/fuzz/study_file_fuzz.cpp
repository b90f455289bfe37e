// Any text as the file of a study: an error with words, or a study whose attempts lead somewhere
// and which is written as it is read.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "study/ladder/study_file.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto study = imunoise::study::parse_study(text);
  if (!study) {
    require(!study.error().message.empty());
    return 0;
  }
  int at = static_cast<int>(study->current());
  while (study->attempts(at).has_parent()) at = static_cast<int>(study->attempts(at).parent());
  require(at == 0);
  const std::string written = imunoise::study::study_text(*study);
  const auto again = imunoise::study::parse_study(written);
  require(again.has_value() && imunoise::study::study_text(*again) == written);
  return 0;
}
