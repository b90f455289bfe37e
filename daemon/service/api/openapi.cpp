#include "daemon/service/api/openapi.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/descriptor_database.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/support/json_text.h"
#include "daemon/service/api/descriptors.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;

constexpr std::string_view kAbout =
    "imunoised records static data of inertial sensors and fits noise models. Numbers of "
    "64 "
    "bits are strings; a number that is not known is absent.";

// Comments, which the program's own descriptors do not have.
class Comments {
 public:
  Comments() : pool_(&database_) {
    google::protobuf::FileDescriptorSet set;
    const std::string_view bytes = descriptor_set();
    set.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
    for (const auto& file : set.file()) database_.Add(file);
  }

  std::string of(const Descriptor& message) const {
    return text(pool_.FindMessageTypeByName(message.full_name()));
  }
  std::string of(const FieldDescriptor& field) const {
    return text(pool_.FindFieldByName(field.full_name()));
  }

 private:
  template <class AnyDescriptor>
  static std::string text(const AnyDescriptor* described) {
    google::protobuf::SourceLocation at;
    if (described == nullptr || !described->GetSourceLocation(&at)) return "";
    std::string out = at.leading_comments + at.trailing_comments;
    std::replace(out.begin(), out.end(), '\n', ' ');
    const std::size_t begin = out.find_first_not_of(' ');
    if (begin == std::string::npos) return "";
    return out.substr(begin, out.find_last_not_of(' ') + 1 - begin);
  }

  google::protobuf::SimpleDescriptorDatabase database_;
  google::protobuf::DescriptorPool pool_;
};

// "StudyRequest.Open" of imunoise.v1.StudyRequest.Open
std::string short_name(const Descriptor& message) {
  return message.full_name().substr(message.file()->package().size() + 1);
}

class Schemas {
 public:
  // What stands for a message; the message itself is kept for components().
  std::string reference(const Descriptor& message) {
    if (known_.insert(short_name(message)).second) wanted_.push_back(&message);
    return JsonObject().add_text("$ref", "#/components/schemas/" + short_name(message)).text();
  }

  std::string field(const FieldDescriptor& of) {
    JsonObject out;
    if (const std::string comment = comments_.of(of); !comment.empty())
      out.add_text("description", comment);
    if (of.is_map()) {
      out.add_text("type", "object");
      out.add("additionalProperties", value(*of.message_type()->FindFieldByName("value")));
      return out.text();
    }
    if (!of.is_repeated()) {
      out.add("allOf", json_array({value(of)}));
      return out.text();
    }
    out.add_text("type", "array").add("items", value(of));
    return out.text();
  }

  // The body of a request: an object of all fields of a message but these, each of which may be
  // left out.
  std::string body(const Descriptor& message, const std::set<std::string>& without) {
    return object(message, without).text();
  }

  // All that were referred to, and what they refer to. Responses print every field that is no
  // message and not optional.
  std::string components() {
    std::map<std::string, std::string> out;
    while (!wanted_.empty()) {
      const Descriptor& next = *wanted_.back();
      wanted_.pop_back();
      JsonObject schema = object(next, {});
      std::vector<std::string> printed;
      for (int i = 0; i < next.field_count(); ++i) {
        if (!next.field(i)->has_presence()) printed.push_back(json_string(next.field(i)->name()));
      }
      if (!printed.empty()) schema.add("required", json_array(printed));
      out[short_name(next)] = schema.text();
    }
    JsonObject text;
    for (const auto& [name, schema] : out) text.add(name, schema);
    return text.text();
  }

 private:
  JsonObject object(const Descriptor& message, const std::set<std::string>& without) {
    JsonObject properties;
    for (int i = 0; i < message.field_count(); ++i) {
      const FieldDescriptor& one = *message.field(i);
      if (!without.contains(one.name())) properties.add(one.name(), field(one));
    }
    JsonObject out;
    out.add_text("type", "object").add("properties", properties.text());
    if (const std::string comment = comments_.of(message); !comment.empty())
      out.add_text("description", comment);
    return out;
  }

  static std::string simple(std::string_view type, std::string_view format = "") {
    JsonObject out;
    out.add_text("type", type);
    if (!format.empty()) out.add_text("format", format);
    return out.text();
  }
  static std::string words(const EnumDescriptor& type) {
    std::vector<std::string> out;
    for (int i = 0; i < type.value_count(); ++i) out.push_back(json_string(type.value(i)->name()));
    return JsonObject().add_text("type", "string").add("enum", json_array(out)).text();
  }
  std::string value(const FieldDescriptor& of) {
    switch (of.type()) {
      case FieldDescriptor::TYPE_DOUBLE:
        return simple("number", "double");
      case FieldDescriptor::TYPE_FLOAT:
        return simple("number", "float");
      case FieldDescriptor::TYPE_BOOL:
        return simple("boolean");
      case FieldDescriptor::TYPE_UINT32:
        return JsonObject().add_text("type", "integer").add("minimum", "0").text();
      case FieldDescriptor::TYPE_INT32:
        return simple("integer", "int32");
      case FieldDescriptor::TYPE_INT64:
        return simple("string", "int64");
      case FieldDescriptor::TYPE_UINT64:
        return simple("string", "uint64");
      case FieldDescriptor::TYPE_BYTES:
        return simple("string", "byte");
      case FieldDescriptor::TYPE_ENUM:
        return words(*of.enum_type());
      case FieldDescriptor::TYPE_MESSAGE:
        return reference(*of.message_type());
      default:
        return simple("string");
    }
  }

  Comments comments_;
  std::set<std::string> known_;
  std::vector<const Descriptor*> wanted_;
};

std::set<std::string> path_fields(const Route& route) {
  std::set<std::string> out;
  for (const PathPart& part : route.parts) {
    if (part.field) out.insert(part.name);
  }
  return out;
}

// As OpenAPI writes it, which knows no fields of several segments.
std::string plain_path(const Route& route) {
  std::string out;
  for (const PathPart& part : route.parts) {
    out += "/" + (part.field ? "{" + part.name + "}" : part.name);
  }
  return out;
}

std::string content(std::string_view media, const std::string& schema) {
  return JsonObject().add(media, JsonObject().add("schema", schema).text()).text();
}

std::string parameters(const Route& route, Schemas& schemas) {
  std::vector<std::string> out;
  const std::set<std::string> in_path = path_fields(route);
  const Descriptor& request = *route.method->input_type();
  for (int i = 0; i < request.field_count(); ++i) {
    const FieldDescriptor& field = *request.field(i);
    const bool required = in_path.contains(field.name());
    if (!required && route.verb == "POST") continue;
    JsonObject one;
    one.add_text("name", field.name()).add_text("in", required ? "path" : "query");
    if (required) one.add("required", "true");
    out.push_back(one.add("schema", schemas.field(field)).text());
  }
  return json_array(out);
}

std::string responses(const Route& route, Schemas& schemas) {
  const Descriptor& reply = *route.method->output_type();
  const bool stream = route.method->server_streaming();
  const std::string media = stream                          ? "text/event-stream"
                            : route.http.produces().empty() ? "application/json"
                                                            : route.http.produces();
  const std::string schema = route.http.produces().empty()
                                 ? schemas.reference(reply)
                                 : JsonObject().add_text("type", "string").text();
  const auto response = [&](std::string_view about) {
    return JsonObject()
        .add_text("description", about)
        .add("content", content(media, schema))
        .text();
  };
  JsonObject out;
  out.add("200", response(stream ? "events, each with the field that is set as its name" : "done"));
  if (route.verb == "POST" && &reply == v1::Job::descriptor())
    out.add("202", response("the job continues; ask again, or read the events"));
  out.add("default", JsonObject()
                         .add_text("description", "refused")
                         .add("content", content("application/json",
                                                 schemas.reference(*v1::Refusal::descriptor())))
                         .text());
  return out.text();
}

std::string operation(const Route& route, Schemas& schemas) {
  JsonObject out;
  out.add_text("operationId", route.method->name());
  out.add("tags", json_array({json_string(route.method->service()->name())}));
  out.add_text("summary", route.http.summary());
  out.add_text("x-role", v1::Role_Name(route.http.role()));
  if (route.http.role() == v1::anyone) out.add("security", "[]");
  out.add("parameters", parameters(route, schemas));
  if (route.verb == "POST") {
    const std::string body = schemas.body(*route.method->input_type(), path_fields(route));
    out.add("requestBody", JsonObject().add("content", content("application/json", body)).text());
  }
  return out.add("responses", responses(route, schemas)).text();
}

// As OpenAPI writes verbs.
std::string lower(std::string verb) {
  for (char& c : verb) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return verb;
}

std::string paths(const Routes& routes, Schemas& schemas) {
  std::map<std::string, JsonObject> by_path;
  for (const Route& route : routes.all()) {
    by_path[plain_path(route)].add(lower(route.verb), operation(route, schemas));
  }
  JsonObject out;
  for (const auto& [path, operations] : by_path) out.add(path, operations.text());
  return out.text();
}

}  // namespace

std::string openapi_document(const Routes& routes, const std::string& version) {
  Schemas schemas;
  JsonObject info;
  info.add_text("title", "imunoised").add_text("version", version);
  info.add_text("description", kAbout);
  const std::string all = paths(routes, schemas);
  const std::string bearer =
      JsonObject().add_text("type", "http").add_text("scheme", "bearer").text();
  JsonObject components;
  components.add("securitySchemes", JsonObject().add("bearer", bearer).text());
  components.add("schemas", schemas.components());
  JsonObject out;
  out.add_text("openapi", "3.0.3").add("info", info.text());
  out.add("security", json_array({JsonObject().add("bearer", "[]").text()}));
  return out.add("paths", all).add("components", components.text()).text();
}

}  // namespace imunoise::service
