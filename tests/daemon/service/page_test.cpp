// The page's files as responses.

#include "daemon/service/page/page.h"

#include <gtest/gtest.h>

#include "daemon/service/access/sessions.h"

namespace imunoise::service {
namespace {

constexpr Asset kFiles[] = {{"/index.html", "\"1\"", "page"}, {"/app.js", "\"2\"", "code"}};

std::string header_of(const Response& response, const std::string& name) {
  for (const auto& [key, value] : response.headers) {
    if (key == name) return value;
  }
  return "";
}

TEST(Page, ItsFilesAreFoundByTheirPath) {
  EXPECT_EQ(find_asset(kFiles, {}), &kFiles[0]);
  EXPECT_EQ(find_asset(kFiles, {"app.js"}), &kFiles[1]);
  EXPECT_EQ(find_asset(kFiles, {"app.js", "app.js"}), nullptr);
  EXPECT_EQ(find_asset({}, {}), nullptr);
}

TEST(Page, ItAllowsNothingButItsOwnFiles) {
  RequestHead head;
  head.accept_encoding = "gzip, br";
  const Response page = asset_response(kFiles[0], head);
  EXPECT_EQ(page.status, 200U);
  EXPECT_EQ(page.body, "page");
  EXPECT_EQ(header_of(page, "Content-Encoding"), "gzip");
  const std::string policy = header_of(page, "Content-Security-Policy");
  EXPECT_NE(policy.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(policy.find("unsafe"), std::string::npos);
  EXPECT_EQ(asset_response(kFiles[1], head).content_type, "text/javascript; charset=utf-8");
}

TEST(Page, ABrowserThatHasItGetsNothing) {
  RequestHead head;
  EXPECT_EQ(asset_response(kFiles[0], head).status, 406U);
  head.accept_encoding = "gzip";
  head.if_none_match = "\"1\"";
  EXPECT_EQ(asset_response(kFiles[0], head).status, 304U);
  EXPECT_TRUE(asset_response(kFiles[0], head).body.empty());
  EXPECT_EQ(asset_response(kFiles[1], head).status, 200U);
}

TEST(Sessions, TheOldestEndsWhereThereAreTooMany) {
  Sessions sessions;
  const std::string first = sessions.open(v1::viewer);
  EXPECT_EQ(sessions.role_of(first), v1::viewer);
  for (int i = 0; i < 256; ++i) sessions.open(v1::operator_);
  EXPECT_FALSE(sessions.role_of(first));
}

TEST(Sessions, CookiesAreOfOnePort) {
  EXPECT_EQ(cookie_name("localhost:8080"), "imunoise_8080");
  EXPECT_EQ(cookie_name("localhost"), "imunoise");
  EXPECT_EQ(cookie_name("localhost:8 0"), "imunoise");
  EXPECT_EQ(cookie_value("a=1; imunoise_80=x; imunoise_8080=y", "imunoise_8080"), "y");
  EXPECT_EQ(cookie_value("imunoise_80800=x", "imunoise_8080"), "");
  EXPECT_EQ(cookie_value("", "imunoise"), "");
}

}  // namespace
}  // namespace imunoise::service
