// The bundle is one script that serves the scope in which it runs.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { golden } from "./golden.js";

/** @type {MessageChannel[]} */
const channels = [];

class RememberedChannel extends MessageChannel {
  constructor() {
    super();
    channels.push(this);
  }
}

test("the worker's script answers with a certified map", async () => {
  const place = new URL("../../../glid_nb/page/built/live.js", import.meta.url);
  const script = new Function("globalThis", "MessageChannel", readFileSync(place, "utf-8"));
  /** @type {any} */
  const scope = {};
  /** @type {Promise<any>} */
  const solved = new Promise((resolve) => {
    scope.postMessage = (/** @type {any} */ answer) => answer.type === "map" && resolve(answer);
  });
  script(scope, RememberedChannel);
  const { outline, pose } = golden("bar");
  scope.onmessage({ data: { type: "shape", id: 1, outline } });
  scope.onmessage({ data: { type: "solve", id: 2, pose } });
  const answer = await solved;
  assert.ok(answer.certificate.certified);
  assert.equal(answer.id, 2);
  for (const channel of channels) {
    channel.port1.close(); // node waits for further messages otherwise
  }
});
