// What was worked out of a recording is found again, and never where it is another's.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "core/model/model.h"
#include "study/cache/cache_folder.h"
#include "study/cache/cache_record.h"
#include "study/ladder/study.h"
#include "study/ladder/study_file.h"

namespace imunoise::study {
namespace {

namespace fs = std::filesystem;

constexpr Hertz kRate{50.0};

// A folder with two files, whose contents nobody reads but whose stamps count.
class Seen : public testing::Test {
 protected:
  Seen() {
    fs::create_directories(root_);
    for (const char* name : {"a.h5", "b.h5"}) {
      write(root_ / name, name);
      input_.add_files((root_ / name).string());
    }
  }
  ~Seen() override { fs::remove_all(root_); }

  static void write(const fs::path& file, std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
  }

  // Two replicates: white noise and a walk, which a temperature pushes; a stretch stands still.
  Result<std::vector<recording::Replicate>> read() {
    ++reads_;
    std::vector<recording::Replicate> out;
    for (std::uint32_t k = 0; k < 2; ++k) {
      auto heat = simulate(*parse_model("WN(sigma2=1e-4) + RW(gamma2=1e-3)", kRate), 8192, 5, k);
      auto gyro = simulate(*parse_model("WN(sigma2=1) + RW(gamma2=1e-5)", kRate), 8192, 6, k);
      for (std::size_t t = 0; t < gyro.size(); ++t) gyro[t] += 0.5 * heat[t];
      std::fill(gyro.begin() + 4000, gyro.begin() + 4300, gyro[4000]);
      const auto channel = [&](const char* name, std::vector<double> values, const char* unit) {
        return recording::Channel{name,
                                  std::make_shared<recording::Samples>(std::move(values)),
                                  0,
                                  8192,
                                  1.0,
                                  0.0,
                                  *parse_unit(unit),
                                  kRate};
      };
      out.push_back({"run" + std::to_string(k + 1),
                     "",
                     kRate,
                     {channel("gyro", std::move(gyro), "rad/s"),
                      channel("temperature", std::move(heat), "K")}});
    }
    return out;
  }

  Result<v1::Study> apply(const v1::Study& study, const v1::StudyRequest& request,
                          const std::optional<fs::path>& cache) {
    const auto reading = [this](const v1::StudyInput&, const std::string&) { return read(); };
    std::optional<CachePlace> keep;
    if (cache) keep = CachePlace{*cache};
    return study::apply(study, request, reading, {}, keep);
  }

  v1::Study opened(const std::optional<fs::path>& cache) {
    v1::StudyRequest request;
    *request.mutable_open()->mutable_input() = input_;
    request.mutable_open()->set_channel("gyro");
    request.mutable_open()->set_model("WN + RW");
    auto study = apply({}, request, cache);
    EXPECT_TRUE(study) << study.error().message;
    return *study;
  }

  std::string added(const v1::Study& study, const std::string& term,
                    const std::optional<fs::path>& cache) {
    v1::StudyRequest request;
    request.mutable_add()->set_term(term);
    const auto out = apply(study, request, cache);
    return out ? study_text(*out) : out.error().message;
  }

  std::vector<fs::path> kept(const fs::path& folder) const {
    std::vector<fs::path> out;
    if (!fs::exists(folder)) return out;
    for (const auto& one : fs::directory_iterator(folder)) out.push_back(one.path());
    return out;
  }

  fs::path root_ = fs::temp_directory_path() / ("imunoise_cache_" + std::to_string(getpid()));
  fs::path home_ = root_ / "home";
  v1::StudyInput input_;
  int reads_ = 0;
};

TEST_F(Seen, WhatIsAddedIsTheSameToTheBitAndNothingIsRead) {
  const v1::Study study = opened(home_);
  EXPECT_EQ(reads_, 1);
  EXPECT_EQ(kept(home_).size(), 1U);
  EXPECT_FALSE(fs::exists(root_ / ".imunoise")) << "nothing lies beside the recordings";
  for (const char* term : {"line(f=3)", "QN", "ramp", "step(replicate=2, t=120)"}) {
    EXPECT_EQ(added(study, term, home_), added(study, term, std::nullopt)) << term;
  }
  EXPECT_EQ(reads_, 1 + 4) << "only without a folder is it read again";
}

TEST_F(Seen, AWitnessIsKeptOnceItWasLookedAt) {
  const v1::Study study = opened(home_);
  const std::string first = added(study, "witness(temperature)", home_);
  EXPECT_EQ(reads_, 2);
  EXPECT_EQ(kept(home_).size(), 2U);
  EXPECT_EQ(added(study, "witness(temperature, lag=2)", home_).substr(0, 1), "{");
  EXPECT_EQ(added(study, "witness(temperature)", home_), first);
  EXPECT_EQ(reads_, 2);
  for (const char* none : {"witness(supply)", "witness(gyro)"}) {
    EXPECT_NE(added(study, none, home_).find("temperature"), std::string::npos)
        << none << ": it is said which there are";
  }
  v1::Study other = study;
  other.add_witnesses("supply");  // and no other
  EXPECT_NE(added(other, "witness(temperature)", home_).substr(0, 1), "{");
}

TEST_F(Seen, AModelThatCannotBeReadCostsNothing) {
  const v1::Study study = opened(home_);
  EXPECT_NE(added(study, "lime(f=3)", home_).find("lime"), std::string::npos);
  EXPECT_EQ(reads_, 1);
  EXPECT_NE(added(study, "witness(temprature)", home_).substr(0, 1), "{");
  EXPECT_EQ(kept(home_).size(), 1U) << "of a model that is none nothing is kept";
}

TEST_F(Seen, TheSearchKeepsAllWitnesses) {
  v1::StudyRequest request;
  request.mutable_candidates();
  const auto sought = apply(opened(home_), request, home_);
  ASSERT_TRUE(sought) << sought.error().message;
  EXPECT_EQ(kept(home_).size(), 2U);
  const int before = reads_;
  EXPECT_EQ(added(*sought, "witness(temperature, quadratic)", home_).substr(0, 1), "{");
  EXPECT_EQ(reads_, before);
  // What is there already is not written again.
  std::vector<fs::path> aside;
  for (const fs::path& one : kept(home_)) {
    aside.push_back(root_ / one.filename());
    fs::create_hard_link(one, aside.back());
  }
  ASSERT_TRUE(apply(*sought, request, home_));
  for (const fs::path& one : aside) EXPECT_TRUE(fs::equivalent(one, home_ / one.filename())) << one;
}

TEST_F(Seen, AFileThatWasWrittenToIsReadAgain) {
  const v1::Study study = opened(home_);
  write(root_ / "b.h5", "c.h5");  // as long as it was
  // A disk's clock may be too coarse to tell so soon.
  fs::last_write_time(root_ / "b.h5",
                      fs::last_write_time(root_ / "b.h5") + std::chrono::seconds(1));
  added(study, "QN", home_);
  EXPECT_EQ(reads_, 2);
  write(root_ / "a.h5.json", "{}");  // a sidecar changes what numbers mean
  added(study, "QN", home_);
  EXPECT_EQ(reads_, 3);
  EXPECT_EQ(kept(home_).size(), 1U) << "what was made of the old files is replaced";
  v1::Study other = study;
  other.mutable_input()->set_rate_hz(10.0);
  added(other, "QN", home_);
  EXPECT_EQ(reads_, 4);
}

TEST_F(Seen, FilesInARecordingsFolderCount) {
  const fs::path recording = root_ / "recording";
  fs::create_directories(recording / "r001" / "imu");
  write(recording / "r001" / "imu" / "000001.h5", "chunk");
  input_.clear_files();
  input_.add_files(recording.string());
  const v1::Study study = opened(home_);
  EXPECT_EQ(kept(home_).size(), 1U);
  added(study, "QN", home_);
  EXPECT_EQ(reads_, 1) << "what is kept is no file of the recording";
  write(recording / "r001" / "imu" / "000002.h5", "chunk");
  added(study, "QN", home_);
  EXPECT_EQ(reads_, 2);
  fs::create_directories(root_ / "other disk");
  fs::create_directory_symlink(root_ / "other disk", recording / "r002");
  added(study, "QN", home_);
  added(study, "QN", home_);
  const int before = reads_;
  write(root_ / "other disk" / "000001.h5", "chunk");
  added(study, "QN", home_);
  EXPECT_EQ(reads_, before + 1) << "what lies behind a link is read, too";
  fs::create_symlink("itself", recording / "itself");
  EXPECT_EQ(added(study, "QN", home_).substr(0, 1), "{") << "a link to nowhere hurts nobody";
}

TEST_F(Seen, DamageIsNoticedAndMended) {
  const v1::Study study = opened(home_);
  const std::string right = added(study, "QN", home_);
  const fs::path file = kept(home_).at(0);
  const auto size = static_cast<std::streamoff>(fs::file_size(file));
  for (const std::streamoff at : {std::streamoff{3}, std::streamoff{40}, size / 2, size - 100}) {
    const int before = reads_;
    std::fstream bytes(file, std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekg(at);
    const int old = bytes.get();
    bytes.seekp(at);
    bytes.put(static_cast<char>(old ^ 16));
    bytes.close();
    EXPECT_EQ(added(study, "QN", home_), right) << at;
    EXPECT_EQ(reads_, before + 1) << at;
    EXPECT_EQ(added(study, "QN", home_), right) << at;
    EXPECT_EQ(reads_, before + 1) << at;
  }
  fs::resize_file(file, static_cast<std::uintmax_t>(size) / 2);
  EXPECT_EQ(added(study, "QN", home_), right);
  fs::remove_all(home_);  // may be done at any time
  EXPECT_EQ(added(study, "QN", home_), right);
}

TEST_F(Seen, WhereTheFolderCannotBeWrittenNothingIsKept) {
  write(home_, "a file is in the way");
  const v1::Study study = opened(home_);
  EXPECT_NE(added(study, "QN", home_).size(), 0U);
  EXPECT_EQ(reads_, 2);
  added(study, "QN", fs::path());  // nowhere
  EXPECT_EQ(reads_, 3);
}

// One folder serves all studies of the user: a relative path names another file elsewhere.
TEST_F(Seen, AFileIsTheSameWhereverTheProgramRuns) {
  const v1::Study study = opened(home_);
  const fs::path here = fs::current_path();
  fs::current_path(root_);
  v1::Study relative = study;
  for (std::string& file : *relative.mutable_input()->mutable_files())
    file = fs::path(file).filename().string();
  EXPECT_EQ(added(relative, "QN", home_).substr(0, 1), "{");
  fs::current_path(here);
  EXPECT_EQ(reads_, 1);
  EXPECT_EQ(kept(home_).size(), 1U);
}

TEST_F(Seen, TheUsersCacheFolderIsTheStandardOne) {
  ::setenv("XDG_CACHE_HOME", "/somewhere/cache", 1);
  EXPECT_EQ(user_cache_folder(), "/somewhere/cache/imunoise");
  ::setenv("XDG_CACHE_HOME", "no/absolute/path", 1);
  const char* const home = std::getenv("HOME");
  const fs::path expected = home == nullptr ? fs::path() : fs::path(home) / ".cache" / "imunoise";
  EXPECT_EQ(user_cache_folder(), expected);
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(user_cache_folder(), expected);
}

TEST_F(Seen, ALinkIsNotFollowed) {
  fs::create_directories(root_ / "elsewhere");
  fs::create_directory_symlink(root_ / "elsewhere", home_);
  opened(home_);
  EXPECT_TRUE(kept(root_ / "elsewhere").empty());
  fs::remove(home_);
  opened(home_);
  const fs::path own = kept(home_).at(0);
  fs::remove(own);
  write(root_ / "precious", "precious");
  fs::create_symlink(root_ / "precious", own.string() + "." + std::to_string(getpid()) + ".part");
  opened(home_);
  EXPECT_EQ(fs::file_size(root_ / "precious"), 8U);
}

TEST_F(Seen, WhatWasUnusedLongestMakesRoom) {
  fs::create_directories(home_);
  const auto now = fs::file_time_type::clock::now();
  for (const char* name : {"older.seen", "old.seen", "other.h5"}) {
    write(home_ / name, "");
    fs::resize_file(home_ / name, std::uintmax_t{3} << 29U);  // with nothing in it
    fs::last_write_time(home_ / name, now - std::chrono::hours(name[3] == '.' ? 1 : 2));
  }
  write(home_ / "1.seen.2.part", "left by who was killed");
  fs::last_write_time(home_ / "1.seen.2.part", now - std::chrono::hours(2));
  write(home_ / "1.seen.3.part", "being written");
  opened(home_);
  EXPECT_FALSE(fs::exists(home_ / "1.seen.2.part"));
  EXPECT_TRUE(fs::exists(home_ / "1.seen.3.part"));
  EXPECT_FALSE(fs::exists(home_ / "older.seen"));
  EXPECT_TRUE(fs::exists(home_ / "old.seen"));
  EXPECT_TRUE(fs::exists(home_ / "other.h5"));
  EXPECT_EQ(kept(home_).size(), 4U);
}

// As two names may have one checksum.
TEST_F(Seen, AnotherStudysFileUnderTheSameNameIsLeftAlone) {
  const v1::Study study = opened(home_);
  const fs::path own = kept(home_).at(0);
  const fs::path aside = root_ / "aside";
  fs::rename(own, aside);
  input_.set_split_into(2);
  opened(home_);
  fs::rename(kept(home_).at(0), own);
  const int before = reads_;
  added(study, "QN", home_);
  EXPECT_EQ(reads_, before + 1);
}

TEST_F(Seen, AnotherRecordingInItsPlaceIsRefused) {
  v1::Study study = opened(home_);
  study.set_fingerprint(study.fingerprint() + 1);
  EXPECT_NE(added(study, "QN", home_).find("changed since"), std::string::npos);
}

TEST_F(Seen, ARecordSaysWhatItWasMadeOf) {
  auto look = prepare_channel(*read(), 0, WitnessNames());
  ASSERT_TRUE(look) << look.error().message;
  look->prepared.fingerprint = 77;
  const auto back = channel_of(record_of(look->prepared));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->name, "gyro");
  EXPECT_EQ(back->replicates, look->prepared.replicates);
  EXPECT_EQ(back->replicates.size(), 4U) << "each was cut in two";
  EXPECT_EQ(back->notes, look->prepared.notes);
  EXPECT_TRUE(back->changed);
  EXPECT_EQ(back->fingerprint, 77U);
  EXPECT_EQ(back->subject->parts[1].first, look->prepared.subject->parts[1].first);
  EXPECT_EQ(back->subject->quantity, Quantity::kAngularRate);
  EXPECT_TRUE((back->moments[3].upper == look->prepared.moments[3].upper).all());
  const Witness& heat = look->prepared.subject->witnesses.at(0);
  const auto witness = witness_of(record_of(heat, kRate));
  ASSERT_TRUE(witness);
  EXPECT_EQ(witness->quantity, Quantity::kTemperature);
  EXPECT_EQ(witness->samples[2], heat.samples[2]);
  EXPECT_EQ(witness->cosines[2], heat.cosines[2]);
}

}  // namespace
}  // namespace imunoise::study
