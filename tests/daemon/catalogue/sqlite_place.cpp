#include "tests/daemon/catalogue/empty_place.h"

namespace imunoise::testing {

EmptyPlace empty_place(const std::filesystem::path& folder) {
  return {(folder / "catalogue.sqlite").string(), ""};
}

}  // namespace imunoise::testing
