#pragma once

#include <gtest/gtest.h>

// FIGURES_ALONE() stands first in a case that looks at figures of many simulated sets. Such a case
// takes up to thirty times as long under AddressSanitizer, and shorter cases beside it run the same
// code, so AddressSanitizer's build skips it.
#define FIGURES_ALONE() static_cast<void>(0)
#ifdef __has_feature
#if __has_feature(address_sanitizer)
#undef FIGURES_ALONE
#define FIGURES_ALONE() GTEST_SKIP() << "figures alone: AddressSanitizer's build skips them"
#endif
#endif
