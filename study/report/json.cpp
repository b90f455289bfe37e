#include "study/report/json.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <cassert>
#include <cmath>
#include <string_view>

#include "study/report/text.h"

namespace imunoise::report {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const char32_t c = next_code_point(text, at);
    if (c == U'"' || c == U'\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c == U'\n') {
      out += "\\n";
    } else if (c == U'\t') {
      out += "\\t";
    } else if (c < 0x20 || c == 0x7F || c == 0x2028 || c == 0x2029) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      append_utf8(out, c);
    }
  }
  return out + '"';
}

template <class Float>
std::string entry(Float value) {
  assert(std::isfinite(value) && "a list of a report must be finite");
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

void print(const Message& message, int depth, std::string& out);

// One value: field itself, or entry `i` of a list.
std::string scalar(const Message& m, const Reflection& r, const FieldDescriptor* f, int i) {
  const bool list = f->is_repeated();
  switch (f->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return entry(list ? r.GetRepeatedDouble(m, f, i) : r.GetDouble(m, f));
    case FieldDescriptor::CPPTYPE_FLOAT:
      return entry(list ? r.GetRepeatedFloat(m, f, i) : r.GetFloat(m, f));
    case FieldDescriptor::CPPTYPE_INT32:
      return fmt::format("{}", list ? r.GetRepeatedInt32(m, f, i) : r.GetInt32(m, f));
    case FieldDescriptor::CPPTYPE_UINT32:
      return fmt::format("{}", list ? r.GetRepeatedUInt32(m, f, i) : r.GetUInt32(m, f));
    case FieldDescriptor::CPPTYPE_INT64:
      return fmt::format(R"("{}")", list ? r.GetRepeatedInt64(m, f, i) : r.GetInt64(m, f));
    case FieldDescriptor::CPPTYPE_UINT64:
      return fmt::format(R"("{}")", list ? r.GetRepeatedUInt64(m, f, i) : r.GetUInt64(m, f));
    case FieldDescriptor::CPPTYPE_BOOL:
      return (list ? r.GetRepeatedBool(m, f, i) : r.GetBool(m, f)) ? "true" : "false";
    case FieldDescriptor::CPPTYPE_ENUM:
      return quoted((list ? r.GetRepeatedEnum(m, f, i) : r.GetEnum(m, f))->name());
    case FieldDescriptor::CPPTYPE_STRING:
      assert(f->type() == FieldDescriptor::TYPE_STRING && "reports hold no bytes");
      return quoted(list ? r.GetRepeatedString(m, f, i) : r.GetString(m, f));
    case FieldDescriptor::CPPTYPE_MESSAGE:
      break;
  }
  assert(false && "messages are printed by print()");
  return "null";
}

bool absent(const Message& m, const Reflection& r, const FieldDescriptor* f) {
  if (f->is_repeated()) return false;
  if (f->has_presence() && !r.HasField(m, f)) return true;
  if (f->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) return !std::isfinite(r.GetDouble(m, f));
  if (f->cpp_type() == FieldDescriptor::CPPTYPE_FLOAT) return !std::isfinite(r.GetFloat(m, f));
  return false;
}

void print_list(const Message& m, const Reflection& r, const FieldDescriptor* f, int depth,
                std::string& out) {
  const bool messages = f->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  const int size = r.FieldSize(m, f);
  out += '[';
  for (int i = 0; i < size; ++i) {
    out += i == 0 ? "" : ", ";
    if (messages) {
      print(r.GetRepeatedMessage(m, f, i), depth, out);
    } else {
      out += scalar(m, r, f, i);
    }
  }
  out += ']';
}

void print(const Message& message, int depth, std::string& out) {
  const Reflection& reflection = *message.GetReflection();
  const std::string indent(static_cast<std::size_t>(2 * (depth + 1)), ' ');
  out += '{';
  bool first = true;
  for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor* field = message.GetDescriptor()->field(i);
    assert(!field->is_map() && "reports hold no maps");
    if (absent(message, reflection, field)) continue;
    out += first ? "\n" : ",\n";
    first = false;
    out += indent + quoted(field->name()) + ": ";
    if (field->is_repeated()) {
      print_list(message, reflection, field, depth + 1, out);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      print(reflection.GetMessage(message, field), depth + 1, out);
    } else {
      out += scalar(message, reflection, field, 0);
    }
  }
  if (!first) out += "\n" + indent.substr(2);
  out += '}';
}

}  // namespace

std::string to_json(const Message& message) {
  std::string out;
  print(message, 0, out);
  return out + "\n";
}

}  // namespace imunoise::report
