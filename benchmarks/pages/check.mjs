// Look at web pages as a telephone does: node check.mjs page.html …
// Each page is checked with axe-core, and for anything wider than the screen that does not scroll in its own box.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const executablePath = process.env.CHROMIUM || "/usr/bin/chromium";
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] });
let faults = 0;

function tooWide() {
  const scrolls = (node) => node && (["auto", "scroll", "hidden"].includes(getComputedStyle(node).overflowX) || scrolls(node.parentElement));
  return Array.from(document.querySelectorAll("body *"))
    .filter((node) => node.getBoundingClientRect().width > 0 && node.getBoundingClientRect().right > innerWidth + 1)
    .filter((node) => !scrolls(node.parentElement) && !scrolls(node))
    .map((node) => node.tagName.toLowerCase());
}

for (const file of process.argv.slice(2)) {
  const page = await browser.newPage({ viewport: { width: 390, height: 844 } });
  await page.goto(pathToFileURL(file).href);
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  const wide = await page.evaluate(tooWide);
  console.log(`${file}: ${violations.length} violations, ${wide.length} elements too wide ${wide.slice(0, 5)}`);
  for (const { impact, id, help, nodes } of violations) console.log(`  ${impact} ${id} (${nodes.length}): ${help}: ${nodes[0].html.slice(0, 120)}`);
  faults += wide.length + violations.filter(({ impact }) => ["serious", "critical"].includes(impact)).length;
  await page.close();
}
await browser.close();
process.exitCode = faults ? 1 : 0;
