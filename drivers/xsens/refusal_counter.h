#pragma once

#include "drivers/codec/refusal.h"
#include "drivers/plugin/samples.h"
#include "drivers/xsens/codec/frame.h"

namespace imunoise::xsens {

/// Counts what a parser refuses as refused samples of the first stream.
class RefusalCounter {
 public:
  /// What was rejected so far belongs to no sample.
  void begin(const drivers::XbusParser& parser) { told_ = parser.refused(); }
  /// Counts what came since.
  void count(const drivers::XbusParser& parser, plugin::Samples& samples);

 private:
  drivers::Refusals told_;
};

}  // namespace imunoise::xsens
