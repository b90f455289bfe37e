#include <gtest/gtest.h>

#include "tests/layering/folder_rules.h"

namespace imunoise::testing {
namespace {

std::string lines(const std::vector<std::string>& found) {
  std::string out;
  for (const std::string& line : found) out += "\n  " + line;
  return out;
}

const Tree& house() {
  static const Tree kHouse = read_tree(IMUNOISE_SOURCE_DIR);
  return kHouse;
}

// What the rules say about one file with this text, in a tree that holds a header of every kind of
// room.
std::vector<std::string> violations(const std::string& path, const std::string& text) {
  Tree tree;
  for (const char* const header :
       {"core/support/result.h", "core/signal/signal.h", "core/wavelet/scales.h",
        "core/process/ar1.h", "core/model/model.h", "core/estimate/problem.h",
        "core/diagnosis/diagnose.h", "core/effects/known_effects.h", "core/simulate/steps.h",
        "recording/import/text/fields.h", "recording/store/chunk/chunk.h",
        "recording/store/recovery/recover.h", "recording/store/stream/stream.h", "study/study.h",
        "drivers/driver.h", "daemon/app/options.h", "tests/support/golden.h", "cli/options.h"}) {
    tree[header] = "#pragma once\n";
  }
  tree["core/model/model.h"] = "#pragma once\n#include \"core/process/ar1.h\"\n";
  tree["tests/hidden_effects/bench.h"] = "#pragma once\n";
  tree[path] = text;
  return layering_violations(tree);
}

std::vector<std::string> include_violations(const std::string& path, const std::string& header) {
  return violations(path,
                    "#include " + (header.front() == '<' ? header : '"' + header + '"') + "\n");
}

TEST(Layering, HoldsInEveryFile) {
  ASSERT_GT(house().size(), 50U) << "the sources were not found under " IMUNOISE_SOURCE_DIR;
  const std::vector<std::string> found = layering_violations(house());
  EXPECT_TRUE(found.empty()) << found.size() << " violations:" << lines(found);
}

TEST(Layering, EveryHeaderHasPragmaOnce) {
  const std::vector<std::string> found = unguarded_headers(house());
  EXPECT_TRUE(found.empty()) << "no #pragma once in:" << lines(found);
}

TEST(Layering, NoFileIsLong) {
  const std::vector<std::string> found = long_files(house());
  EXPECT_TRUE(found.empty()) << "longer than 400 lines:" << lines(found);
}

TEST(Layering, NoFolderIsCrowded) {
  const std::vector<std::string> found = crowded_folders(house());
  EXPECT_TRUE(found.empty()) << "more than 25 sources; give them inner folders:" << lines(found);
}

TEST(Layering, EveryFolderHasAMap) {
  const std::vector<std::string> found =
      folders_without_map(house(), read_maps(IMUNOISE_SOURCE_DIR));
  EXPECT_TRUE(found.empty()) << "no README.md, a few lines that say what is inside:"
                             << lines(found);
}

TEST(Layering, TheArchitectureNamesWhatIsThere) {
  const std::vector<std::string> found =
      missing_places(read_text(IMUNOISE_SOURCE_DIR "/docs/architecture.md"), IMUNOISE_SOURCE_DIR);
  EXPECT_TRUE(found.empty()) << "docs/architecture.md names what is not there:" << lines(found);
}

// The rules themselves: a rule that finds nothing in bad code is no rule.

struct Case {
  const char* path;
  const char* header;
};

TEST(LayeringRules, RefuseAForbiddenInclude) {
  for (const Case& bad : std::vector<Case>{
           {"core/support/units.cpp", "core/signal/signal.h"},
           {"core/signal/gap.h", "core/wavelet/scales.h"},
           {"core/wavelet/scales.cpp", "core/process/ar1.h"},
           {"core/process/ar1.cpp", "core/model/model.h"},
           {"core/estimate/problem.cpp", "core/diagnosis/diagnose.h"},
           {"core/regression/joint_fit.cpp", "core/effects/known_effects.h"},
           {"core/estimate/problem.cpp", "core/simulate/steps.h"},
           {"core/estimate/problem.cpp", "recording/store/chunk/chunk.h"},
           {"core/model/model.cpp", "imunoise/v1/noise.pb.h"},
           {"core/support/units.cpp", "<iostream>"},
           {"core/support/units.cpp", "<fstream>"},
           {"core/support/units.cpp", "<filesystem>"},
           {"core/support/units.cpp", "<cstdio>"},
           {"core/support/units.cpp", "<spdlog/spdlog.h>"},
           {"core/support/units.cpp", "<google/protobuf/message.h>"},
           {"core/support/units.cpp", "<Eigen/Dense>"},
           {"core/estimate/problem.cpp", "<Eigen/Cholesky>"},
           {"study/study.cpp", "<Eigen/SVD>"},
           {"core/wavelet/scales.cpp", "<boost/math/distributions/normal.hpp>"},
           {"core/wavelet/scales.cpp", "<tbb/parallel_for.h>"},
           {"core/model/model.cpp", "<nlopt.h>"},
           {"study/study.cpp", "<hdf5.h>"},
           {"study/study.cpp", "<CLI/CLI.hpp>"},
           {"study/study.cpp", "drivers/driver.h"},
           {"study/study.cpp", "cli/options.h"},
           {"recording/store/chunk/chunk.cpp", "study/study.h"},
           {"recording/store/chunk/chunk.cpp", "<spdlog/spdlog.h>"},
           {"recording/store/manifest/manifest.cpp", "recording/store/recovery/recover.h"},
           {"recording/import/table/file.cpp", "recording/import/text/fields.h"},
           {"drivers/adis/device.cpp", "core/wavelet/scales.h"},
           {"drivers/adis/device.cpp", "recording/store/chunk/chunk.h"},
           {"drivers/adis/device.cpp", "<libusb.h>"},
           {"drivers/xsens/codec/frame.cpp", "drivers/driver.h"},
           {"drivers/emulator/usb/hub.cpp", "core/model/model.h"},
           {"daemon/service/api/routes.cpp", "cli/options.h"},
           {"daemon/service/http/http_server.cpp", "recording/chunk.h"},
           {"daemon/acquire/recorder.cpp", "daemon/app/options.h"},
           {"tests/hidden_effects/trial.cpp", "core/process/ar1.h"},
           {"tests/hidden_effects/trial.cpp", "core/effect/effect.h"},
           {"tests/hidden_effects/trial.cpp", "core/diagnosis/diagnose.h"},
           {"tests/hidden_effects/generator/walk.cpp", "core/model/model.h"},
           {"core/wavelet/scales.cpp", "scales.h"},
           {"core/wavelet/scales.cpp", "core/wavelet/absent.h"},
           {"attic/old.cpp", "<vector>"},
       }) {
    EXPECT_FALSE(include_violations(bad.path, bad.header).empty())
        << bad.path << " includes " << bad.header;
  }
}

TEST(LayeringRules, AcceptWhatTheTableAllows) {
  for (const Case& good : std::vector<Case>{
           {"core/support/linear_algebra.cpp", "<Eigen/Cholesky>"},
           {"core/support/distributions.cpp", "<boost/math/distributions/normal.hpp>"},
           {"core/support/random.h", "<boost/random/normal_distribution.hpp>"},
           {"core/support/units.cpp", "core/support/result.h"},
           {"core/process/ar1.cpp", "core/wavelet/scales.h"},
           {"core/estimate/minimise.cpp", "<nlopt.h>"},
           {"core/simulate/steps.cpp", "core/model/model.h"},
           {"recording/store/timeline/gaps.cpp", "recording/store/stream/stream.h"},
           {"recording/store/chunk/chunk.cpp", "<hdf5.h>"},
           {"recording/store/manifest/manifest.cpp", "imunoise/v1/noise.pb.h"},
           {"study/report/html/fit_page.cpp", "imunoise/v1/noise.pb.h"},
           {"study/study.cpp", "recording/store/chunk/chunk.h"},
           {"drivers/adis/device.cpp", "core/signal/signal.h"},
           {"drivers/transport/libusb_device.cpp", "<libusb.h>"},
           {"drivers/replay/samples.cpp", "recording/store/chunk/chunk.h"},
           {"drivers/emulator/effects/noise.cpp", "core/model/model.h"},
           {"daemon/service/studies/study_methods.cpp", "study/study.h"},
           {"daemon/app/main.cpp", "<spdlog/spdlog.h>"},
           {"cli/main.cpp", "<CLI/CLI.hpp>"},
           {"cli/main.cpp", "daemon/app/options.h"},
           {"tests/core/model/model_test.cpp", "core/model/model.h"},
           {"tests/hidden_effects/generator/walk.cpp", "core/support/result.h"},
           {"tests/hidden_effects/trial.cpp", "study/study.h"},
           {"bench/wavelet_bench.cpp", "core/wavelet/scales.h"},
       }) {
    EXPECT_EQ(lines(include_violations(good.path, good.header)), "")
        << good.path << " " << good.header;
  }
}

TEST(LayeringRules, NameTheFileTheLineAndTheWayOut) {
  const auto found =
      violations("core/wavelet/scales.cpp", "\n// why\n#include \"core/process/ar1.h\"\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front(),
            "core/wavelet/scales.cpp:3: includes core/process/ar1.h; core/wavelet may include "
            "core/support, core/signal");
}

TEST(LayeringRules, FollowTheGeneratorsIncludesThroughOtherHeaders) {
  Tree tree;
  tree["core/support/result.h"] = "#pragma once\n#include \"core/process/ar1.h\"\n";
  tree["core/process/ar1.h"] = "#pragma once\n";
  tree["tests/hidden_effects/generator/walk.cpp"] = "#include \"core/support/result.h\"\n";
  const std::string found = lines(layering_violations(tree));
  EXPECT_NE(found.find("walk.cpp: reaches core/process/ar1.h through core/support/result.h"),
            std::string::npos)
      << found;
  tree["core/support/result.h"] = "#pragma once\n#include \"core/model/model.h\"\n";
  tree["core/model/model.h"] = "#pragma once\n";
  EXPECT_NE(lines(layering_violations(tree)).find("walk.cpp: reaches core/model/model.h"),
            std::string::npos);
}

TEST(LayeringRules, ReadCodeNotCommentsOrLiterals) {
  const char* const kCore = "core/support/units.cpp";
  EXPECT_FALSE(violations(kCore, "void f() { std::printf(\"x\"); }\n").empty());
  EXPECT_FALSE(violations(kCore, "void f() { std::cout << 1; }\n").empty());
  EXPECT_FALSE(violations(kCore, "auto t = std::chrono::steady_clock::now();\n").empty());
  EXPECT_FALSE(violations("recording/hdf5/a.cpp", "std::random_device seed;\n").empty());
  EXPECT_FALSE(
      violations(kCore, "const int n = 1'000'000; int c = '\"'; void g() { puts(a); }\n").empty());
  EXPECT_FALSE(violations(kCore, "#include /* now */ <iostream>  // why\n").empty());
  EXPECT_EQ(lines(violations(kCore, "// printf(\"x\") and #include <iostream>\n")), "");
  EXPECT_EQ(lines(violations(kCore, "/* std::cout\n #include <iostream>\n */\n")), "");
  EXPECT_EQ(lines(violations(kCore, "auto s = \"printf( \\\" std::cout\"; char c = '\"';\n")), "");
  EXPECT_EQ(lines(violations(kCore, "auto s = R\"x(\n#include <iostream>\n\" puts(1) )x\";\n")),
            "");
}

TEST(LayeringRules, FindHeadersWithoutGuardAndLongFiles) {
  const Tree tree = {{"core/a.h", "#pragma once\nint a;\n"},
                     {"core/b.h", "// about\n\n#pragma once\n"},
                     {"core/c.h", "// #pragma once\nint c;\n"},
                     {"core/d.cpp", std::string(401, '\n')},
                     {"core/e.cpp", std::string(400, '\n')}};
  EXPECT_EQ(unguarded_headers(tree), std::vector<std::string>{"core/c.h"});
  EXPECT_EQ(long_files(tree), std::vector<std::string>{"core/d.cpp: 401 lines"});
}

TEST(LayeringRules, CountAHeaderWithItsSource) {
  Tree tree;
  for (int i = 0; i < 25; ++i) {
    tree["core/a/f" + std::to_string(i) + ".h"] = tree["core/a/f" + std::to_string(i) + ".cpp"] =
        "";
    tree["core/b/f" + std::to_string(i) + ".h"] = "";
  }
  tree["core/b/c/deeper.h"] = "";
  EXPECT_TRUE(crowded_folders(tree).empty());
  tree["core/b/one_more.cpp"] = "";
  EXPECT_EQ(crowded_folders(tree), std::vector<std::string>{"core/b: 26 sources"});
}

TEST(LayeringRules, AskForTheMapOfEveryFolderButMirrors) {
  const Tree tree = {{"core/a/x.h", ""},
                     {"core/b/x.h", ""},
                     {"tests/core/a/x_test.cpp", ""},
                     {"tests/fuzz/x.cpp", ""}};
  EXPECT_EQ(folders_without_map(tree, {"core/a/README.md", "core/README.md"}),
            (std::vector<std::string>{"core/b", "tests/fuzz"}));
}

TEST(LayeringRules, FindPlacesThatADocumentNamesInVain) {
  const std::string text =
      "`core/support/units.cpp`, `core/attic/`, `core/process/NAME.h`, `a word`, `cli`,\n"
      "`tests/layering/README.md`, `drivers/*/codec`, `core/no_such.h`";
  EXPECT_EQ(missing_places(text, IMUNOISE_SOURCE_DIR),
            (std::vector<std::string>{"core/attic/", "core/no_such.h"}));
}

TEST(LayeringRules, TheLongestPathNamesTheRoom) {
  EXPECT_EQ(room_of("drivers/replay/samples.cpp"), "drivers/replay");
  EXPECT_EQ(room_of("drivers/replayer/samples.cpp"), "drivers");
  EXPECT_EQ(room_of("imunoise/v1/noise.pb.h"), "proto");
  EXPECT_EQ(room_of("attic/old.cpp"), "");
}

}  // namespace
}  // namespace imunoise::testing
