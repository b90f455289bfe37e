import { expect, test } from "vitest";
import type { Study } from "../../api/schema";
import { placeSentence } from "./places";

const study = { diagnosis: { misfits: [{ kind: "scale", sentence: "Off.", sigma: 5, from: 2, to: 4 }] } } as unknown as Study;

test("a failure is told at the averaging time of the axis", () => {
  expect(placeSentence(study, "averaging_times", null, true)).toBe("Off.");
  expect(placeSentence(study, "averaging_times", null, false)).toBe("Off. In Allan deviation: at 1 to 2 s.");
  expect(placeSentence(study, "averaging_times", { x: 1.5, y: 1 } as never, false)).toContain("Off.");
  expect(placeSentence(study, "averaging_times", { x: 3, y: 1 } as never, false)).not.toContain("Off.");
});
