// Any bytes as a sidecar: no crash, and what is accepted can be used.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "recording/import/table/sidecar.h"

using namespace imunoise;
using namespace imunoise::recording;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto got =
      parse_sidecar("fuzz.json", {static_cast<const char*>(static_cast<const void*>(data)), size});
  if (!got) return 0;
  if (!std::isfinite(got->rate_hz()) || got->rate_hz() < 0.0) std::abort();
  for (const v1::SidecarChannel& channel : got->channels()) {
    if (channel.name().empty() || !std::isfinite(channel.scale_factor()) ||
        !std::isfinite(channel.add_offset())) {
      std::abort();
    }
  }
  return 0;
}
