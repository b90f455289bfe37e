#pragma once

#include <gtest/gtest.h>

// FIGURES_ALONE() stands first in a case that looks at figures of many simulated sets. It shows a
// sanitizer no access to memory that a neighbour of the case does not show it in a tenth of the
// time, so it is left to the optimised build.
#ifdef IMUNOISE_SANITIZED
#define FIGURES_ALONE() GTEST_SKIP() << "figures alone: left to the build without sanitizers"
#else
#define FIGURES_ALONE() static_cast<void>(0)
#endif
