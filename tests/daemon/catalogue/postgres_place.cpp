#include "tests/daemon/catalogue/empty_place.h"
#include "tests/daemon/catalogue/postgres_server.h"

namespace imunoise::testing {

EmptyPlace empty_place(const std::filesystem::path&) {
  static const PostgresServer server;
  static int number = 0;
  if (!server.trouble().empty()) return {"", server.trouble()};
  return {server.make_database("test" + std::to_string(++number)), ""};
}

}  // namespace imunoise::testing
