// Names for the files of the parts, as `part_names` in glid_nb/export/formats.py makes them.

import { LONGEST, nameOf } from "../live_page/files.js";

/**
 * Each part's name for files, after the page's. Names that no file system tells apart are numbered.
 * @param {string} title of the page
 * @param {string[]} parts their names
 */
export function partNames(title, parts) {
  /** @type {Set<string>} */
  const taken = new Set();
  return parts.map((part) => {
    const plain = nameOf({ title: `${title} ${part}` });
    let name = plain;
    for (let n = 2; taken.has(folded(name)); n++) name = ended(plain, `-${n}`);
    taken.add(folded(name));
    return name;
  });
}

/**
 * A name with an ending, which a long name gives way to.
 * @param {string} name
 * @param {string} ending
 */
function ended(name, ending) {
  return name.slice(0, LONGEST - ending.length).replace(/-$/, "") + ending;
}

/**
 * The same text for names that differ only in case, or in how an accent is written.
 * @param {string} name
 */
function folded(name) {
  return name.normalize().toUpperCase().toLowerCase();
}
