// What a calibration found, in a sentence or two.
import type { CataloguedCalibration } from "../api/schema";

export function calibrationWords(one: CataloguedCalibration): string {
  if (one.trouble) return `Its calibration cannot be read: ${one.trouble}`;
  return `Calibration: ${one.summary}${one.outdated ? " The recording has changed since." : ""}`;
}
