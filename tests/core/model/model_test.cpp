#include "core/model/model.h"

#include <gtest/gtest.h>

#include <random>

namespace imunoise {
namespace {

constexpr Hertz kRate{100};

TEST(Grammar, ReadsWhatPeopleWrite) {
  const Result<Model> model = parse_model("2*AR1 + wn(sigma2=1e-4)+RW + ma(3)", kRate);
  ASSERT_TRUE(model) << model.error().message;
  ASSERT_EQ(model->terms.size(), 5U);
  EXPECT_EQ(print(*model), "2*AR1 + WN(sigma2=0.0001) + RW + MA(3)");
  EXPECT_EQ(std::get<WhiteNoise>(model->terms[2].process).sigma2, 1e-4);
  EXPECT_TRUE(model->terms[2].given[0]);
  EXPECT_EQ(std::get<MovingAverage>(model->terms[4].process).theta.size(), 3U);
}

TEST(Grammar, PointsAtTheCharacter) {
  struct Case {
    const char* text;
    std::size_t column;
    const char* says;
  };
  for (const Case& c : std::vector<Case>{{"2*AR3 + WN", 2, "unknown process 'AR3'"},
                                         {"WN + ", 5, "expected the name"},
                                         {"", 0, "expected the name"},
                                         {"WN WN", 3, "expected '+'"},
                                         {"WN(sigma=1)", 3, "no parameter 'sigma'"},
                                         {"WN(sigma2=x)", 10, "expected a number"},
                                         {"WN(sigma2=nan)", 10, "expected a number"},
                                         {"WN(sigma2=-1)", 10, "cannot be negative"},
                                         {"WN(sigma2=1e160)", 10, "between 1e-60 and 1e+60"},
                                         {"WN(sigma2=1e-200)", 10, "between 1e-60 and 1e+60"},
                                         {"AR1(phi=1.5)", 8, "between"},
                                         {"AR1(phi=0.5, phi=0.6)", 13, "given twice"},
                                         {"AR1(3)", 4, "takes no number"},
                                         {"MA(99)", 3, "out of range"},
                                         {"0*WN", 0, "counted from 1"},
                                         {"99*WN", 0, "at most"},
                                         {"2 WN", 2, "expected '*'"},
                                         {"99999999999*WN", 0, "whole number"},
                                         {"WN(sigma2=1", 11, "expected ',' or ')'"}}) {
    const Result<Model> model = parse_model(c.text, kRate);
    ASSERT_FALSE(model) << c.text;
    const std::string& message = model.error().message;
    EXPECT_NE(message.find(c.says), std::string::npos) << message;
    EXPECT_EQ(message.size() - message.rfind('\n') - 1, c.column + 3)
        << message;  // two blanks and the caret
  }
}

TEST(Grammar, SensorsShareProcessesInArraysOnly) {
  const auto model = parse_array_model("RW[corr] + ar1(phi=0.5)[ all ]+WN", Hertz{100.0});
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->terms[0].sharing, Sharing::kCorrelated);
  EXPECT_EQ(model->terms[1].sharing, Sharing::kAll);
  EXPECT_EQ(model->terms[2].sharing, Sharing::kOwn);
  EXPECT_EQ(print(*model), "RW[corr] + AR1(phi=0.5)[all] + WN");
  EXPECT_EQ(parse_array_model(print(*model), Hertz{100.0}).value(), *model);
  EXPECT_EQ(parse_model("RW[corr]", Hertz{1.0}).error().message,
            "model: processes are shared only among the sensors of an array\n  RW[corr]\n     ^");
  for (const char* wrong : {"RW[]", "RW[corr", "RW[mine]", "RW(gamma2=1)[corr]", "RW[corr][all]"}) {
    EXPECT_FALSE(parse_array_model(wrong, Hertz{1.0})) << wrong;
  }
}

TEST(Grammar, PrintsBackWhatItParsed) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(0.06, 0.95);
  for (int round = 0; round < 300; ++round) {
    Model model;
    const std::size_t size = 1 + engine() % 5;
    for (std::size_t i = 0; i < size; ++i) {
      Process process = known_processes()[engine() % known_processes().size()];
      if (structure(process) > 0)
        process = *with_structure(process, 2 + static_cast<int>(engine() % 5));
      if (auto* markov = std::get_if<GaussMarkov>(&process)) markov->rate = kRate;
      Term term(process);
      std::vector<double> v = values(process);
      for (std::size_t k = 0; k < v.size(); ++k) {
        if (engine() % 2 == 0) continue;
        v[k] = uniform(engine);
        term.given[k] = true;
      }
      set_values(term.process, v);
      model.terms.push_back(term);
    }
    const Result<Model> again = parse_model(print(model), kRate);
    ASSERT_TRUE(again) << print(model) << "\n" << again.error().message;
    EXPECT_EQ(*again, model) << print(model);
  }
}

TEST(Model, AddsUpItsTerms) {
  const Model model = *parse_model("WN(sigma2=2) + AR1(sigma2=1,phi=0.9) + RW(gamma2=0.1)", kRate);
  const Eigen::Array3d m(1, 5, 100);
  const Eigen::ArrayXd expected = variance(Process(WhiteNoise{2}), m) +
                                  variance(Process(Ar1{1, 0.9}), m) +
                                  variance(Process(RandomWalk{0.1}), m);
  EXPECT_TRUE(variance(model, m).isApprox(expected, 1e-15));
  EXPECT_EQ(jacobian(model, m).cols(), 4);
  EXPECT_TRUE(complete(model));
}

TEST(Model, SimulatesEachTermFromAStreamOfItsOwn) {
  const Model both = *parse_model("WN(sigma2=1) + RW(gamma2=1)", kRate);
  const Model white = *parse_model("WN(sigma2=1)", kRate);
  EXPECT_EQ(simulate(both, 100, 3, 0), simulate(both, 100, 3, 0));
  EXPECT_NE(simulate(both, 100, 3, 0), simulate(both, 100, 3, 1));
  EXPECT_NE(simulate(both, 100, 3, 0), simulate(both, 100, 4, 0));
  EXPECT_NE(simulate(both, 100, 3, 0), simulate(white, 100, 3, 0));
}

TEST(Model, SortsEqualProcessesByCorrelationTime) {
  const Model model =
      *parse_model("AR1(sigma2=1,phi=0.1)+WN(sigma2=1)+AR1(sigma2=2,phi=0.9)", kRate);
  EXPECT_EQ(std::get<Ar1>(sorted(model).terms[0].process).phi, 0.9);
  EXPECT_EQ(std::get<Ar1>(sorted(model).terms[2].process).phi, 0.1);
}

}  // namespace
}  // namespace imunoise
