// Any bytes: parse_model() returns an error or a model, and a model it printed is the model it
// reads.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/effects/parse_full_model.h"
#include "core/model/model.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_round_trip(const imunoise::Model& model, imunoise::Hertz rate) {
  const std::string text = imunoise::print(model);
  const auto again = imunoise::parse_model(text, rate);
  require(again.has_value());
  require(*again == model);
  require(imunoise::print(*again) == text);

  // With every value written out it is the same model, every parameter given.
  const std::string whole = imunoise::print_with_values(model);
  const auto full = imunoise::parse_model(whole, rate);
  require(full.has_value());
  require(imunoise::complete(*full));
  require(imunoise::print(*full) == whole);
  require(full->terms.size() == model.terms.size());
  for (std::size_t i = 0; i < model.terms.size(); ++i) {
    require(full->terms[i].process == model.terms[i].process);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const imunoise::Hertz rate{100.0};
  const auto model = imunoise::parse_model(text, rate);
  if (model) {
    require(!model->terms.empty());
    check_round_trip(*model, rate);
  } else {
    require(!model.error().message.empty());
  }
  // Models of arrays and over covariates read more; what is printed reads back.
  for (const auto parse : {&imunoise::parse_array_model, &imunoise::parse_dynamic_model}) {
    if (const auto more = parse(text, rate)) {
      const std::string printed = imunoise::print(*more);
      const auto again = parse(printed, rate);
      require(again.has_value() && *again == *more);
    } else {
      require(!model.has_value());
    }
  }
  // Effects are words besides those of noise.
  if (const auto whole = imunoise::parse_full_model(text, rate)) {
    const std::string printed = imunoise::print(*whole);
    const auto again = imunoise::parse_full_model(printed, rate);
    require(again.has_value() && *again == *whole);
  }
  return 0;
}
