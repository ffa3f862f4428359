// Numbers as people type them.

import assert from "node:assert/strict";
import { test } from "node:test";

import { readNumber } from "../../coursekit/view/static/numbers.js";

const right = {
  deg: { "12,5": 12.5, "−20": -20, "–20": -20, "12.5": 12.5, "90°": 90, " -45 deg ": -45, "pi/2": 90, "π": 180, "-2pi/3": -120,
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
