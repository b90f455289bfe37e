#include "drivers/can/codec/decoder.h"

namespace imunoise::drivers {

bool CandumpDecoder::next(DecodedSample& sample) {
  bool found = false;
  while (!found) {
    const auto line = lines_.next();
    if (!line) break;
    found = decode(*line, sample);
  }
  tally_.refused = lines_.refused();
  tally_.refused += own_;
  if (found) ++tally_.samples;
  return found;
}

bool CandumpDecoder::decode(const CandumpLine& line, DecodedSample& sample) {
  switch (channels_.decode(line.frame, sample, own_)) {
    case CanChannels::Outcome::kSample:
      break;
    case CanChannels::Outcome::kIgnored:
      ++tally_.other_messages;
      return false;
    case CanChannels::Outcome::kRefused:
      return false;
  }
  sample.source = line.interface;
  sample.clock = Clock::kHost;
  sample.time_ns = line.time_ns;
  return true;
}

}  // namespace imunoise::drivers
