// Writes an MCAP file with @mcap/core: node write_mcap.js FILE none|lz4|zstd MESSAGES TOPICS
// Message i of each IMU topic: time i/100 s, rates i, i+0.25, i+0.5, accelerations 9+i, i/2, -i.
// A topic of text stands between. Chunks hold whole records; packing is lz4 or zstd by the tools.
const fs = require("fs");
const { execFileSync } = require("child_process");
const { McapWriter } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");

const imu = new MessageWriter([
  { name: "sensor_msgs/msg/Imu", definitions: [
    { name: "header", type: "std_msgs/msg/Header", isComplex: true },
    { name: "orientation", type: "geometry_msgs/msg/Quaternion", isComplex: true },
    { name: "orientation_covariance", type: "float64", isArray: true, arrayLength: 9 },
    { name: "angular_velocity", type: "geometry_msgs/msg/Vector3", isComplex: true },
    { name: "angular_velocity_covariance", type: "float64", isArray: true, arrayLength: 9 },
    { name: "linear_acceleration", type: "geometry_msgs/msg/Vector3", isComplex: true },
    { name: "linear_acceleration_covariance", type: "float64", isArray: true, arrayLength: 9 } ] },
  { name: "std_msgs/msg/Header", definitions: [
    { name: "stamp", type: "time" }, { name: "frame_id", type: "string" } ] },
  { name: "geometry_msgs/msg/Quaternion", definitions: ["x", "y", "z", "w"].map((name) => ({ name, type: "float64" })) },
  { name: "geometry_msgs/msg/Vector3", definitions: ["x", "y", "z"].map((name) => ({ name, type: "float64" })) },
]);

const [, , path, packing, messages, topics] = process.argv;
const parts = [];
let place = 0n;
const writable = {
  position: () => place,
  write: async (bytes) => { parts.push(Buffer.from(bytes)); place += BigInt(bytes.length); },
};
const pack = (bytes) => packing === "none" ? { compression: "", compressedData: bytes } :
  { compression: packing, compressedData: execFileSync(packing, ["-c", "-q"], { input: bytes }) };

(async () => {
  const writer = new McapWriter({ writable, compressChunk: pack, chunkSize: 8000 });
  await writer.start({ profile: "ros2", library: "" });
  const schemaId = await writer.registerSchema({ name: "sensor_msgs/msg/Imu", encoding: "ros2msg", data: new Uint8Array() });
  const textId = await writer.registerSchema({ name: "std_msgs/msg/String", encoding: "ros2msg", data: new Uint8Array() });
  const channel = (topic, schema) => writer.registerChannel({ schemaId: schema, topic, messageEncoding: "cdr", metadata: new Map() });
  const text = await channel("/chatter", textId);
  const ids = [];
  for (let t = 0; t < Number(topics); ++t) ids.push(await channel(`/imu${t}`, schemaId));
  for (let i = 0; i < Number(messages); ++i) {
    const at = { logTime: BigInt(i), publishTime: BigInt(i), sequence: i };
    await writer.addMessage({ channelId: text, data: new Uint8Array(20), ...at });
    const nanosec = (i % 100) * 10000000;
    for (const channelId of ids) {
      const data = imu.writeMessage({
        header: { stamp: { sec: 1700000000 + Math.floor(i / 100), nsec: nanosec, nanosec }, frame_id: "imu_link" },
        orientation: { x: 0, y: 0, z: 0, w: 1 },
        orientation_covariance: new Float64Array(9),
        angular_velocity: { x: i, y: i + 0.25, z: i + 0.5 },
        angular_velocity_covariance: new Float64Array(9),
        linear_acceleration: { x: 9 + i, y: i / 2, z: -i },
        linear_acceleration_covariance: new Float64Array(9),
      });
      await writer.addMessage({ channelId, data, ...at });
    }
  }
  await writer.end();
  fs.writeFileSync(path, Buffer.concat(parts));
})();
