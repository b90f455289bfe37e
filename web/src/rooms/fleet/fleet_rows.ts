// A parameter of a fleet as rows, in the units of data sheets.
import type { FleetDevice, FleetParameter } from "../../api/schema";
import { number } from "../../parts/numbers";
import { pointText } from "../devices/parameter_rows";

export interface FleetRow {
  readonly id: string; // driver:serial
  readonly name: string; // serial number where it is known
  readonly value: string;
  readonly deviation: string; // in robust standard deviations
  readonly outlier: boolean;
  readonly calibrations: number;
}

const sheet = (one: FleetParameter): boolean => one.datasheet_unit !== "" && one.to_datasheet > 0;
export const unitOf = (one: FleetParameter): string => (sheet(one) ? one.datasheet_unit : one.unit);
const factorOf = (one: FleetParameter): number => (sheet(one) ? one.to_datasheet : 1);

/** "gyro_x: angle random walk of WN" */
export const titleOf = (one: FleetParameter): string =>
  `${one.channel}: ${one.title.includes(" of ") ? one.title : `${one.title} of ${one.term}`}`;

export const keyOf = (one: FleetParameter): string => [one.stream, one.channel, one.term, one.parameter].join("|");

function rowOf(one: FleetDevice, factor: number): FleetRow {
  return {
    id: one.device?.id ?? "",
    name: one.device?.serial || one.device?.id || "",
    value: one.newest ? pointText(one.newest, factor) : "–",
    deviation: one.robust_z === undefined ? "–" : `${one.robust_z < 0 ? "" : "+"}${number(one.robust_z, 2)}`,
    outlier: one.outlier,
    calibrations: one.calibrations,
  };
}

/** By value, as the service has them. */
export const fleetRows = (one: FleetParameter): FleetRow[] => one.devices.map((device) => rowOf(device, factorOf(one)));

/** "1.1 … 1.3, median 1.2 °/√h, of 5 devices" */
export function quartiles(one: FleetParameter): string {
  if (one.median === undefined || one.lower_quartile === undefined || one.upper_quartile === undefined)
    return "no device has an interval on both sides: there are no quartiles";
  const factor = factorOf(one);
  const of = one.seen === 1 ? "one device" : `${one.seen} devices`;
  return `quartiles ${number(one.lower_quartile * factor)} … ${number(one.upper_quartile * factor)}, median ${number(one.median * factor)} ${unitOf(one)}, of ${of}`;
}

/** Parameters in which a device stands out come first. */
export const worstFirst = (all: readonly FleetParameter[]): FleetParameter[] => {
  const count = (one: FleetParameter): number => one.devices.filter((device) => device.outlier).length;
  return [...all].sort((a, b) => count(b) - count(a));
};
