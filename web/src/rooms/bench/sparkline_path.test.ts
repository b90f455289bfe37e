import { expect, test } from "vitest";
import { outline } from "./sparkline_path";

const box = { width: 10, height: 21 };

test("the outline reaches from the least to the greatest of all ranges", () => {
  expect(outline([-1, 0], [0, 1], box)).toBe("M0.0 10.0L5.0 10.0L5.0 0.0L10.0 0.0L10.0 11.0L5.0 11.0L5.0 21.0L0.0 21.0Z");
});

test("a channel that never changes is a thin line in the middle, and nothing is nothing", () => {
  expect(outline([3], [3], box)).toBe("M0.0 10.0L10.0 10.0L10.0 11.0L0.0 11.0Z");
  expect(outline([], [], box)).toBe("");
});
