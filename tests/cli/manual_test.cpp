// Help, manual pages and completion: three prints of one tree, held to one form.

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "daemon/config/campaign_keys.h"
#include "tests/cli/program.h"

namespace imunoise::testing {
namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const std::string& text) {
  Lines out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

class Manual : public Program {
 protected:
  Manual() {
    EXPECT_EQ(run("--write-manual manual").status, 0);
    EXPECT_EQ(shell(IMUNOISED " --write-manual manual"), "");
  }

  // Every command, "batch new" included: those whose pages were written.
  std::vector<std::string> commands() const {
    std::vector<std::string> out;
    for (const auto& file : std::filesystem::directory_iterator(folder_ / "manual/man/man1")) {
      std::string name = file.path().stem().string();
      name = name == "imunoise" ? "" : name.substr(std::string("imunoise-").size());
      out.push_back(std::regex_replace(name, std::regex("^(study|batch)-"), "$1 "));
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  std::string shell(const std::string& command) const {
    const std::string whole = "cd '" + folder_.string() + "' && " + command + " 2>&1";
    std::FILE* const pipe = popen(whole.c_str(), "r");
    std::string out;
    for (int c = 0; (c = std::fgetc(pipe)) != EOF;) out += static_cast<char>(c);
    pclose(pipe);
    return out;
  }

  // What bash offers for the last of the words, with the completions of both programs loaded.
  std::set<std::string> offered(const std::string& words,
                                const std::string& program = "imunoise") const {
    const std::string folder = ". manual/bash-completion/completions/";
    const std::string out =
        shell("bash -c '" + folder + "imunoise; " + folder + "imunoised; COMP_WORDS=(" + words +
              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); $(complete -p " + program +
              " | grep -o \"_imunoise[a-z]*\"); printf \"%s\\n\" \"${COMPREPLY[@]}\"'");
    const Lines all = lines_of(out);
    return {all.begin(), all.end()};
  }
};

// The entries of one section of --help: first line's left column, then all of the text.
struct Entry {
  std::string name;
  std::string about;
};

std::vector<Entry> section(const std::string& help, const std::string& title) {
  std::vector<Entry> out;
  bool inside = false;
  for (const std::string& line : lines_of(help)) {
    if (line == title + ":") {
      inside = true;
    } else if (inside && line.empty()) {
      break;
    } else if (inside && line.substr(0, 4).find_first_not_of(' ') == 2) {
      const std::size_t end = std::min(line.find("  ", 2), line.size());
      out.push_back({line.substr(2, end - 2), line.substr(end)});
    } else if (inside) {
      out.back().about += " " + line;
    }
  }
  for (Entry& one : out) {
    one.about = std::regex_replace(one.about, std::regex(" +"), " ").substr(1);
  }
  return out;
}

// Help texts are raw strings, which the check of messages (tests/layering) leaves out.
bool has_riddles(const std::string& help) {
  static const std::regex kRiddles(
      R"(\b(whoever|nobody|somebody|shall|lest|(is|are) told|see below)\b)", std::regex::icase);
  return std::regex_search(help, kRiddles);
}

TEST_F(Manual, EveryCommandHasAPageAndHelpWithAnExample) {
  const std::vector<std::string> all = commands();
  EXPECT_GT(all.size(), 35U);
  for (const std::string& command : all) {
    const std::string help = run(command + " --help").out;
    EXPECT_NE(help.find("\nExamples:\n  imunoise " + command), std::string::npos) << help;
    EXPECT_FALSE(has_riddles(help)) << help;
  }
  const std::string help = run("--help").out;
  for (const char* group : {"Analyse recordings", "Record, replay and simulate",
                            "Manage many recordings", "Control imunoised"}) {
    const std::vector<Entry> listed = section(help, group);
    EXPECT_GE(listed.size(), 4U) << group;
    for (const Entry& one : listed) {
      EXPECT_TRUE(std::find(all.begin(), all.end(), one.name) != all.end()) << one.name;
    }
  }
}

// A noun phrase (or what a flag does) of one sentence, a named value, facts in brackets.
TEST_F(Manual, EveryOptionHasTheSameForm) {
  static const std::regex kForm(R"(([A-Z]|[a-z0-9]+: )[^.]*?(\.(\.\.|\S)[^.]*)*( \[.*\])?)");
  static const std::regex kValue(R"((-h, --help|--\S+)( ([A-Z]+|OUT\.\w+|\S+\|\S+))?)");
  for (const std::string& command : commands()) {
    const std::string help = run(command + " --help").out;
    std::vector<Entry> all = section(help, "Options");
    ASSERT_FALSE(all.empty()) << command;
    for (const Entry& one : all) {
      EXPECT_TRUE(std::regex_match(one.name, kValue))
          << command << ": " << one.name << ": name the value in capitals with type_name()";
      for (const char* type : {" TEXT", " INT", " UINT", " FLOAT"}) {
        EXPECT_FALSE(one.name.ends_with(type))
            << command << ": " << one.name << ": say which value it is with type_name()";
      }
    }
    for (const char* title : {"Arguments", "Commands"}) {
      for (const Entry& one : section(help, title)) all.push_back(one);
    }
    for (const Entry& one : all) {
      EXPECT_TRUE(std::regex_match(one.about, kForm))
          << command << " " << one.name << ": '" << one.about << "'";
      const std::string about = one.about.substr(0, one.about.find(" ["));
      EXPECT_LE(std::count(about.begin(), about.end(), ' '), 27)
          << command << " " << one.name << ": at most 28 words: '" << about << "'";
      EXPECT_EQ(about.find("(default"), std::string::npos) << "use default_str(): " << about;
    }
  }
}

TEST_F(Manual, PagesHaveNoWarnings) {
  if (shell("command -v man").empty()) GTEST_SKIP() << "man is not installed";
  const std::string warnings =
      shell("LC_ALL=C.UTF-8 MANROFFSEQ= man --warnings -E UTF-8 -l -P cat manual/man/man*/* >text");
  EXPECT_EQ(warnings, "");
  const std::string text = std::regex_replace(read("text"), std::regex("[ \n]+"), " ");
  EXPECT_NE(text.find("imunoise-fit - Fit a noise model to replicates"), std::string::npos);
  EXPECT_NE(text.find("imunoised - record campaigns of inertial sensors"), std::string::npos);
  for (const config::CampaignKey& key : config::campaign_keys()) {
    const std::string entry = std::string(key.name) + " = " + std::string(key.value);
    EXPECT_NE(text.find(entry), std::string::npos) << entry;
  }
}

TEST_F(Manual, BashCompletesCommandsOptionsAndValues) {
  for (const std::string program : {"imunoise", "imunoised"})
    EXPECT_EQ(shell("bash -n manual/bash-completion/completions/" + program), "");
  using Words = std::set<std::string>;
  EXPECT_EQ(offered("imunoise fa"), Words({"faults"}));
  EXPECT_EQ(offered("imunoise --threads 2 batch s"), Words({"shard", "status"}));
  EXPECT_EQ(offered("imunoise fit --we"), Words({"--weights"}));
  EXPECT_EQ(offered("imunoise fit x.csv --weights \"\""), Words({"full", "diag"}));
  EXPECT_EQ(offered("imunoise decode --format \"\""), Words({"xbus", "candump", "adis16405"}));
  EXPECT_EQ(offered("imunoise batch run --engine s"), Words({"slurm"}));
  EXPECT_EQ(offered("imunoise fit --rate \"\""), Words({""}));
  EXPECT_EQ(offered("'" IMUNOISE_BINARY "' record x --device x"), Words({"xsens"}));
  EXPECT_EQ(offered("imunoised --che", "imunoised"), Words({"--check-config"}));
}

TEST_F(Manual, ZshParsesItsCompletion) {
  const std::string script = read("manual/zsh/vendor-completions/_imunoise");
  EXPECT_NE(script.find("_imunoise_batch_run() {"), std::string::npos);
  EXPECT_NE(script.find(":xbus|candump|adis16405:(xbus candump adis16405)'"), std::string::npos);
  if (shell("command -v zsh").empty()) GTEST_SKIP() << "zsh is not installed";
  for (const std::string program : {"imunoise", "imunoised"})
    EXPECT_EQ(shell("zsh -n manual/zsh/vendor-completions/_" + program), "");
}

// A real zsh, to which the words and the tabulator key are typed.
TEST_F(Manual, ZshCompletesCommandsOptionsAndValues) {
  if (shell("command -v zsh").empty())
    GTEST_SKIP() << "zsh is not installed, so its completion is NOT tested: apt install zsh";
  const auto completed = [&](const std::string& words) {
    return shell("timeout 20 zsh " IMUNOISE_ZSH_COMPLETES " " IMUNOISE_BINARY
                 " manual/zsh/vendor-completions '" +
                 words + "'");
  };
  EXPECT_EQ(completed("fau"), "<faults>\n");
  EXPECT_EQ(completed("--threads 2 batch sh"), "<--threads 2 batch shard>\n");
  EXPECT_EQ(completed("verify --rep"), "<verify --repair>\n");
  EXPECT_EQ(completed("decode --format xb"), "<decode --format xbus>\n");
  EXPECT_EQ(completed("record x --device xs"), "<record x --device xsens>\n");
  EXPECT_EQ(completed("frobnicate"), "<frobnicate>\n");
}

TEST_F(Manual, AFolderThatCannotBeWrittenIsAnError) {
  const Outcome outcome = run("--write-manual /proc/nowhere");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("cannot be written"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace imunoise::testing
