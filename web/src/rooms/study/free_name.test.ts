import { expect, test } from "vitest";
import { freeName } from "./free_name";

test("a study is named after its channel, and keeps to letters that names may have", () => {
  expect(freeName("gyro_z", [])).toBe("gyro_z");
  expect(freeName("gyro_z", ["gyro_z", "gyro_z-2"])).toBe("gyro_z-3");
  expect(freeName("gyro z/°", [])).toBe("gyro_z_");
  expect(freeName("..", [])).toBe("study");
  expect(freeName("x".repeat(80), []).length).toBeLessThanOrEqual(64);
});
