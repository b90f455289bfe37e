// Prints the OpenAPI document: the page's types are made of it when the page is built.

#include <iostream>

#include "daemon/service/api/openapi.h"
#include "imunoise/v1/service.pb.h"

int main() {
  using namespace imunoise;
  std::cout << service::openapi_document(service::Routes(*v1::Refusal::descriptor()->file()), "0");
}
