#include "drivers/can/codec/dbc_file.h"

#include <fstream>
#include <iterator>

namespace imunoise::drivers {

Result<std::string> read_dbc_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file.is_open() || file.bad())
    return fail(path + ": cannot be read; check the path and its permissions");
  return text;
}

}  // namespace imunoise::drivers
