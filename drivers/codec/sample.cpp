#include "drivers/codec/sample.h"

namespace imunoise::drivers {

std::string_view name_of(Clock clock) {
  switch (clock) {
    case Clock::kNone:
      return "none";
    case Clock::kDevice:
      return "device";
    case Clock::kHost:
      return "host";
    case Clock::kNominal:
      return "nominal";
  }
  return "none";
}

}  // namespace imunoise::drivers
