// The plain interface of the database: values come back as they went in, trouble has words.

#include "daemon/catalogue/database.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "daemon/catalogue/schema.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::catalogue {
namespace {

class SqliteDatabase : public ::testing::Test {
 protected:
  std::unique_ptr<Database> opened(const std::string& name = "index.sqlite") const {
    auto out = Database::open((folder_.path() / name).string());
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(SqliteDatabase, ValuesComeBackAsTheyWentIn) {
  const auto database = opened();
  ASSERT_TRUE(database->execute(
      "create table t (a bigint, b double precision, c text, d double precision)"));
  const std::string odd = "Müller's \"bench\"; drop table t; :a";
  const Row row = {std::numeric_limits<std::int64_t>::max(), 0.1 + 0.2, odd, Value()};
  ASSERT_TRUE(database->execute("insert into t values (:a, :b, :c, :d)", row));
  const auto back = database->query("select * from t where c = :c", {odd});
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->size(), 1U);
  EXPECT_EQ(back->front(), row);
  EXPECT_TRUE(database->query("select * from t where c = :c", {std::string("else")})->empty());
}

TEST_F(SqliteDatabase, ATransactionIsDoneAsAWholeOrNotAtAll) {
  const auto database = opened();
  ASSERT_TRUE(database->execute("create table t (a bigint)"));
  const auto insert = [&](std::int64_t a) {
    return database->execute("insert into t values (:a)", {a});
  };
  const auto failed = database->transaction([&]() -> Result<void> {
    if (auto done = insert(1); !done) return done;
    return database->execute("insert into nowhere values (1)");
  });
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("nowhere"), std::string::npos) << failed.error().message;
  EXPECT_TRUE(database->query("select a from t")->empty());
  ASSERT_TRUE(database->transaction([&] { return insert(2); }));
  EXPECT_EQ(database->query("select a from t")->size(), 1U);
}

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

TEST_F(SqliteDatabase, AnOlderSchemaIsMadeAnewAndALaterOneRefused) {
  const auto database = opened();
  ASSERT_TRUE(prepare_schema(*database));
  const auto recordings = [&] { return database->query("select folder from recordings"); };
  ASSERT_TRUE(
      database->execute("insert into recordings values ('', 'a', '', '', 0, 1, '', 0, 0, 0, '')"));
  ASSERT_TRUE(prepare_schema(*database));
  EXPECT_EQ(recordings()->size(), 1U) << "of this version: left alone";
  ASSERT_TRUE(database->execute("update imunoise_schema set version = 0"));
  ASSERT_TRUE(database->execute("alter table recordings drop column trouble"));
  ASSERT_TRUE(prepare_schema(*database));
  EXPECT_TRUE(recordings()->empty());
  EXPECT_TRUE(database->query("select trouble from recordings"));
  ASSERT_TRUE(database->execute("update imunoise_schema set version = 99"));
  const auto later = prepare_schema(*database);
  ASSERT_FALSE(later);
  EXPECT_NE(later.error().message.find("later imunoise"), std::string::npos);
}

}  // namespace
}  // namespace imunoise::catalogue
