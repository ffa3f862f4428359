// Numbers as people type them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { readNumber, readVector } from "../../coursekit/view/static/numbers.js";

const right = {
  deg: { "12,5": 12.5, "−20": -20, "–20": -20, "12.5": 12.5, "90°": 90, "45º": 45, "np.pi/2": 90, " -45 deg ": -45, "pi/2": 90, "π": 180, "-2pi/3": -120,
    "0.5 rad": 28.6478897565412, ".5": 0.5, "1e1": 10, "+3": 3 },
  mm: { "12,5": 12.5, "0.4 m": 400, "0,4m": 400, "3cm": 30, "7 mm": 7 },
  "": { "0.3": 0.3, "1/3": 0.333333333333333 },
};
for (const [unit, cases] of Object.entries(right)) {
  for (const [typed, value] of Object.entries(cases)) {
    test(`${typed} in ${unit || "no unit"}`, () => assert.deepEqual(readNumber(typed, unit), { value }));
  }
}

const wrong = { deg: ["12.5.5", "12.5 5", "1,234.5", "1,2,3", "", "x", "5 mm", "1/0", "--3"], mm: ["90°", "5 ft"], "": ["3 mm"] };
for (const [unit, cases] of Object.entries(wrong)) {
  for (const typed of cases) {
    test(`“${typed}” in ${unit || "no unit"} is refused`, () => {
      assert.match(readNumber(typed, unit).error, /is no number here: write /);
    });
  }
}

const vectors = {
  "[0.1, -0.5] rad": ["0.1rad", "-0.5rad"],
  "array([ 0.1 -0.5  2. ])": ["0.1", "-0.5", "2."],
  "theta = np.radians([10, 20])": ["10", "20"],
  "(34.4, -57.3, 68.8) deg": ["34.4deg", "-57.3deg", "68.8deg"],
  "(1,5; 2) m": ["1,5m", "2m"],
  "10 20 30": ["10", "20", "30"],
  "[0.1\n 0.2]": ["0.1", "0.2"],
};
for (const [pasted, numbers] of Object.entries(vectors)) {
  test(`${pasted} is a vector`, () => assert.deepEqual(readVector(pasted), numbers));
}
for (const typed of ["12,5", "12.5 5", "1,234.5", "0.5 rad", "-45 deg", "pi/2", "(30)", "", "x"]) {
  test(`“${typed}” is no vector`, () => assert.equal(readVector(typed), null));
}
