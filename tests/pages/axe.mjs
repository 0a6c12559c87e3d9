// Checks pages with axe-core in Chromium: light and dark, on a wide screen and on a phone.
//
//   node axe.mjs PAGE.html...
//
// Prints every finding. Fails if one is serious or critical, or if a script of a page fails.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { basename } from "node:path";
import { PHONE, WIDE, launch, open } from "./browser.mjs";

const SOURCE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const SEVERE = ["serious", "critical"];

async function check(browser, file, scheme, viewport) {
  const { tab, errors } = await open(browser, file, scheme, viewport);
  // What is folded away must be as readable as the rest.
  await tab.evaluate(() => document.querySelectorAll("details").forEach((one) => { one.open = true; }));
  await tab.evaluate(SOURCE);
  const { violations } = await tab.evaluate(() => globalThis.axe.run({ resultTypes: ["violations"] }));
  await tab.close();
  return { violations, errors };
}

function print({ violations, errors }) {
  errors.forEach((error) => console.log(`  script: ${error}`));
  for (const one of violations) {
    const [first] = one.nodes;
    const why = (first.any[0] ?? first.all[0] ?? first.none[0])?.message ?? first.html;
    console.log(`  ${one.impact} ${one.id}: ${one.help} (${one.nodes.length})`);
    console.log(`    ${first.target.join(" ")}: ${why}`);
  }
}

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error("usage: node axe.mjs PAGE.html...");
  process.exit(2);
}
const browser = await launch();
let severe = 0;
for (const file of files) {
  for (const scheme of ["light", "dark"]) {
    for (const [screen, viewport] of [["wide", WIDE], ["phone", PHONE]]) {
      const found = await check(browser, file, scheme, viewport);
      const count = found.violations.filter((one) => SEVERE.includes(one.impact)).length + found.errors.length;
      severe += count;
      console.log(`${basename(file)}, ${scheme}, ${screen}: ${found.violations.length} findings, ${count} severe`);
      print(found);
    }
  }
}
await browser.close();
process.exit(severe > 0 ? 1 : 0);
