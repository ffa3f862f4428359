// Numbers as people type and paste them, and a sentence where it is none. Nothing is guessed: what can be read in two ways is refused.

const PER_UNIT = { // unit shown -> unit typed -> factor
  deg: { deg: 1, "°": 1, rad: 180 / Math.PI },
  mm: { mm: 1, cm: 10, m: 1000 },
};
const A_NUMBER = String.raw`\d+(?:\.\d*)?(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?`;
const SHAPE = new RegExp(`^([-+]?)(?:(${A_NUMBER})\\*?)?(pi)?(?:/(${A_NUMBER}))?([a-z°]*)$`);

/**
 * A typed number in the unit that is shown.
 * @param {string} typed such as "12.5", "12,5", "−20°", "pi/2", "0.4 m"
 * @param {string} unit the shown unit
 * @returns {{value?: number, error?: string}} one of the two
 */
export function readNumber(typed, unit = "") {
  const example = { deg: "12.5, -90°, 0.3 rad or pi/2", mm: "12.5 or 0.4 m" }[unit] || "12.5";
  const refuse = { error: `“${typed.trim()}” is no number here: write ${example}` };
  const plain = typed.toLowerCase().replace(/[\u2010-\u2015\u2212]/g, "-").replace(/π|np\.pi/g, "pi").replace(/[º˚]/g, "°").replace(/\s+/g, "");
  if (/[\d.]\s+[\d.]/.test(typed)) return refuse; // two numbers
  const commas = plain.split(",").length - 1;
  if (commas > 1 || (commas && plain.includes("."))) return refuse; // 1,234.5 is two different numbers in two countries
  const found = SHAPE.exec(plain.replace(",", "."));
  if (!found || (found[2] === undefined && !found[3])) return refuse;
  const [, sign, number, pi, divisor, ending] = found;
  const factors = PER_UNIT[unit] || { [unit]: 1 };
  const typedIn = ending || (pi && unit === "deg" ? "rad" : unit); // pi/2 is an angle in radians, whatever is shown
  if (factors[typedIn] === undefined) return refuse;
  const value = (number === undefined ? 1 : Number(number)) * (pi ? Math.PI : 1) / (divisor === undefined ? 1 : Number(divisor));
  const shown = (sign === "-" ? -1 : 1) * value * factors[typedIn];
  return Number.isFinite(shown) ? { value: Number(shown.toPrecision(15)) } : refuse;
}

/** The numbers of a vector, as they would be typed one by one, or null: of "[0.1 -0.5] rad", "array([10, 20])", "(1,5; 2) m", "10 20 30". @param {string} typed */
export function readVector(typed) {
  const [, open, inside, unit] = /^(?:[^[(]*([[(])+)?([^[\]()]*?)[\])]*\s*(deg|rad|°|mm|cm|m)?$/.exec(typed.trim()) || [];
  const numbers = (inside || "").trim().split(inside?.includes(";") ? /\s*;\s*/ : open ? /\s*,\s*|\s+/ : /,?\s+/);
  return numbers.length > (open ? 1 : 2) ? numbers.map((number) => number + (unit || "")) : null;
}
