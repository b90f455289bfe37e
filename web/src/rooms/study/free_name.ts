/** A name for a study of a channel that no other has: "gyro_z", "gyro_z-2", ... */
export function freeName(channel: string, taken: readonly string[]): string {
  const stem = channel.replace(/[^A-Za-z0-9_.-]+/g, "_").replace(/^\.+/, "").slice(0, 56) || "study";
  for (let k = 1; ; ++k) {
    const name = k === 1 ? stem : `${stem}-${k}`;
    if (!taken.includes(name)) return name;
  }
}
