import { expect, test } from "vitest";
import type { CataloguedArray, VirtualSensor } from "../../api/schema";
import { arrayTitle, gainRows, gainSentence, placesOf, weightRows } from "./array_rows";

const array = (folder: string, device: string): CataloguedArray =>
  ({ bench: "b", folder, started_ns: "0", device, stream: "imu", channels: ["gyro_x", "gyro_y"] });

test("arrays are counted in their recording", () => {
  expect(placesOf([array("a", "left"), array("a", ""), array("b", "left")]).map((one) => one.place)).toEqual([0, 1, 0]);
  expect(arrayTitle(array("a", ""))).toBe("across devices: gyro_x, gyro_y");
});

test("a virtual sensor is told as weights and gains", () => {
  const sensor = {
    weights: [{ sensor: "gyro_x", weight: 0.75, standard_error: 0.0123 }, { sensor: "gyro_y", weight: 0.25 }],
    scale_gains: [{ tau_s: 0.02, predicted: 0.5, measured: 0.52 }, { tau_s: 10, predicted: 1.2 }],
  } as unknown as VirtualSensor;
  expect(weightRows(sensor)).toEqual([{ sensor: "gyro_x", weight: "0.75 ± 0.012" }, { sensor: "gyro_y", weight: "0.25" }]);
  expect(gainRows(sensor)[1]).toEqual({ tau: "10", predicted: "1.2", measured: "–" });
  expect(gainSentence(sensor)).toBe("Compared with the mean of the sensors it has 50 % less noise power at 0.02 s, and 20 % more at 10 s.");
});
