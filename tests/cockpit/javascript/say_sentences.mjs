// Print what the cluster says: argv[2] is the table, argv[3] a list of values of drives.

import { readFileSync } from "node:fs";

import { ICON_NAMES } from "../../../fmu_src/pldf/cockpit/page/cluster/icons.js";
import { rowOf, sentenceOf, shown } from "../../../fmu_src/pldf/cockpit/page/cluster/sentence.js";

/** @param {number} at @returns {any} */
const given = (at) => JSON.parse(readFileSync(String(process.argv[at]), "utf-8"));

const texts = given(2);
const said = given(3).map((/** @type {Record<string, number>} */ values) => {
  const row = rowOf(texts, values);
  return (
    row && { name: row.name, en: sentenceOf(row, values, "en"), de: sentenceOf(row, values, "de") }
  );
});
const rows = [...texts.reasons, ...texts.events];
/** @param {"none" | "icon"} explanation */
const told = (explanation) =>
  rows.filter((row) => shown(row, explanation).text).map((row) => row.name);
console.log(JSON.stringify({ said, icons: ICON_NAMES, none: told("none"), icon: told("icon") }));
