import { expect, test } from "vitest";
import { duration, number, withUnit } from "./numbers";

test("numbers have three digits, and powers of ten where they are far from one", () => {
  expect(number(41.234)).toBe("41.2");
  expect(number(1e-14)).toBe("1.00·10⁻¹⁴");
  expect(number(-2.5e6)).toBe("−2.50·10⁶");
  expect(number(0)).toBe("0");
  expect(number(undefined)).toBe("–");
  expect(number(NaN)).toBe("–");
});

test("units stand after them, and 1 is none", () => {
  expect(withUnit(2, "Hz")).toBe("2 Hz");
  expect(withUnit(2, "1")).toBe("2");
});

test("times are told in the unit that people use", () => {
  expect(duration(40.2)).toBe("41 s");
  expect(duration(1800)).toBe("30 min");
  expect(duration(7800)).toBe("2 h 10 min");
  expect(duration(7200)).toBe("2 h");
});
