// Makes the page's files: node build.mjs MODULES OUT
// MODULES: a folder with node_modules as package-lock.json has it. OUT gets the files, compressed where that helps, and
// assets.s, which puts them into a program, with a table of them: see assets.cpp.
import {createHash} from 'node:crypto';
import {cpSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';
import {gzipSync} from 'node:zlib';
import {specs} from './page/plots/specs.js';

const here = dirname(fileURLToPath(import.meta.url));
const [modules, out] = process.argv.slice(2);
const load = (path) => import(pathToFileURL(join(modules, 'node_modules', path)));
const esbuild = await load('esbuild/lib/main.js');
const vegaLite = await load('vega-lite/build/index.js');

// The plots as Vega. Looks come from the page (plot.js), so Vega-Lite's own are left out.
function compilePlots() {
  const warnings = [];
  const warn = (...texts) => { warnings.push(texts.join(' ')); };
  const logger = {level: () => logger, error: warn, warn, info: () => logger, debug: () => logger};
  const compiled = Object.entries(specs).map(([name, spec]) => {
    const {spec: vega} = vegaLite.compile(spec, {logger});
    delete vega.config;
    delete vega.$schema;
    delete vega.background;
    vega.autosize = {type: 'pad', resize: true};  // labels come later, with the data
    return [name, vega];
  });
  if (warnings.length) throw new Error(`Vega-Lite: ${warnings.join('; ')}`);
  return `export default ${JSON.stringify(Object.fromEntries(compiled))}`;
}

const plots = {
  name: 'plots',
  setup(build) {
    build.onResolve({filter: /^compiled-plots$/}, () => ({path: 'compiled-plots', namespace: 'plots'}));
    build.onLoad({filter: /.*/, namespace: 'plots'}, () => ({contents: compilePlots(), loader: 'js'}));
  },
};

// The licences of the packages that these inputs are from, which ask to go with them. Each text stands once.
function licences(inputs) {
  const names = new Set(inputs.map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]).filter(Boolean));
  const users = new Map();
  for (const name of [...names].sort()) {
    const folder = join(modules, 'node_modules', name);
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const {license, author, version} = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    const text = file ? readFileSync(join(folder, file), 'utf8').trim() : `${license}, ${author?.name ?? author ?? ''}`;
    users.set(text, [...(users.get(text) ?? []), `${name} ${version}`]);
  }
  return [...users].map(([text, packages]) => `${packages.join(', ')}\n\n${text}\n`).join('\n----\n\n');
}

rmSync(out, {recursive: true, force: true});
mkdirSync(out, {recursive: true});
const common = {
  bundle: true, minify: true, target: 'es2022', outdir: out, nodePaths: [join(modules, 'node_modules')], plugins: [plots],
  legalComments: 'none', logLevel: 'warning', charset: 'utf8',
};
const page = (name) => join(here, 'page', name);
const {metafile} = await esbuild.build({...common, format: 'esm', entryPoints: [page('app.js')], metafile: true});
// These two are put into documents that are files of their own.
await esbuild.build({...common, format: 'iife', entryPoints: [page('report.js'), page('history.js')]});
await esbuild.build({...common, entryPoints: [page('style.css')]});
for (const file of ['index.html', 'icon.svg', 'first.webp']) cpSync(page(file), join(out, file));
writeFileSync(join(out, 'licences.txt'), licences(Object.keys(metafile.inputs)));

const files = [
  ['/', 'index.html', 'text/html; charset=utf-8'],
  ['/assets/app.js', 'app.js', 'text/javascript; charset=utf-8'],
  ['/assets/style.css', 'style.css', 'text/css; charset=utf-8'],
  ['/assets/icon.svg', 'icon.svg', 'image/svg+xml'],
  ['/assets/first.webp', 'first.webp', 'image/webp'],
  ['/assets/licences.txt', 'licences.txt', 'text/plain; charset=utf-8'],
  ['/assets/report.js', 'report.js', 'text/javascript; charset=utf-8'],
  ['/assets/history.js', 'history.js', 'text/javascript; charset=utf-8'],
];
const largestPlain = 4096;  // bytes; what is longer is compressed
const data = ['    .section .rodata', '    .balign 8'];
const table = ['    .section .data.rel.ro, "aw"', '    .balign 8', '    .globl shadowbench_web_assets', 'shadowbench_web_assets:'];
files.forEach(([path, name, type], i) => {
  const plain = readFileSync(join(out, name));
  const gzip = plain.length > largestPlain && !type.startsWith('image/');
  const content = gzip ? gzipSync(plain, {level: 9}) : plain;
  if (gzip) writeFileSync(join(out, `${name}.gz`), content);
  const etag = createHash('sha256').update(content).digest('hex').slice(0, 24);
  data.push(`path_${i}: .asciz "${path}"`, `type_${i}: .asciz "${type}"`, `etag_${i}: .asciz "\\"${etag}\\""`,
    `content_${i}: .incbin "${name}${gzip ? '.gz' : ''}"`);
  table.push(`    .quad path_${i}, type_${i}, content_${i}, ${content.length}, ${gzip ? 1 : 0}, etag_${i}`);
});
table.push('    .globl shadowbench_web_asset_count', '    .section .rodata', '    .balign 8', `shadowbench_web_asset_count: .quad ${files.length}`);
writeFileSync(join(out, 'assets.s'), [...data, ...table, '    .section .note.GNU-stack,"",@progbits', ''].join('\n'));
