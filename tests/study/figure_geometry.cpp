#include "tests/study/figure_geometry.h"

#include <gtest/gtest.h>

#include <regex>

namespace imunoise::report {

double value(const Element& element, const std::string& name) {
  return std::stod(element.attributes.at(name));
}

std::vector<Point> points_of(const Element& element) {
  std::vector<Point> out;
  if (element.name == "line") {
    out = {{value(element, "x1"), value(element, "y1")},
           {value(element, "x2"), value(element, "y2")}};
  } else if (element.name == "circle") {
    out = {{value(element, "cx"), value(element, "cy")}};
  } else if (element.name == "rect" && element.attributes.at("class") != "paper") {
    const Point corner{value(element, "x"), value(element, "y")};
    EXPECT_GE(value(element, "width"), 0.0);
    EXPECT_GE(value(element, "height"), 0.0);
    out = {corner, {corner.x + value(element, "width"), corner.y + value(element, "height")}};
  } else if (element.name == "path") {
    static const std::regex pair_pattern("[ML](-?[0-9.]+),(-?[0-9.]+)");
    const std::string& d = element.attributes.at("d");
    for (auto it = std::sregex_iterator(d.begin(), d.end(), pair_pattern);
         it != std::sregex_iterator(); ++it) {
      out.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
    }
    EXPECT_FALSE(out.empty());
  }
  return out;
}

std::vector<std::pair<std::string, Box>> text_boxes(const Markup& markup) {
  std::vector<std::pair<std::string, Box>> out;
  for (const Element& element : markup.elements) {
    if (element.name != "text") continue;
    const std::string& at = element.attributes.at("text-anchor");
    using figure::Anchor;
    const Anchor anchor = at == "start" ? Anchor::kStart
                          : at == "end" ? Anchor::kEnd
                                        : Anchor::kMiddle;
    static const std::regex entity_pattern("&[a-z#0-9]+;");
    const std::string text = std::regex_replace(element.text, entity_pattern, "x");
    out.emplace_back(text, figure::text_box({value(element, "x"), value(element, "y")}, text,
                                            value(element, "font-size"), anchor));
  }
  return out;
}

void expect_sound(const std::string& svg, const std::string& name) {
  const Markup markup = read_markup(svg);
  ASSERT_EQ(markup.error, "") << name;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  const Element& root = markup.elements.front();
  const Box canvas{0.0, 0.0, value(root, "width"), value(root, "height")};
  for (const Element& element : markup.elements) {
    for (const Point& p : points_of(element)) {
      EXPECT_TRUE(canvas.contains({p.x, p.y, p.x, p.y}))
          << name << ": " << element.name << " at " << p.x << ", " << p.y;
    }
  }
}

void expect_texts_apart(const std::string& svg, const std::string& name) {
  const Markup markup = read_markup(svg);
  const Element& root = markup.elements.front();
  const Box canvas{0.0, 0.0, value(root, "width"), value(root, "height")};
  const auto boxes = text_boxes(markup);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_TRUE(canvas.contains(boxes[i].second)) << name << ": " << boxes[i].first;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(boxes[i].second.overlaps(boxes[j].second))
          << name << " at " << canvas.right << ": '" << boxes[i].first << "' and '"
          << boxes[j].first << "'";
    }
  }
}

}  // namespace imunoise::report
