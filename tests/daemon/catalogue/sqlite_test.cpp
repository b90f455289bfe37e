// What only a SQLite file can do.

#include <gtest/gtest.h>

#include <fstream>

#include "daemon/catalogue/database.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::catalogue {
namespace {

class SqliteDatabase : public ::testing::Test {
 protected:
  std::unique_ptr<Database> opened(const std::string& name) const {
    auto out = Database::open((folder_.path() / name).string());
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SqliteDatabase, PathsMayHoldAlmostAnything) {
  EXPECT_TRUE(opened("a = b; c.sqlite")->execute("create table t (a bigint)"));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "a = b; c.sqlite"));
  const auto refused = Database::open((folder_.path() / "a\"b").string());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("quotation mark"), std::string::npos);
}

TEST_F(SqliteDatabase, TroubleNamesTheDatabaseButNoPassword) {
  const std::string absent = (folder_.path() / "absent" / "x.sqlite").string();
  const auto nowhere = Database::open(absent);
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find(absent), std::string::npos) << nowhere.error().message;
  std::ofstream(folder_.path() / "text.sqlite") << "this is no database, but long enough for one\n";
  const auto text = opened("text.sqlite")->query("select 1 from t");
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().message.find("not a database"), std::string::npos) << text.error().message;
  const auto postgres = Database::open("postgresql://host=/nonexistent dbname=x password=secret");
  ASSERT_FALSE(postgres);
  EXPECT_EQ(postgres.error().message.find("secret"), std::string::npos) << postgres.error().message;
  EXPECT_NE(postgres.error().message.find("PostgreSQL"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::catalogue
