import { expect, test } from "vitest";
import { parse, split } from "./events";

test("events that come in pieces are put together", () => {
  const text = 'event: job\ndata: {"job":"job-1"}\n\n: \n\nevent: li';
  const { blocks, rest } = split(text);
  expect(rest).toBe("event: li");
  expect(blocks.map(parse)).toEqual([{ job: { job: "job-1" } }, null]);
  expect(split("a")).toEqual({ blocks: [], rest: "a" });
});
