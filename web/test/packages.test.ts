// The packages of npm: they run on the Node.js of Debian 12, and the lock file names no registry.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { minVersion, satisfies } from "semver";
import { repository } from "./paths.mjs";

const debian_12 = "18.19.0";
const read = (file: string) => readFileSync(join(repository, file), "utf8");

interface Lock {
  packages: Record<string, { version?: string; resolved?: string; engines?: { node?: string } }>;
}
const lock = JSON.parse(read("web/package-lock.json")) as Lock;

test("every package runs on Debian's Node.js, as npm ci with engine-strict asks", () => {
  const others = Object.entries(lock.packages)
    .filter(([, { engines }]) => engines?.node !== undefined && !satisfies(debian_12, engines.node))
    .map(([name, { version, engines }]) => `${name} ${version}: ${engines!.node}`);
  assert.deepEqual(others, []);
  assert.match(read("web/.npmrc"), /^engine-strict=true$/m);
});

test("the Node.js that the project asks for is enough for each package", () => {
  const least = minVersion((JSON.parse(read("web/package.json")) as { engines: { node: string } }).engines.node)!;
  for (const [name, { engines }] of Object.entries(lock.packages))
    if (engines?.node !== undefined) assert.ok(satisfies(least, engines.node), `${name}: ${engines.node}, and web/package.json asks for ${least}`);
  const asked = /^least_node=(\S+)/m.exec(read("scripts/build-web"));
  assert.equal(asked?.[1], least.version);
});

test("the lock file names no registry", () => {
  assert.deepEqual(Object.entries(lock.packages).filter(([, entry]) => entry.resolved !== undefined), []);
  assert.doesNotMatch(read("web/package-lock.json"), /registry|\.tgz/);
  assert.match(read("web/.npmrc"), /^omit-lockfile-registry-resolved=true$/m);
});
