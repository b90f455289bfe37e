import { expect, test } from "vitest";
import type { LiveDevice, LiveStream } from "../../api/schema";
import { deviceFacts, lastError, rateWords } from "./stream_words";

const stream = (more: Partial<LiveStream>): LiveStream =>
  ({ stream: "imu", nominal_hz: 100, samples: "9", missing: "0", gaps: "0", refused: "0", ...more });

test("a rate stands beside the nominal one", () => {
  expect(rateWords(stream({}))).toBe("100 Hz");
  expect(rateWords(stream({ rate_hz: 99.984 }))).toBe("99.98 of 100 Hz");
  expect(rateWords(stream({ nominal_hz: 0, rate_hz: 50 }))).toBe("50 Hz");
});

test("a device's streams are one row: the fastest rate, all that is missing, a temperature", () => {
  const facts = deviceFacts({ streams: [stream({ nominal_hz: 10, missing: "2", temperature_k: 300.15 }), stream({ rate_hz: 90, missing: "3" })] } as unknown as LiveDevice);
  expect(facts).toEqual({ rate: "90.00 of 100 Hz", rateOff: true, missing: "5", temperature: "27.0 °C" });
  expect(deviceFacts(undefined).rate).toBe("–");
});

test("what is wrong now comes before what was wrong", () => {
  const past = { sentence: "imu: 3 samples rejected", since_ns: "1772345553000000000" };
  const device = { disk_trouble: "", warnings: [], past_warning: past } as unknown as LiveDevice;
  expect(lastError(device)).toBe("06:12:33 UTC: imu: 3 samples rejected");
  expect(lastError({ ...device, warnings: [{ sentence: "gyro_x: stuck" }] } as unknown as LiveDevice)).toBe("gyro_x: stuck");
  expect(lastError({ disk_trouble: "", warnings: [] } as unknown as LiveDevice)).toBe("none");
});
