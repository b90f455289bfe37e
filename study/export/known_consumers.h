#pragma once

#include <span>
#include <string>
#include <string_view>

#include "study/export/consumer.h"

namespace imunoise::study {

/// Every consumer, in the order of the guide: what the command line, the API and --help read.
std::span<const Consumer* const> known_consumers();
/// Nothing where there is none of that name.
const Consumer* consumer_called(std::string_view name);
/// "kalibr, openvins, ..."
std::string consumer_names();

}  // namespace imunoise::study
