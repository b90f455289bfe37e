#include "daemon/service/api/json.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "study/report/json.h"

namespace imunoise::service {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number out{};
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, out);
  if (error != std::errc() || at != end) return std::nullopt;
  return out;
}

// Sets a field, or appends to it; false where the text does not fit.
bool set(Message& message, const FieldDescriptor& field, const std::string& text) {
  const auto& reflection = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_STRING:
      if (field.is_repeated()) {
        reflection.AddString(&message, &field, text);
      } else {
        reflection.SetString(&message, &field, text);
      }
      return true;
    case FieldDescriptor::CPPTYPE_BOOL:
      reflection.SetBool(&message, &field, text == "true");
      return text == "true" || text == "false";
    case FieldDescriptor::CPPTYPE_UINT32: {
      const auto number = number_of<std::uint32_t>(text);
      if (number) reflection.SetUInt32(&message, &field, *number);
      return number.has_value();
    }
    case FieldDescriptor::CPPTYPE_UINT64: {
      const auto number = number_of<std::uint64_t>(text);
      if (number) reflection.SetUInt64(&message, &field, *number);
      return number.has_value();
    }
    case FieldDescriptor::CPPTYPE_DOUBLE: {
      const auto number = number_of<double>(text);
      if (number) reflection.SetDouble(&message, &field, *number);
      return number && std::isfinite(*number);
    }
    default:
      return false;
  }
}

// "there are campaign, level"
std::string known_fields(const Message& message) {
  std::string out;
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    out += (i == 0 ? "there are " : ", ") + message.GetDescriptor()->field(i)->name();
  }
  return out.empty() ? "there are none" : out;
}

Result<void> take(Message& message, const TextFields& texts) {
  for (const auto& [name, text] : texts) {
    const FieldDescriptor* const field = message.GetDescriptor()->FindFieldByName(name);
    if (field == nullptr)
      return fail(fmt::format("the parameter '{}' is unknown; {}", name, known_fields(message)));
    if (!set(message, *field, text))
      return fail(fmt::format("{}: '{}' is not a valid {}", name, text, field->cpp_type_name()));
  }
  return {};
}

Result<void> take_body(Message& message, const std::string& body) {
  if (body.empty()) return {};
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(body, &message, strict);
  if (!status.ok())
    return fail("the body does not fit this method: " + std::string(status.message()));
  return {};
}

// The path says what a field is; a body that says otherwise is a mistake.
Result<void> take_path(Message& message, const TextFields& path) {
  for (const auto& [name, text] : path) {
    const FieldDescriptor& field = *message.GetDescriptor()->FindFieldByName(name);
    const std::string in_body = message.GetReflection()->GetString(message, &field);
    if (!in_body.empty() && in_body != text)
      return fail(fmt::format("{}: the path says '{}', the body '{}'", name, text, in_body));
  }
  return take(message, path);
}

}  // namespace

Result<std::unique_ptr<Message>> request_of(const Route& route, const TextFields& path,
                                            const TextFields& query, const std::string& body) {
  std::unique_ptr<Message> out(google::protobuf::MessageFactory::generated_factory()
                                   ->GetPrototype(route.method->input_type())
                                   ->New());
  const bool post = route.verb == "POST";
  if (post && !query.empty()) return fail("this method takes a JSON object, not a query");
  if (!post && !body.empty()) return fail("this method takes a query, not a body");
  for (const auto& done : {take_body(*out, body), take_path(*out, path), take(*out, query)}) {
    if (!done) return tl::unexpected(done.error());
  }
  return out;
}

std::string response_text(const Message& message) { return report::to_json(message); }

std::string event_text(const std::string& name, const Message& message) {
  return fmt::format("event: {}\ndata: {}\n\n", name,
                     report::to_json(message, report::JsonLayout::kOneLine));
}

}  // namespace imunoise::service
