import { expect, test } from "vitest";
import { coefficientText } from "./coefficients";

const n = { symbol: "N", title: "angle random walk", value: 5e-5, lower: 4.9e-5, upper: 5.1e-5, unit: "rad/s/√Hz",
  datasheet_value: 0.1719, datasheet_lower: 0.1685, datasheet_upper: 0.1753, datasheet_unit: "°/√h" };

test("coefficients are told in the units of data sheets, what is not seen by its bound", () => {
  expect(coefficientText(n, true)).toBe("0.172 (0.169 … 0.175) °/√h");
  expect(coefficientText(n, false)).toBe("at most 0.175 °/√h");
  expect(coefficientText({ ...n, datasheet_unit: "" }, true)).toBe("5.00·10⁻⁵ (4.90·10⁻⁵ … 5.10·10⁻⁵) rad/s/√Hz");
});
