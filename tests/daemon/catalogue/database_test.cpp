// The plain interface of the database: values come back as they went in, trouble has words.

#include "daemon/catalogue/database.h"

#include <gtest/gtest.h>

#include <limits>

#include "daemon/catalogue/schema.h"
#include "tests/daemon/catalogue/empty_place.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::catalogue {
namespace {

class DatabaseOf : public ::testing::Test {
 protected:
  void SetUp() override {
    const testing::EmptyPlace place = testing::empty_place(folder_.path());
    if (!place.trouble.empty()) GTEST_SKIP() << place.trouble;
    where_ = place.where;
  }
  std::unique_ptr<Database> opened() const {
    auto out = Database::open(where_);
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
  }
  testing::TemporaryFolder folder_;
  std::string where_;
};

TEST_F(DatabaseOf, ValuesComeBackAsTheyWentIn) {
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

TEST_F(DatabaseOf, ATransactionIsDoneAsAWholeOrNotAtAll) {
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

TEST_F(DatabaseOf, AnOlderSchemaIsMadeAnewAndALaterOneRefused) {
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
