// node run.mjs TEST --modules DIR --pages DIR --program FILE --scenarios DIR [--server mock|real|URL] [--only WORDS]
// Runs one of the tests beside it in Debian's Chromium (or $CHROMIUM). Exit code 77: skipped, there is no Chromium.
// --only: of the states, those whose names contain the words.
// $SHADOWBENCH_SCREENSHOTS: a folder for pictures of what the test sees.
import {existsSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {startBrowser} from './harness.mjs';

const {values, positionals: [test]} = parseArgs({
  allowPositionals: true,
  options: Object.fromEntries(['modules', 'pages', 'program', 'scenarios', 'server', 'only'].map((name) => [name, {type: 'string'}])),
});
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
if (!existsSync(chromium)) {
  console.log(`skipped: no browser at ${chromium}; Debian's package chromium has one`);
  process.exit(77);
}
const here = dirname(fileURLToPath(import.meta.url));
const {default: run} = await import(join(here, `${test}.mjs`));
const browser = await startBrowser(values.modules, chromium);
let code = 0;
try {
  await run({browser, server: 'real', ...values, here});
  console.log(`${test}: ok`);
} catch (error) {
  console.error(error);
  code = 1;
}
await browser.close();
process.exit(code);
