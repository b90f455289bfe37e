// A connection to a program that a test can break or silence.
import { connect, createServer } from "node:net";

/** `break_()`: every connection ends, and none is let in. `silence()`: nothing passes. `mend()`: as at first. */
export async function proxy(test, to) {
  const port = Number(new URL(to).port);
  const sockets = new Set();
  let state = "open";
  const keep = (socket) => {
    sockets.add(socket);
    socket.on("error", () => undefined);
    socket.on("close", () => sockets.delete(socket));
  };
  const server = createServer((from) => {
    if (state === "broken") return from.destroy();
    const there = connect(port, "127.0.0.1");
    keep(from);
    keep(there);
    for (const [one, other] of [[from, there], [there, from]]) {
      one.on("data", (bytes) => { if (state === "open") other.write(bytes); });
      one.on("close", () => other.destroy());
    }
  });
  await new Promise((go) => server.listen(0, "127.0.0.1", go));
  const end = () => sockets.forEach((one) => one.destroy());
  test.after(() => { end(); server.close(); });
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    break_: () => { state = "broken"; end(); },
    silence: () => { state = "silent"; },
    mend: () => { state = "open"; end(); },
  };
}
