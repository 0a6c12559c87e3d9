// Pictures of pages beside them: light, dark, on a phone, and as they are printed from a dark screen.
//
//   node screenshots.mjs PAGE.html...

import { PHONE, WIDE, launch, open } from "./browser.mjs";

const PICTURES = [["light", "light", WIDE], ["dark", "dark", WIDE], ["phone", "light", PHONE]];

const browser = await launch();
for (const file of process.argv.slice(2)) {
  const stem = file.replace(/\.html$/, "");
  for (const [name, scheme, viewport] of PICTURES) {
    const { tab } = await open(browser, file, scheme, viewport);
    await tab.screenshot({ path: `${stem}-${name}.png`, fullPage: true });
    await tab.close();
  }
  const { tab } = await open(browser, file, "dark", WIDE);
  await tab.pdf({ path: `${stem}-print.pdf`, preferCSSPageSize: true });
  await tab.close();
  console.log(stem);
}
await browser.close();
