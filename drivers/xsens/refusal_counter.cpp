#include "drivers/xsens/refusal_counter.h"

namespace imunoise::xsens {

void RefusalCounter::count(const drivers::XbusParser& parser, plugin::Samples& samples) {
  using drivers::Refusal;
  const drivers::Refusals& now = parser.refused();
  const auto news = [&](Refusal reason) { return now.count(reason) - told_.count(reason); };
  if (const auto n = news(Refusal::kChecksum)) samples.refuse(0, plugin::Reason::kChecksum, n);
  if (const auto n = news(Refusal::kLength)) samples.refuse(0, plugin::Reason::kMalformed, n);
  told_ = now;
}

}  // namespace imunoise::xsens
