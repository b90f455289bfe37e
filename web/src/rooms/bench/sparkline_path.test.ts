import { expect, test } from "vitest";
import { outline } from "./sparkline_path";

const box = { width: 10, height: 23 };

test("the outline reaches from the least to the greatest of all ranges", () => {
  expect(outline([-1, 0], [0, 1], box)).toBe("M0.0 11.5L10.0 1.5L10.0 11.5L0.0 21.5Z");
});

test("a channel that never changes is a line in the middle, and one range is nothing yet", () => {
  expect(outline([3, 3], [3, 3], box)).toBe("M0.0 11.5L10.0 11.5L10.0 11.5L0.0 11.5Z");
  expect(outline([3], [3], box)).toBe("");
});
