// The bundles in the repository are those of its sources; `make page` renews them.

import assert from "node:assert/strict";
import { readdir, readFile } from "node:fs/promises";
import path from "node:path";
import { test } from "node:test";
import { BUILT, bundles } from "../../tools/build_page.js";

const built = await bundles();

test("no bundle is missing, and none is left over", async () => {
  assert.deepEqual((await readdir(BUILT)).toSorted(), [...built.keys()].toSorted());
});

for (const [name, contents] of built) {
  test(`${name} is what its sources make, byte by byte`, async () => {
    const kept = await readFile(path.join(BUILT, name));
    assert.ok(kept.equals(contents), `${name} is not up to date: run make page`);
  });
}
