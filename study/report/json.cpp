#include "study/report/json.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/util/json_util.h>

#include <cassert>
#include <cmath>
#include <memory>
#include <vector>

#include "study/words/text.h"

namespace imunoise::report {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// Makes one field of a message fit for JSON.
void clean(Message& m, const Reflection& r, const FieldDescriptor* f);

void clean(Message& message) {
  const Reflection& reflection = *message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) clean(message, reflection, field);
}

void clean(Message& m, const Reflection& r, const FieldDescriptor* f) {
  const int size = f->is_repeated() ? r.FieldSize(m, f) : 0;
  switch (f->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      for (int i = 0; i < size; ++i) assert(std::isfinite(r.GetRepeatedDouble(m, f, i)));
      if (!f->is_repeated() && r.GetDouble(m, f) == 0.0) r.SetDouble(&m, f, 0.0);  // "-0" is none
      if (f->is_repeated() || std::isfinite(r.GetDouble(m, f))) return;
      assert(f->has_optional_keyword() && "only optional numbers may be unknown");
      r.ClearField(&m, f);
      return;
    case FieldDescriptor::CPPTYPE_FLOAT:
      assert(f->is_repeated() && "a single number is a double");
      for (int i = 0; i < size; ++i) assert(std::isfinite(r.GetRepeatedFloat(m, f, i)));
      return;
    case FieldDescriptor::CPPTYPE_STRING:
      if (!f->is_repeated()) r.SetString(&m, f, clean_text(r.GetString(m, f)));
      for (int i = 0; i < size; ++i)
        r.SetRepeatedString(&m, f, i, clean_text(r.GetRepeatedString(m, f, i)));
      return;
    case FieldDescriptor::CPPTYPE_MESSAGE:
      if (!f->is_repeated()) clean(*r.MutableMessage(&m, f));
      for (int i = 0; i < size; ++i) clean(*r.MutableRepeatedMessage(&m, f, i));
      return;
    default:
      return;
  }
}

}  // namespace

std::string to_json(const Message& message, JsonLayout layout) {
  const std::unique_ptr<Message> copy(message.New());
  copy->CopyFrom(message);
  clean(*copy);
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = layout == JsonLayout::kIndented;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string out;
  const auto status = google::protobuf::util::MessageToJsonString(*copy, &out, options);
  assert(status.ok());
  (void)status;
  return out;
}

}  // namespace imunoise::report
