// Writes the libraries that the page carries, each as one module, from the packages that
// package-lock.json pins: node tests/cockpit/javascript/vendor.mjs FOLDER
import { build } from "esbuild";
import { copyFile, mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";

const ROOT = fileURLToPath(new URL("../../..", import.meta.url));
const PACKAGES = path.join(ROOT, "node_modules");
// Name of a package: what the page imports of it.
const LIBRARIES = {
  three: 'export * from "three";',
  uplot: 'export { default } from "uplot";',
  fflate: 'export { strToU8, unzipSync, zipSync } from "fflate";',
};

/** @param {string} folder where the modules and their licences go */
export async function vendor(folder) {
  await mkdir(folder, { recursive: true });
  for (const [name, contents] of Object.entries(LIBRARIES)) {
    const own = path.join(PACKAGES, name);
    const { version, license } = JSON.parse(await readFile(path.join(own, "package.json"), "utf8"));
    await build({
      stdin: { contents, resolveDir: ROOT },
      banner: { js: `// ${name} ${version}, licence ${license}: ${name}.LICENSE.txt` },
      bundle: true,
      format: "esm",
      minify: true,
      target: "es2022",
      legalComments: "none",
      outfile: path.join(folder, `${name}.js`),
      logLevel: "warning",
    });
    await copyFile(path.join(own, "LICENSE"), path.join(folder, `${name}.LICENSE.txt`));
  }
  const style = path.join(PACKAGES, "uplot/dist/uPlot.min.css");
  await writeFile(path.join(folder, "uplot.css"), await readFile(style));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await vendor(process.argv[2]);
