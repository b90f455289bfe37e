import { expect, test } from "vitest";
import type { CataloguedCalibration } from "../api/schema";
import { calibrationWords } from "./calibration_words";

const one = { summary: "6 of 6 channels have a model; 1 of these do not fit.", outdated: false, trouble: "" } as CataloguedCalibration;

test("a calibration says whether its models fit", () => {
  expect(calibrationWords(one)).toBe("Calibration: 6 of 6 channels have a model; 1 of these do not fit.");
  expect(calibrationWords({ ...one, outdated: true })).toMatch(/has changed since\.$/);
  expect(calibrationWords({ ...one, trouble: "no such file" })).toBe("Its calibration cannot be read: no such file");
});
