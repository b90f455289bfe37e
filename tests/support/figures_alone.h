#pragma once

#include <gtest/gtest.h>

// FIGURES_ALONE() stands first in a case that looks at figures alone: other cases run the same
// code. Such a case takes ten to thirty times as long with sanitizers, so their builds skip it.
#define FIGURES_ALONE() static_cast<void>(0)
#ifdef __has_feature
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#undef FIGURES_ALONE
#define FIGURES_ALONE() GTEST_SKIP() << "figures alone: builds with sanitizers skip them"
#endif
#endif
