import { expect, test } from "vitest";
import { afterKey, moved, whole, within, zoomed } from "./zoom";

test("a part stays within the whole", () => {
  expect(within({ from: -5, until: 5 }, 100)).toEqual({ from: 0, until: 10 });
  expect(within({ from: 95, until: 105 }, 100)).toEqual({ from: 90, until: 100 });
  expect(within({ from: 0, until: 1000 }, 100)).toEqual({ from: 0, until: 100 });
  expect(within({ from: 5, until: 5 }, 100).until).toBeCloseTo(5.001);
});

test("what is pointed at stays where it is", () => {
  expect(zoomed({ from: 0, until: 100 }, 0.5, 20, 100)).toEqual({ from: 10, until: 60 });
  expect(moved({ from: 10, until: 20 }, 0.5, 100)).toEqual({ from: 15, until: 25 });
});

test("keys alone suffice", () => {
  const part = { from: 40, until: 60 };
  expect(afterKey("+", part, 100)).toEqual({ from: 45, until: 55 });
  expect(afterKey("-", part, 100)).toEqual({ from: 30, until: 70 });
  expect(afterKey("ArrowRight", part, 100)).toEqual({ from: 45, until: 65 });
  expect(afterKey("Home", part, 100)).toEqual(whole(100));
  expect(afterKey("a", part, 100)).toBeNull();
});
