import { describe, expect, test } from "vitest";
import type { EffectCandidate, Rung, Study } from "../../api/schema";
import { beyondChance, brief, errorOf, longestDrift, mayRedo, path, split, surety, verdict, without } from "./model";

const rung = (model: string, added = "") => ({ model, added, views: [], drift: [] });
const study = (attempts: unknown[], current: number) => ({ attempts, current }) as unknown as Study;

describe("a model's text", () => {
  test("is split at its plus signs, but not within brackets", () => {
    expect(split("WN + RW[corr] + witness(a+b, lag=3) + line(f=1e+01)")).toEqual(["WN", "RW[corr]", "witness(a+b, lag=3)", "line(f=1e+01)"]);
  });
  test("loses one term", () => {
    expect(without("WN + RW + QN", 1)).toBe("WN + QN");
    expect(without("3*AR1 + WN", 0)).toBe("2*AR1 + WN");
    expect(without("2*AR1 + WN", 0)).toBe("AR1 + WN");
  });
  test("is shown with four digits", () => {
    expect(brief("line(f=19.8999986)")).toBe("line(f=19.9)");
    expect(brief("AR1")).toBe("AR1");
  });
});

describe("a study", () => {
  const forked = study([{ rung: rung("a") }, { parent: 0, rung: rung("b"), undone: true }, { parent: 0, rung: rung("c") }, { parent: 2, rung: rung("d") }], 3);
  test("has one path to its current model", () => {
    expect(path(forked).map((one) => one.index)).toEqual([0, 2, 3]);
  });
  test("may be redone where a model that extends the current one was undone", () => {
    expect(mayRedo(forked)).toBe(false);
    expect(mayRedo({ ...forked, current: 0 })).toBe(true);
  });
  test("says how far an integral runs off over times that the data tell", () => {
    const drift = [[1, "400"], [10, "40"], [100, "4"]].map(([seconds, stretches]) => ({ seconds, stretches }));
    expect(longestDrift({ drift } as unknown as Rung)?.seconds).toBe(10);
    expect(longestDrift(undefined)).toBeUndefined();
  });
  test("has one cause, beside others that explain less", () => {
    const candidate = (likelihood_gain_nats: number, familywise_p: number) => ({ likelihood_gain_nats, familywise_p, confused_with: [] }) as unknown as EffectCandidate;
    const best = candidate(3000, 1e-9);
    expect(surety(best, best).words).toBe("sure");
    expect(surety(candidate(2000, 1e-9), best).words).toBe("explains less");
    expect(surety(candidate(2999, 0.01), best).words).toBe("likely");
    // More terms explain more of what they were fitted to: what they foretell counts.
    const told = { ...best, heldout_gain_nats: 2900 };
    expect(surety({ ...candidate(3100, 1e-9), heldout_gain_nats: 2500 }, told).words).toBe("explains less");
    expect(surety({ ...candidate(2000, 1e-9), heldout_gain_nats: 2899 }, told).words).toBe("sure");
  });
  test("is judged by what was found", () => {
    expect(verdict(forked).mood).toBe("plain");
    const found = { verdict: "found", candidates: [{ familywise_p: 1e-9, title: "resonance", parameters: [{ name: "frequency_hz", value: 19.8999 }] }] };
    expect(verdict({ ...forked, diagnosis: found } as unknown as Study).words).toBe("something is missing: resonance at 19.9 Hz");
  });
});

test("the error is what is unexplained, else the held-out one, else that of training", () => {
  expect(errorOf({ unexplained: 1, heldout_error: 2, training_error: 3 } as never)).toBe(1);
  expect(errorOf({ heldout_error: 2, training_error: 3 } as never)).toBe(2);
  expect(errorOf({ training_error: 3 } as never)).toBe(3);
  expect(errorOf(undefined)).toBeUndefined();
});

test("a candidate with rivals is not sure", () => {
  const one = (familywise_p: number, confused_with: string[]) => surety({ familywise_p, confused_with } as never).words;
  expect(one(1e-6, [])).toBe("sure");
  expect(one(1e-6, ["ramp"])).toBe("or a rival");
  expect(one(0.01, [])).toBe("likely");
});

test("what noise alone makes once in twenty is not listed", () => {
  expect(beyondChance({ familywise_p: 0.049 } as never)).toBe(true);
  expect(beyondChance({ familywise_p: 0.2 } as never)).toBe(false);
});
