#pragma once

#include "daemon/service/campaigns/bench.h"
#include "daemon/service/api/methods.h"
#include "drivers/host/load.h"

namespace imunoise::service {

/// Devices and campaigns. What they are given outlives the methods.
void add_bench_methods(Methods& methods, Bench& bench, const drivers::Drivers& drivers);

}  // namespace imunoise::service
