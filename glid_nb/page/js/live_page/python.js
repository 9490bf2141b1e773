// The pose as lines of Python, for somebody who goes on with the package.

/** @import { LiveData, Pin } from "./data.js" */

/** @type {Record<string, string>} the classes of `glid_nb.energies`, by the energies' names */
const ENERGIES = {
  iso: "SymmetricDirichlet",
  exp: "ExponentialSymmetricDirichlet",
  amips: "AMIPS",
  mips: "MIPS",
  arap: "ARAP",
};
const WITH_S = ["exp", "amips"];
const WEIGHT = 1e5; // the package's default

/**
 * The lines have the page's own cage: its picture may have been traced with any options.
 *
 * @param {readonly Pin[]} pins
 * @param {Pick<LiveData, "options" | "stiffness" | "outline">} data
 */
export function pythonCode(pins, { options, stiffness, outline }) {
  const { energy = "iso", s = 1, weight = WEIGHT } = options;
  const lines = [
    "import glid_nb as glid",
    "",
    `cage = glid.Cage(${JSON.stringify(outline.cage)}, ${JSON.stringify(outline.holes)})`,
    "domain = glid.Domain.from_cage(cage)",
    "pose = glid.Pose(",
    `    handles=${listOf(pins.map(({ handle }) => listOf(handle.map(numberText))))},`,
    `    targets=${listOf(pins.map(({ target }) => listOf(target.map(numberText))))},`,
    ...optional("depths", pins, ({ depth }) => depth || null, 0),
    ...optional("angles", pins, ({ angle }) => angle),
    ...optional("scales", pins, ({ scale }) => scale),
    ...(stiffness ? [`    stiffness=${JSON.stringify(stiffness)},`] : []),
    ...optional("weights", pins, ({ weight: firm }) => (firm === 1 ? null : firm), 1),
    ...optional("names", pins, ({ name }) => name || null, ""),
    ")",
  ];
  const made = `glid.energies.${ENERGIES[energy]}(${WITH_S.includes(energy) ? s : ""})`;
  const given = weight === WEIGHT ? "" : `, glid.Options(p2p_weight=${weight})`;
  return `${[...lines, `result = glid.solve(domain, pose, ${made}${given})`].join("\n")}\n`;
}

/**
 * @param {string} name
 * @param {readonly Pin[]} pins
 * @param {(pin: Pin) => number | string | null} value null where it has its default
 * @param {number | string} [none] the default; without it, None
 */
function optional(name, pins, value, none) {
  const values = pins.map(value);
  if (values.every((one) => one === null)) return [];
  const texts = values.map((one) => textOf(one ?? none));
  return [`    ${name}=${listOf(texts)},`];
}

/** @param {number | string | undefined} value */
function textOf(value) {
  if (value === undefined) return "None";
  return typeof value === "number" ? numberText(value) : JSON.stringify(value);
}

/** @param {string[]} items */
function listOf(items) {
  return `[${items.join(", ")}]`;
}

/** @param {number} x */
function numberText(x) {
  return String(Number(x.toFixed(6)) + 0);
}
