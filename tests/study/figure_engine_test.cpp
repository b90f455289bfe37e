// The two engines on figures of every shape, with numbers and names that give them trouble.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "study/figure/characters.h"
#include "study/figure/layout.h"
#include "study/figure/svg.h"
#include "study/words/text.h"
#include "tests/study/figure_geometry.h"

namespace imunoise::report {
namespace {

using figure::AxisKind;
using figure::characters;
using figure::Datum;
using figure::Figure;
using figure::kUnknown;
using figure::Layer;
using figure::Panel;
using figure::Role;
using figure::Shape;
using figure::State;
using figure::SvgVariant;

std::string page_picture(const Figure& figure, double width = 920.0) {
  return svg(figure, {SvgVariant::kInline, width});
}

Layer layer_of(Shape shape, Role role, std::vector<Datum> data) {
  return {.shape = shape, .role = role, .data = std::move(data)};
}

Figure one_panel(Layer layer, AxisKind x = AxisKind::kLinear, AxisKind y = AxisKind::kLinear) {
  return {.title = "t",
          .panels = {{.x = {.kind = x}, .y = {.kind = y}, .layers = {std::move(layer)}}}};
}

std::vector<const Element*> of_class(const Markup& markup, const std::string& css_class) {
  std::vector<const Element*> out;
  for (const Element& element : markup.elements) {
    const auto found = element.attributes.find("class");
    if (found != element.attributes.end() && found->second == css_class) out.push_back(&element);
  }
  return out;
}

// Every shape there is, on every kind of axis that it can stand on.
std::vector<Figure> every_shape() {
  const std::vector<Datum> places = {
      {.x = 1.0, .y = 3.0, .lower = 2.0, .upper = 5.0, .sigma = 1.0, .words = "first"},
      {.x = 20.0,
       .y = 0.5,
       .lower = 0.1,
       .upper = kUnknown,
       .state = State::kOutside,
       .sigma = -9.0},
      {.x = 300.0, .y = 80.0, .lower = 1.0, .upper = 1e9, .state = State::kUntested},
      {.x = kUnknown, .y = INFINITY, .lower = -INFINITY, .upper = 0.0, .sigma = 1e300}};
  std::vector<Figure> out;
  for (const Shape shape :
       {Shape::kLine, Shape::kPoints, Shape::kBand, Shape::kIntervals, Shape::kBars, Shape::kMarks,
        Shape::kCells, Shape::kColumns, Shape::kRows}) {
    for (const Role role : {Role::kMeasured, Role::kTerm, Role::kChance, Role::kUntested}) {
      for (const AxisKind x : {AxisKind::kLinear, AxisKind::kLogarithmic, AxisKind::kTime,
                               AxisKind::kDuration, AxisKind::kSigma, AxisKind::kCategories}) {
        Figure one = one_panel(layer_of(shape, role, places), x, AxisKind::kLogarithmic);
        one.panels[0].x.categories = {"a", "b"};
        one.panels[0].layers[0].key = "key";
        out.push_back(one);
        one.panels[0].y = {.kind = AxisKind::kCategories, .categories = {"r", "s", "t", "u"}};
        out.push_back(std::move(one));
      }
    }
  }
  return out;
}

std::vector<Figure> hard_cases() {
  const auto point = [](double x, double y) {
    return Datum{.x = x, .y = y, .lower = y, .upper = y};
  };
  const Layer single = layer_of(Shape::kPoints, Role::kMeasured, {point(5.0, 7.0)});
  const Layer constant = layer_of(Shape::kLine, Role::kModel,
                                  {point(1.0, 1e-14), point(2.0, 1e-14), point(3.0, 1e-14)});
  std::vector<Figure> out;
  for (const AxisKind kind : {AxisKind::kLinear, AxisKind::kLogarithmic}) {
    out.push_back(one_panel(single, kind, kind));
    out.push_back(one_panel(constant, kind, kind));
    out.push_back(one_panel({}, kind, kind));
  }
  Figure many{.title = std::string(200, 'W'), .subtitle = std::string(300, 'W')};
  for (int k = 0; k < 64; ++k) {
    Layer line{.role = Role::kTerm,
               .name = "series with a name of eighty characters, no less, counted one by one, " +
                       std::to_string(k),
               .style = static_cast<std::size_t>(k),
               .labelled = true,
               .key = "series " + std::to_string(k)};
    for (int i = 1; i < 9; ++i) line.data.push_back(point(std::exp2(i), std::exp2(0.1 * k) * i));
    if (k == 0)
      many.panels.push_back(
          {.x = {.kind = AxisKind::kLogarithmic, .title = std::string(150, 'W')},
           .y = {.kind = AxisKind::kLogarithmic, .title = std::string(150, 'W')}});
    many.panels[0].layers.push_back(std::move(line));
  }
  out.push_back(std::move(many));
  Panel rows{.y = {.kind = AxisKind::kCategories}, .layers = {{.shape = Shape::kCells}}};
  for (int r = 0; r < 200; ++r) {
    rows.y.categories.push_back("replicate " + std::to_string(r) + std::string(80, 'x'));
    for (int c = 0; c < 16; ++c)
      rows.layers[0].data.push_back({.x = c + 0.5,
                                     .y = 1.0 * r,
                                     .lower = 1.0 * c,
                                     .upper = c + 1.0,
                                     .sigma = 0.5 * c,
                                     .words = "+3.1"});
  }
  out.push_back({.title = "rows", .panels = {std::move(rows)}});
  Figure late = one_panel(single, AxisKind::kTime);
  late.panels[0].layers[0].data = {point(1e9, 1.0), point(2e9, 2.0), point(1e18, 3.0)};
  out.push_back(std::move(late));
  Layer crowd{.shape = Shape::kMarks};
  for (int k = 0; k < 40; ++k)
    crowd.data.push_back({.x = 1.0 + 0.01 * k, .words = "13.7 Hz (chance)"});
  out.push_back(one_panel(single));
  out.back().panels[0].layers.push_back(std::move(crowd));
  return out;
}

TEST(FigureEngine, EveryShapeIsSoundOnEveryAxis) {
  for (const Figure& one : every_shape()) {
    expect_sound(page_picture(one), "shape");
    for (const bool unicode : {true, false}) {
      std::istringstream lines(characters(one, {60, false, unicode}));
      for (std::string line; std::getline(lines, line);)
        EXPECT_LE(display_width(line), 60U) << line;
    }
  }
}

TEST(FigureEngine, HardCasesKeepTheirTextsApart) {
  for (const Figure& one : hard_cases()) {
    for (const double width : {920.0, 388.0, 250.0, 1.0}) {
      expect_sound(page_picture(one, width), one.title);
      expect_texts_apart(page_picture(one, width), one.title);
    }
    expect_sound(svg(one), one.title);
    EXPECT_EQ(characters(one, {80, false, false}).find("\xe2"), std::string::npos) << "ASCII";
  }
}

TEST(FigureEngine, NothingInASvgIsForbiddenByAStrictPolicy) {
  for (const std::vector<Figure>& all : {every_shape(), hard_cases()}) {
    for (const Figure& one : all) {
      for (const Element& element : read_markup(page_picture(one)).elements) {
        EXPECT_FALSE(element.attributes.contains("style"));
        EXPECT_FALSE(element.attributes.contains("id"));
        EXPECT_NE(element.name, "script");
        EXPECT_NE(element.name, "style");
      }
    }
  }
}

TEST(FigureEngine, ManyLinesAreNamedInTheKeyAlone) {
  Figure lines = one_panel({});
  lines.panels[0].layers.clear();
  const auto labels = [&](int wanted) {
    while (static_cast<int>(lines.panels[0].layers.size()) < wanted) {
      const double y = static_cast<double>(lines.panels[0].layers.size());
      lines.panels[0].layers.push_back(
          {.role = Role::kTerm,
           .name = "term " + std::to_string(lines.panels[0].layers.size()),
           .labelled = true,
           .data = {{.x = 0.0, .y = y}, {.x = 1.0, .y = y}}});
    }
    return of_class(read_markup(page_picture(lines)), "label term-0").size();
  };
  EXPECT_EQ(labels(12), 12U);
  EXPECT_EQ(labels(13), 0U) << "they would cover what they name";
}

TEST(FigureEngine, APlaceCarriesItsNumbers) {
  Figure one =
      one_panel(layer_of(Shape::kPoints, Role::kMeasured, {{.x = 0.5, .y = -2e-9, .sigma = 3.25}}));
  one.panels[0].layers[0].name = "AR1 <2>";
  const Markup markup = read_markup(page_picture(one));
  const auto points = of_class(markup, "measured");
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(value(*points[0], "data-x"), 0.5);
  EXPECT_EQ(value(*points[0], "data-y"), -2e-9);
  EXPECT_EQ(value(*points[0], "data-sigma"), 3.25);
  EXPECT_EQ(of_class(markup, "layer").at(0)->attributes.at("data-term"), "AR1 &lt;2&gt;");
}

TEST(FigureEngine, AGhostIsASecondLineBesideTheModel) {
  Figure one =
      one_panel(layer_of(Shape::kLine, Role::kModel, {{.x = 0.0, .y = 1.0}, {.x = 1.0, .y = 2.0}}));
  one.panels[0].layers.push_back(
      layer_of(Shape::kLine, Role::kGhost, {{.x = 0.0, .y = 1.5}, {.x = 1.0, .y = 1.0}}));
  const std::string picture = page_picture(one);
  EXPECT_EQ(of_class(read_markup(picture), "ghost").size(), 1U);
  EXPECT_EQ(of_class(read_markup(picture), "model").size(), 1U);
  const std::string alone = characters({.panels = {one.panels[0]}}, {60, false, true});
  one.panels[0].layers.pop_back();
  EXPECT_NE(alone, characters(one, {60, false, true}));
}

TEST(FigureEngine, BarsRunFromZero) {
  Figure one = one_panel(
      layer_of(Shape::kBars, Role::kMeasured, {{.x = 0.0, .y = 4.0}, {.x = 1.0, .y = -2.0}}),
      AxisKind::kCategories);
  one.panels[0].x.categories = {"a", "b"};
  const Markup markup = read_markup(page_picture(one));
  const auto bars = of_class(markup, "bar");
  ASSERT_EQ(bars.size(), 2U);
  EXPECT_NEAR(value(*bars[0], "height") / value(*bars[1], "height"), 2.0, 0.01);
  EXPECT_NEAR(value(*bars[0], "y") + value(*bars[0], "height"), value(*bars[1], "y"), 0.02);
  const Figure lying{
      .panels = {{.y = {.kind = AxisKind::kCategories, .categories = {"a", "b"}},
                  .layers = {layer_of(Shape::kBars, Role::kMeasured,
                                      {{.x = 4.0, .y = 0.0}, {.x = 2.0, .y = 1.0}})}}}};
  const Markup rows = read_markup(page_picture(lying));
  const auto longer = of_class(rows, "bar");
  ASSERT_EQ(longer.size(), 2U);
  EXPECT_NEAR(value(*longer[0], "width") / value(*longer[1], "width"), 2.0, 0.01);
}

TEST(FigureEngine, LinesEndAtThePanelsEdge) {
  const Box box{0.0, 0.0, 10.0, 10.0};
  const auto parts =
      figure::clipped({{-5.0, 5.0}, {5.0, 5.0}, {5.0, 25.0}, {8.0, 25.0}, {8.0, 5.0}}, box);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].front().x, 0.0);
  EXPECT_EQ(parts[0].back().y, 10.0);
  EXPECT_EQ(parts[1].front().y, 10.0);
  EXPECT_EQ(parts[1].back().y, 5.0);
}

TEST(FigureEngine, PanelsThatShareAnAxisStandBelowEachOther) {
  Figure one{.panels = {{.x = {.kind = AxisKind::kLogarithmic, .title = "time, s"},
                         .layers = {layer_of(Shape::kLine, Role::kModel,
                                             {{.x = 1.0, .y = 1.0}, {.x = 100.0, .y = 2.0}})}},
                        {.shares_x = true,
                         .layers = {layer_of(Shape::kPoints, Role::kMeasured,
                                             {{.x = 1000.0, .y = 5.0}})}}}};
  const figure::Layout layout = figure::layout(one, {920.0, 0.0, false});
  ASSERT_EQ(layout.panels.size(), 2U);
  EXPECT_EQ(layout.panels[0].frame.left, layout.panels[1].frame.left);
  EXPECT_EQ(layout.panels[0].frame.right, layout.panels[1].frame.right);
  EXPECT_GT(layout.panels[1].frame.top, layout.panels[0].frame.bottom);
  EXPECT_TRUE(layout.panels[0].x.holds(1000.0)) << "room for the layers of both";
  EXPECT_FALSE(layout.panels[0].names_x);
  const auto titles = of_class(read_markup(page_picture(one)), "axis-title");
  EXPECT_EQ(titles.size(), 1U);
}

TEST(FigureEngine, APictureIsAsHighAsIsAskedFor) {
  const Figure one = one_panel(layer_of(Shape::kPoints, Role::kMeasured, {{.x = 1.0, .y = 1.0}}));
  for (const double height : {200.0, 300.0, 700.0})
    EXPECT_NEAR(figure::layout(one, {920.0, height, false}).height, height, 1.0);
}

TEST(FigureEngine, ATerminalShowsRowsOfIntervalsAndCells) {
  const Figure intervals{
      .panels = {{.x = {.kind = AxisKind::kLogarithmic},
                  .y = {.kind = AxisKind::kCategories, .categories = {"WN", "WN + RW"}},
                  .x_reference = 1.0,
                  .layers = {layer_of(
                      Shape::kIntervals, Role::kMeasured,
                      {{.x = 10.0, .y = 0.0, .lower = 5.0, .upper = 20.0, .state = State::kOutside},
                       {.x = 1.0, .y = 1.0}})}}}};
  const std::string rows = characters(intervals, {60, false, true});
  EXPECT_NE(rows.find("WN │"), std::string::npos) << rows;
  EXPECT_NE(rows.find("─●─"), std::string::npos) << rows;
  const Figure cells{
      .panels = {{.y = {.kind = AxisKind::kCategories, .categories = {"run1"}},
                  .layers = {layer_of(Shape::kCells, Role::kMeasured,
                                      {{.y = 0.0, .lower = 0.0, .upper = 1.0, .sigma = 4.2},
                                       {.y = 0.0, .lower = 1.0, .upper = 2.0, .sigma = -12.0}})}}}};
  const std::string shown = characters(cells, {60, false, false});
  EXPECT_NE(shown.find("+4"), std::string::npos) << shown;
  EXPECT_NE(shown.find("-#"), std::string::npos) << shown;
}

}  // namespace
}  // namespace imunoise::report
