// Any text as a model, an effect and a fault of an emulated sensor: an error with words, or a
// source that measures numbers.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "drivers/emulator/effects/modelled_source.h"
#include "drivers/emulator/faults/fault_text.h"

using namespace imunoise;
using namespace imunoise::emulator;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void use(const Result<std::unique_ptr<ModelledSource>>& source) {
  if (!source) return require(!source.error().message.empty());
  for (const double time : {0.0, 0.01, 5.0, 0.5}) (*source)->measure(time);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  use(ModelledSource::make({.models = {text}}));
  use(ModelledSource::make({.effects = {text}}));
  const auto fault = parse_fault(text);
  require(fault ? fault->count >= 1 : !fault.error().message.empty());
  return 0;
}
