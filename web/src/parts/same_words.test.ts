import { expect, test } from "vitest";
import { sameWords } from "./same_words";

test("what holds for many files is said once", () => {
  const of = (name: string, ...sentences: string[]) => ({ name, sentences });
  expect(sameWords([of("a", "100 Hz", "rad/s"), of("b", "100 Hz"), of("c", "100 Hz", "100 Hz", "deg/s")]))
    .toEqual(["a and 2 more: 100 Hz", "a: rad/s", "c: deg/s"]);
  expect(sameWords([])).toEqual([]);
});
